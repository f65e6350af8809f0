//! Patches of one smooth surface are no surfaces of their own. Pieces that touch each other without an edge
//! are compared with a smooth surface of no kind over all of them: around each vertex, a quadratic function
//! fitted to the vertices nearby, as many as cost least: two rows, and twice as many each time.
//!
//! Both cost what their parameters do, pieces also their borders, and half of the number of observations
//! times the logarithm of what vertices are off by on average: the noise of these pieces is not known better
//! than they are. A local fit has as many parameters as it has leverage in all (Hastie and Tibshirani 1990,
//! *Generalized Additive Models*, section 3.5). So a vase that some tori lie on, and a loft in patches, are
//! one, while fillets stay, whose curvature jumps: a smooth surface follows it within a few vertices only.

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{BORDER, ENOUGH, FEWEST_NEARBY};
use super::labels::{Labelling, NONE};
use super::Domain;
use crate::buckets::Buckets;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, between, dot, norm, scale, unit, Point};
use crate::mesh::FILE_ROUNDING;
use crate::progress::Progress;
use crate::surfaces::{misfit, Surface};
use crate::tools::heights::{value, Frame, LeastSquares};
use crate::{memory, Result};

/// Makes pieces free that one smooth surface explains for less than their surfaces do. Where two turn by less
/// than `bend` (radians) at their border, no edge parts them.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn free_patches(
    domain: &Domain<'_>,
    state: &mut Labelling,
    bend: f64,
    progress: &Progress,
) -> Result<()> {
    let borders = borders(domain, state);
    let mut partition = Partition::new(state.pieces.len())?;
    for (&[a, b], border) in &borders {
        if border.turn < bend * border.length {
            partition.unite(a, b);
        }
    }
    let root: Vec<u32> = memory::gathered((0..state.pieces.len() as u32).map(|label| partition.root(label)))?;
    let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for label in (0..root.len() as u32).filter(|&label| state.surface(label).is_some()) {
        memory::push(groups.entry(root[label as usize]).or_default(), label)?;
    }
    groups.retain(|_, members| members.len() > 1);
    if groups.is_empty() {
        return Ok(());
    }
    let beside = Buckets::new(domain.positions.len(), |visit| {
        for h in domain.connectivity.edges() {
            let (v, w) = (domain.connectivity.tail(h), domain.connectivity.head(h));
            visit(v as usize, w);
            visit(w as usize, v);
        }
    })?;
    let mut seen = Seen { at: memory::repeated(0, domain.positions.len())?, now: 0 };
    let mut free = Vec::new();
    for (&name, members) in &groups {
        progress.check()?;
        if progress.is_finishing() {
            break;
        }
        let within =
            borders.iter().filter(|([a, b], _)| root[*a as usize] == name && root[*b as usize] == name);
        let length: f64 = within.map(|(_, border)| border.length).sum();
        let group = Group { domain, state, root: &root, name, beside: &beside };
        if group.is_smooth(members, length, &mut seen)? {
            memory::extend(&mut free, members.len())?;
            free.extend_from_slice(members);
        }
    }
    free.into_iter().for_each(|label| state.pieces[label as usize].surface = None);
    Ok(())
}

/// The border of two pieces with surfaces.
#[derive(Debug, Clone, Copy, Default)]
struct Border {
    /// In mean edges.
    length: f64,
    /// The angle between the surfaces along it, times its length.
    turn: f64,
}

fn borders(domain: &Domain<'_>, state: &Labelling) -> BTreeMap<[u32; 2], Border> {
    let mut borders: BTreeMap<[u32; 2], Border> = BTreeMap::new();
    for h in domain.connectivity.edges() {
        let Some(mate) = domain.connectivity.mate(h) else { continue };
        let [a, b] = [h, mate].map(|h| state.labels[h / 3]);
        let (Some(first), Some(second)) = (state.surface(a), state.surface(b)) else { continue };
        if a == b {
            continue;
        }
        let [p, q] = [domain.connectivity.tail(h), domain.connectivity.head(h)];
        let middle = between(domain.positions[p as usize], domain.positions[q as usize], 0.5);
        let [m, n] = [(a, first), (b, second)]
            .map(|(label, surface)| scale(surface.distance(middle).1, state.pieces[label as usize].side));
        let length = domain.lengths[h / 3][h % 3] / domain.mean_edge;
        let border = borders.entry([a.min(b), a.max(b)]).or_default();
        border.length += length;
        border.turn += length * dot(m, n).clamp(-1.0, 1.0).acos();
    }
    borders
}

