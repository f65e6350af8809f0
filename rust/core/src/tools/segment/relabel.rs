//! Moving faces at borders to the segment that they fit best, with straight borders.
//!
//! Minimizes `Σ_f misfit(f, label) + Σ_border edges length` over the labels of the faces at borders, face by
//! face, as variational shape approximation does (Cohen-Steiner et al. 2004) with the length of the borders
//! added (Potts 1952, Besag 1986).

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{
    EDGE_COST, LEAST_NOISE, LEAST_NOISE_OF_VALUES, LEAST_TURN, MOST_MISFIT, PLANE_EDGE, PLANE_NOISE,
    RELABEL_ROUNDS, RELABEL_SWEEPS, STRAY_OF_NOISE,
};
use super::patches::{nearby, patch_size, Patch, SegmentPlane};
use super::surface::{pieces, Surface};
use crate::linear::Columns;
use crate::mesh::vector::{distance, unit};
use crate::progress::Progress;
use crate::{memory, Result};

/// What is fitted, and how exactly.
pub(super) struct Relabel<'a> {
    pub surface: &'a Surface<'a>,
    /// The signal, or nothing for the shape itself.
    pub signal: Option<&'a Columns>,
    /// Standard deviation of the noise of the signal, or of the positions along the normal.
    pub noise: f64,
    /// Pieces of at least so many faces that come loose are segments of their own.
    pub least_faces: usize,
    /// Faces stay in their region, where given: a region for each face.
    pub regions: Option<&'a [u32]>,
    pub progress: &'a Progress,
}

/// What segments look like in one round.
struct Round<'a, 'b> {
    relabel: &'b Relabel<'a>,
    labels: Vec<u32>,
    planes: BTreeMap<u32, SegmentPlane>,
    /// The misfit of a face with a segment.
    known: BTreeMap<(u32, u32), f64>,
    seen: Vec<u32>,
    stamp: u32,
    patch_size: usize,
    /// What counts as one standard deviation of values or distances, and of unit normals.
    deviation: f64,
    turn: f64,
}

