//! Every vertex goes onto the surface of its faces, onto the curve of two, into the corner of three.

use std::collections::HashMap;

use rayon::prelude::*;

use super::constants::{MOST_MOVE, SAME_PLACE};
use crate::labelling::{Domain, Labelling, NONE};
use crate::mesh::vector::{distance, norm, Point};
use crate::progress::Progress;
use crate::surfaces::{meeting, Surface};
use crate::{memory, Result};

/// Where the vertices are, and what each is held by.
pub(super) struct Placement {
    /// The vertices.
    pub points: Vec<Point>,
    /// Whether each may move.
    pub moves: Vec<bool>,
    /// The pieces with surfaces that each vertex is on, those first that it has most area of.
    pub on: Vec<Vec<u32>>,
    /// How far a vertex may be from where it was.
    pub reach: f64,
    /// Vertices that are on fewer surfaces than their faces.
    pub n_held: usize,
}

impl Placement {
    /// The vertices as they are. Those without faces, of faces that take no part, and `fixed` ones stay.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(
        domain: &Domain<'_>,
        state: &Labelling,
        fixed: Option<&[bool]>,
        reach: f64,
    ) -> Result<Self> {
        let n = domain.positions.len();
        let moves = |v: usize| {
            let faces = domain.faces_at(v as u32);
            !fixed.is_some_and(|fixed| fixed[v])
                && !faces.is_empty()
                && faces.iter().all(|&f| state.labels[f as usize] != NONE)
        };
        let on = memory::gathered((0..n).map(|v| surfaces_at(domain, state, v as u32)))?;
        let (points, moves) = (memory::twin(domain.positions)?, memory::gathered((0..n).map(moves))?);
        Ok(Self { points, moves, on, reach, n_held: 0 })
    }

    /// Places all vertices that move.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn place(
        &mut self,
        domain: &Domain<'_>,
        state: &Labelling,
        progress: &Progress,
    ) -> Result<()> {
        progress.check()?;
        let nearest = |v: usize| self.nearest(domain, state, v, usize::MAX);
        let placed: Vec<(Point, usize)> =
            memory::joined((0..self.points.len()).into_par_iter().map(nearest))?;
        let mut taken: HashMap<Vec<u32>, Vec<usize>> = HashMap::new();
        for (v, (point, kept)) in placed.into_iter().enumerate() {
            if !self.moves[v] {
                continue;
            }
            self.n_held += usize::from(kept < self.on[v].len());
            self.on[v].truncate(kept);
            self.points[v] = point;
            if kept >= 3 {
                let mut key = self.on[v].clone();
                key.sort_unstable();
                taken.entry(key).or_default().push(v);
            }
        }
        let mut shared: Vec<Vec<usize>> = taken.into_values().filter(|vertices| vertices.len() > 1).collect();
        shared.sort_unstable();
        for vertices in shared {
            self.part(domain, state, vertices);
        }
        Ok(())
    }

    /// Leaves a corner that several vertices would share to the nearest,
    /// the others to the curves that lead there.
    fn part(&mut self, domain: &Domain<'_>, state: &Labelling, mut vertices: Vec<usize>) {
        vertices.sort_by(|&v, &w| {
            let way = |v: usize| distance(self.points[v], domain.positions[v]);
            way(v).total_cmp(&way(w))
        });
        let mut corners: Vec<Point> = Vec::new();
        for v in vertices {
            let here = self.points[v];
            if corners.iter().all(|&corner| distance(corner, here) > SAME_PLACE * domain.mean_edge) {
                corners.push(here);
                continue;
            }
            let (point, kept) = self.nearest(domain, state, v, 2);
            self.on[v].truncate(kept);
            self.points[v] = point;
            self.n_held += 1;
        }
    }

    /// Where vertex `v` goes, on so many of its surfaces at most, and on how many:
    /// as many as are within reach.
    fn nearest(&self, domain: &Domain<'_>, state: &Labelling, v: usize, most: usize) -> (Point, usize) {
        let start = domain.positions[v];
        if !self.moves[v] {
            return (start, self.on[v].len());
        }
        let surfaces = surfaces(state, &self.on[v]);
        // At a border labels are less sure than inside: one of the surfaces is where the vertex is.
        let is_off = |surface: &&Surface| surface.distance(start).0.abs() > MOST_MOVE[0] * domain.sigma;
        if surfaces.len() > 1 && surfaces.iter().all(is_off) {
            return (start, 0);
        }
        for count in (1..=surfaces.len().min(most)).rev() {
            if let Some(point) = meeting(&surfaces[..count], start, self.reach) {
                return (point, count);
            }
        }
        (start, 0)
    }
}

/// The surfaces of pieces that have one.
pub(super) fn surfaces<'a>(state: &'a Labelling, pieces: &[u32]) -> Vec<&'a Surface> {
    pieces.iter().filter_map(|&k| state.pieces[k as usize].surface.as_ref()).collect()
}

/// The pieces with surfaces at a vertex, by falling area. Beside faces that were on a surface and are not,
/// only the nearest: others need not go on until they meet it.
fn surfaces_at(domain: &Domain<'_>, state: &Labelling, v: u32) -> Vec<u32> {
    let mut areas: Vec<(u32, f64)> = Vec::new();
    let mut is_beside_doubt = false;
    for &f in domain.faces_at(v) {
        let label = state.labels[f as usize];
        is_beside_doubt |= state.pieces.get(label as usize).is_some_and(|piece| piece.is_doubted);
        if label == NONE || state.pieces[label as usize].surface.is_none() {
            continue;
        }
        let area = norm(domain.areas[f as usize]);
        match areas.iter_mut().find(|(l, _)| *l == label) {
            Some((_, sum)) => *sum += area,
            None => areas.push((label, area)),
        }
    }
    areas.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut on: Vec<u32> = areas.into_iter().map(|(label, _)| label).collect();
    if is_beside_doubt && on.len() > 1 {
        let distance = |label: u32| {
            let surface = state.pieces[label as usize].surface;
            surface.map_or(f64::INFINITY, |surface| surface.distance(domain.positions[v as usize]).0.abs())
        };
        on.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        on.truncate(1);
    }
    on
}