impl Labelling {
    /// The surface of a piece, if it has one.
    fn surface(&self, label: u32) -> Option<Surface> {
        if label == NONE {
            return None;
        }
        self.pieces.get(label as usize)?.surface
    }
}

/// Which vertices a search has seen.
struct Seen {
    at: Vec<u32>,
    now: u32,
}

impl Seen {
    fn is_new(&mut self, v: u32) -> bool {
        std::mem::replace(&mut self.at[v as usize], self.now) != self.now
    }
}

/// Pieces that touch each other without an edge: those with the root `name`.
struct Group<'a> {
    domain: &'a Domain<'a>,
    state: &'a Labelling,
    root: &'a [u32],
    name: u32,
    /// The vertices at the edges of each vertex.
    beside: &'a Buckets<u32>,
}

impl Group<'_> {
    /// Whether a smooth surface costs less than `members` with so long borders, in mean edges.
    fn is_smooth(&self, members: &[u32], length: f64, seen: &mut Seen) -> Result<bool> {
        let domain = self.domain;
        let faces = members.iter().flat_map(|&label| &self.state.pieces[label as usize].faces);
        let corners = faces.flat_map(|&f| domain.connectivity.faces()[f as usize]);
        let vertices: BTreeSet<u32> = corners.collect();
        let total: f64 = vertices.iter().map(|&v| self.share(v)).sum();
        let step = vertices.len().div_ceil(ENOUGH).max(1);
        let samples: Vec<u32> = memory::gathered(vertices.iter().copied().step_by(step))?;
        let sampled: f64 = samples.iter().map(|&v| self.share(v)).sum();
        if sampled <= 0.0 {
            return Ok(false);
        }
        let least = 0.5 * (FILE_ROUNDING / domain.sigma).powi(2);
        let cost = |misfit: f64, rest: f64| 0.5 * total * (misfit / sampled + least).ln() + rest;
        let kinds = members.iter().filter_map(|&label| self.state.surface(label));
        let n_parameters: usize = kinds.map(|surface| surface.kind().n_parameters()).sum();
        let own: f64 = samples.iter().map(|&v| self.misfit(v)).sum();
        let surfaces = cost(own, BORDER * length + domain.kappa * n_parameters as f64);
        let (mut before, mut most) = (f64::INFINITY, FEWEST_NEARBY);
        // Wider fits are smoother, and the first that costs more than one before it is too wide.
        while most <= vertices.len() {
            let mut fit = Fit::default();
            for &v in &samples {
                self.fit_around(v, most, seen, &mut fit)?;
            }
            let smooth = cost(fit.misfit, domain.kappa * fit.leverage * total / sampled);
            if smooth < surfaces {
                return Ok(true);
            }
            if smooth > before {
                break;
            }
            (before, most) = (smooth, 2 * most);
        }
        Ok(false)
    }

    fn is_in(&self, f: u32) -> bool {
        let label = self.state.labels[f as usize];
        self.state.surface(label).is_some() && self.root[label as usize] == self.name
    }

    fn faces_at(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.domain.faces_at(v).iter().copied().filter(|&f| self.is_in(f))
    }

    /// The part of vertex `v` that is of these pieces.
    fn share(&self, v: u32) -> f64 {
        self.faces_at(v).map(|f| self.domain.share(f as usize, v)).sum()
    }

    /// What vertex `v` costs on the surfaces of its faces.
    fn misfit(&self, v: u32) -> f64 {
        let domain = self.domain;
        let cost = |f: u32| {
            let surface = self.state.surface(self.state.labels[f as usize])?;
            let off = surface.distance(domain.positions[v as usize]).0;
            Some(domain.share(f as usize, v) * misfit(off, domain.sigma))
        };
        self.faces_at(v).filter_map(cost).sum()
    }

    /// Adds what vertex `v` costs on a smooth surface through about `most` vertices nearby.
    fn fit_around(&self, v: u32, most: usize, seen: &mut Seen, fit: &mut Fit) -> Result<()> {
        let domain = self.domain;
        let own = domain.positions[v as usize];
        let normal_at = |v: u32| -> Point {
            self.faces_at(v).fold([0.0; 3], |sum, f| add(sum, domain.areas[f as usize]))
        };
        seen.now += 1;
        seen.is_new(v);
        let (mut near, mut next, mut normal) = (vec![v], 0, normal_at(v));
        while near.len() < most && next < near.len() {
            for &w in self.beside.of(near[next] as usize) {
                if self.faces_at(w).next().is_some() && seen.is_new(w) {
                    normal = add(normal, normal_at(w));
                    memory::push(&mut near, w)?;
                }
            }
            next += 1;
        }
        if norm(normal) <= 0.0 {
            return Ok(());
        }
        let frame = Frame::new(own, unit(normal), domain.mean_edge * (near.len() as f64).sqrt());
        // The heights, and what the fit here takes from the height here: its leverage.
        let mut squares = LeastSquares::new(2);
        for &w in &near {
            let (terms, height) = frame.terms(domain.positions[w as usize]);
            squares.add(1.0, &terms, |k| if k == 0 { height } else { f64::from(u8::from(w == v)) });
        }
        let found = squares.solve(SLIGHT, SLIGHT);
        let share = self.share(v);
        fit.misfit += share * misfit(frame.distance(&found[0], own), domain.sigma);
        fit.leverage += share * value(&found[1], &frame.terms(own).0);
        Ok(())
    }
}