impl Relabel<'_> {
    /// Moves faces until none wants to move. Segments may vanish,
    /// and fall into pieces that are segments then.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn run(&self, labels: &mut Vec<u32>) -> Result<()> {
        for _ in 0..RELABEL_ROUNDS {
            self.progress.check()?;
            if self.progress.is_finishing() {
                break;
            }
            let before = memory::twin(labels)?;
            let mut round = Round::new(self, memory::twin(labels)?)?;
            for _ in 0..RELABEL_SWEEPS {
                if !self.sweep(&mut round, labels) || self.progress.is_finishing() {
                    break;
                }
            }
            self.rejoin(labels)?;
            if *labels == before {
                break;
            }
        }
        Ok(())
    }

    /// One pass over the faces at borders; whether any moved.
    fn sweep(&self, round: &mut Round<'_, '_>, labels: &mut [u32]) -> bool {
        let mut moved = false;
        for f in 0..labels.len() {
            if !self.surface.is_at_border(labels, f) {
                continue;
            }
            let mut candidates = vec![labels[f]];
            for (_, g) in self.surface.around(f).filter(|&(_, g)| self.may_share(f, g)) {
                if !candidates.contains(&labels[g]) {
                    candidates.push(labels[g]);
                }
            }
            let mut best = (f64::INFINITY, labels[f]);
            for label in candidates {
                let cost = round.misfit(f, label) + self.border_cost(labels, f, label);
                if cost < best.0 - 1e-12 {
                    best = (cost, label);
                }
            }
            moved |= labels[f] != best.1;
            labels[f] = best.1;
        }
        moved
    }

    /// Whether two faces may be of one segment.
    fn may_share(&self, f: usize, g: usize) -> bool {
        self.regions.is_none_or(|regions| regions[f] == regions[g])
    }

    fn border_cost(&self, labels: &[u32], f: usize, label: u32) -> f64 {
        let edges = self.surface.around(f).filter(|&(_, g)| labels[g] != label);
        let cost: f64 =
            edges.map(|(h, _)| self.surface.lengths[f][h % 3] * self.surface.costs[f][h % 3]).sum();
        EDGE_COST * cost / self.surface.mean_edge.max(f64::MIN_POSITIVE)
    }

    /// Gives every small piece of a segment but its largest to the neighbor with which it has the longest
    /// border; other pieces become segments of their own.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn rejoin(&self, labels: &mut [u32]) -> Result<()> {
        let mut n_before = usize::MAX;
        loop {
            let (piece, count) = pieces(self.surface, labels)?;
            // Pieces that took each other's names would do so forever.
            let is_stuck = std::mem::replace(&mut n_before, count) <= count;
            let (mut area, mut size) = (memory::repeated(0.0, count)?, memory::repeated(0, count)?);
            let mut owner = memory::repeated(0, count)?;
            for f in 0..labels.len() {
                let p = piece[f] as usize;
                area[p] += self.surface.areas[f];
                size[p] += 1;
                owner[p] = labels[f];
            }
            let mut largest: BTreeMap<u32, usize> = BTreeMap::new();
            for p in 0..count {
                let held = largest.entry(owner[p]).or_insert(p);
                if area[p] > area[*held] {
                    *held = p;
                }
            }
            let mut fresh = labels.iter().copied().max().map_or(0, |label| label + 1);
            for p in 0..count {
                if largest[&owner[p]] != p && size[p] >= self.least_faces {
                    owner[p] = fresh;
                    largest.insert(fresh, p);
                    fresh += 1;
                }
            }
            labels.iter_mut().zip(&piece).for_each(|(label, p)| *label = owner[*p as usize]);
            let mut shared: BTreeMap<(u32, u32), f64> = BTreeMap::new();
            for f in 0..labels.len() {
                if largest[&labels[f]] == piece[f] as usize {
                    continue;
                }
                let may = |g: usize| labels[g] != labels[f] && self.may_share(f, g);
                for (h, g) in self.surface.around(f).filter(|&(_, g)| may(g)) {
                    *shared.entry((piece[f], labels[g])).or_default() += self.surface.lengths[f][h % 3];
                }
            }
            let mut home: BTreeMap<u32, (f64, u32)> = BTreeMap::new();
            for (&(p, label), &length) in &shared {
                if home.get(&p).is_none_or(|held| length > held.0) {
                    home.insert(p, (length, label));
                }
            }
            if home.is_empty() {
                return Ok(());
            }
            if is_stuck {
                self.stay_for_others(labels, &piece, &mut home);
            }
            for (label, p) in labels.iter_mut().zip(&piece) {
                if let Some((_, new)) = home.get(p) {
                    *label = *new;
                }
            }
        }
    }

    /// Lets pieces stay that others next to them are to join, so that there are fewer pieces then.
    fn stay_for_others(&self, labels: &[u32], piece: &[u32], home: &mut BTreeMap<u32, (f64, u32)>) {
        let mut beside: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for (f, p) in piece.iter().enumerate() {
            let Some((_, label)) = home.get(p) else { continue };
            let joined = self.surface.around(f).filter(|&(_, g)| labels[g] == *label);
            beside.entry(*p).or_default().extend(joined.map(|(_, g)| piece[g]));
        }
        let (mut staying, mut moving) = (BTreeSet::new(), BTreeSet::new());
        home.retain(|p, _| {
            let others = beside.remove(p).unwrap_or_default();
            let moves = !staying.contains(p) && !others.is_subset(&moving);
            if moves {
                moving.insert(*p);
                staying.extend(others);
            }
            moves
        });
    }
}

impl<'a, 'b> Round<'a, 'b> {
    fn new(relabel: &'b Relabel<'a>, labels: Vec<u32>) -> Result<Self> {
        let surface = relabel.surface;
        let m = labels.len();
        let mut planes = BTreeMap::new();
        if relabel.signal.is_none() {
            let mut members: BTreeMap<u32, (Vec<u32>, Vec<u32>)> = BTreeMap::new();
            for f in 0..m {
                let entry = members.entry(labels[f]).or_default();
                if !surface.is_at_border(&labels, f) {
                    memory::push(&mut entry.0, f as u32)?;
                }
                memory::push(&mut entry.1, f as u32)?;
            }
            let flat = (PLANE_NOISE * relabel.noise).max(PLANE_EDGE * surface.mean_edge);
            for (label, (inside, all)) in members {
                let plane = SegmentPlane::through(surface, if inside.is_empty() { &all } else { &inside });
                if let Some(plane) = plane.filter(|plane| plane.spread <= flat) {
                    planes.insert(label, plane);
                }
            }
        }
        let least =
            if relabel.signal.is_none() { LEAST_NOISE * surface.mean_edge } else { LEAST_NOISE_OF_VALUES };
        Ok(Self {
            relabel,
            labels,
            planes,
            known: BTreeMap::new(),
            seen: memory::repeated(0, m)?,
            stamp: 0,
            patch_size: patch_size(relabel.noise / surface.mean_edge),
            deviation: relabel.noise.max(least),
            turn: LEAST_TURN + STRAY_OF_NOISE * relabel.noise / surface.mean_edge,
        })
    }

    /// The cost of face `f` in the segment `label`, as that was at the beginning of the round.
    fn misfit(&mut self, f: usize, label: u32) -> f64 {
        if let Some(known) = self.known.get(&(f as u32, label)) {
            return *known;
        }
        let surface = self.relabel.surface;
        let corners = surface.connectivity.faces()[f].map(|v| v as usize);
        let signal = self.relabel.signal;
        let fit = if let Some(plane) = self.planes.get(&label) {
            Some((corners.map(|v| plane.distance(surface.positions[v])), plane.normal()))
        } else {
            self.start(f, label).and_then(|start| {
                self.stamp += 1;
                let seen = (self.seen.as_mut_slice(), self.stamp);
                let faces = nearby(surface, &self.labels, start, self.patch_size, seen);
                let patch = Patch::fit(surface, &faces, signal)?;
                Some((corners.map(|v| patch.misfit(surface, v, signal)), patch.normal(surface.centroids[f])))
            })
        };
        let cost = fit.map_or(4.0 * MOST_MISFIT, |(distances, normal)| {
            let squares = distances.iter().map(|d| (d / self.deviation).powi(2));
            let turned = signal.is_none().then(|| distance(unit(surface.vector_area(f)), normal));
            squares.chain(turned.map(|d| (d / self.turn).powi(2))).map(|x| (0.5 * x).min(MOST_MISFIT)).sum()
        });
        self.known.insert((f as u32, label), cost);
        cost
    }

    /// The face nearest to `f` that was in the segment: itself, or within three edges.
    fn start(&self, f: usize, label: u32) -> Option<usize> {
        let mut ring = vec![f];
        for _ in 0..4 {
            if let Some(&start) = ring.iter().find(|&&g| self.labels[g] == label) {
                return Some(start);
            }
            let next: Vec<usize> =
                ring.iter().flat_map(|&g| self.relabel.surface.around(g).map(|(_, g)| g)).collect();
            ring = next;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::{grid, Shape};

    #[test]
    fn loose_pieces_that_only_have_each_other_become_one() {
        // Two segments on a large sheet, and one piece of each on a small one beside it.
        let Shape { mut vertices, mut faces } = grid(6, 6);
        let small = grid(2, 2);
        faces.extend(small.faces.iter().map(|face| face.map(|v| v + vertices.len() as u32)));
        vertices.extend(small.vertices.iter().map(|p| [p[0] + 100.0, p[1], p[2]]));
        let mesh = Shape { vertices, faces }.mesh().unwrap();
        let costs = vec![[1.0; 3]; mesh.connectivity().n_faces()];
        let surface = Surface::new(mesh.connectivity(), mesh.positions().unwrap(), 1.0, costs).unwrap();
        let middle = |f: usize| if f < 72 { 36 } else { 76 };
        let mut labels: Vec<u32> = (0..80).map(|f| u32::from(f >= middle(f))).collect();
        let relabel = Relabel {
            surface: &surface,
            signal: None,
            noise: 0.0,
            least_faces: usize::MAX,
            regions: None,
            progress: &Progress::new(),
        };
        relabel.rejoin(&mut labels).unwrap();
        assert!(labels[72..].iter().all(|&label| label == labels[72]));
    }
}