/// Keeps a fit to vertices on a line from having no answer.
const SLIGHT: f64 = 1e-9;

/// What vertices cost on a smooth surface.
#[derive(Debug, Clone, Copy, Default)]
struct Fit {
    misfit: f64,
    /// How many parameters it has for them.
    leverage: f64,
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::labels::Piece;
    use super::*;
    use crate::shapes::grid;

    /// A strip of 60 by 20 squares over `profile`, whose pieces, by where they are along it, have surfaces
    /// fitted to them; how many are left.
    fn left(profile: impl Fn(f64) -> [f64; 2], piece_at: impl Fn(f64) -> u32) -> usize {
        // Noise that is the same on any machine: a tenth of an edge at most.
        let noise = |x: f64, y: f64| 0.1 * (12.9898 * x + 78.233 * y).sin() * (3.7 * x * y + x).cos();
        let shape = grid(60, 20).map(|[x, y, _]| {
            let [along, up] = profile(x);
            [along, y, up + noise(x, y)]
        });
        let mesh = shape.mesh().unwrap();
        let domain = Domain::new(mesh.connectivity(), mesh.positions().unwrap(), 0.05).unwrap();
        let middle = |f: &[u32; 3]| f.iter().map(|v| f64::from(v % 61)).sum::<f64>() / 3.0;
        let labels: Vec<u32> = mesh.connectivity().faces().iter().map(|f| piece_at(middle(f))).collect();
        let n = labels.iter().max().unwrap() + 1;
        let faces = |label: u32| (0_u32..).zip(&labels).filter(move |(_, l)| **l == label).map(|(f, _)| f);
        let pieces: Vec<Piece> =
            (0..n).map(|label| Piece::of(&domain, faces(label).collect()).unwrap()).collect();
        assert!(pieces.iter().all(|piece| piece.surface.is_some()));
        let mut state = Labelling { labels: labels.clone(), pieces };
        free_patches(&domain, &mut state, 0.4, &Progress::new()).unwrap();
        state.pieces.iter().filter(|piece| piece.surface.is_some()).count()
    }

    #[test]
    fn a_fillet_stays_between_its_planes_and_patches_of_a_wave_are_free() {
        let radius = 10.0;
        let fillet = |x: f64| {
            let turn = ((x - 24.0) / radius).clamp(0.0, 1.2);
            let beyond = (x - 24.0 - 1.2 * radius).max(0.0);
            let [along, up] = [turn.sin(), 1.0 - turn.cos()].map(|x| x * radius);
            [x.min(24.0) + along + beyond * turn.cos(), up + beyond * turn.sin()]
        };
        let by_arc = |x: f64| u32::from(x > 24.0) + u32::from(x > 36.0);
        assert_eq!(left(fillet, by_arc), 3);
        let wave = |x: f64| [x, 9.0 * (x / 12.0).sin()];
        assert_eq!(left(wave, |x| (x / 10.0) as u32), 0);
    }
}
