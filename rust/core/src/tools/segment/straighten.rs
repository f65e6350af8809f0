//! Short borders along creases: the minimum cut of a band around each border (the fuzzy cuts of Katz and Tal
//! 2003).
//!
//! Fits say little about where smoothly curved segments part, and leave teeth. There a border is worth its
//! length, less where the surface bends, and least where it is hollow (the minima rule, Hoffman and Richards
//! 1984).

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{BAND_ROWS, BEND_OVER_A_RIDGE, STRAIGHTEN_PASSES};
use super::patches::SegmentPlane;
use super::surface::{members, Surface};
use crate::mesh::vector::{add, distance, dot, sub, unit, Point};
use crate::progress::Progress;
use crate::tools::minimum_cut::Graph;
use crate::{memory, Result};

/// What borders cost.
pub(super) struct Straighten<'a> {
    surface: &'a Surface<'a>,
    /// The most that the corners of faces of one plane are off it, root mean square.
    flat: f64,
    /// What a border along each halfedge costs.
    costs: Vec<[f64; 3]>,
    /// Borders between regions stay, where given: a region for each face.
    regions: Option<&'a [u32]>,
    progress: &'a Progress,
}

impl<'a> Straighten<'a> {
    /// Measures all edges. Normals are those of a face and its neighbors together,
    /// so that noise does not count as creases.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(
        surface: &'a Surface<'a>,
        flat: f64,
        regions: Option<&'a [u32]>,
        progress: &'a Progress,
    ) -> Result<Self> {
        let sum = |f: usize| {
            surface.around(f).fold(surface.vector_area(f), |sum, (_, g)| add(sum, surface.vector_area(g)))
        };
        let normals: Vec<Point> = memory::gathered((0..surface.n_faces()).map(|f| unit(sum(f))))?;
        let bend = |f: usize, g: usize| {
            let outward = dot(sub(normals[g], normals[f]), sub(surface.centroids[g], surface.centroids[f]));
            distance(normals[f], normals[g]) * if outward > 0.0 { BEND_OVER_A_RIDGE } else { 1.0 }
        };
        let (mut sum, mut count) = (0.0, 0);
        for f in 0..surface.n_faces() {
            for (_, g) in surface.around(f) {
                sum += bend(f, g);
                count += 1;
            }
        }
        let mean = (sum / f64::from(count.max(1))).max(f64::MIN_POSITIVE);
        let mut costs = memory::twin(&surface.costs)?;
        for (f, costs) in costs.iter_mut().enumerate() {
            for (h, g) in surface.around(f) {
                costs[h % 3] *= surface.lengths[f][h % 3] / (1.0 + bend(f, g) / mean);
            }
        }
        Ok(Self { surface, flat, costs, regions, progress })
    }

    /// Moves the borders between segments that are no planes; those of planes are where the planes meet. No
    /// segment vanishes, but some may fall apart. Labels are contiguous then.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn run(&self, labels: &mut Vec<u32>) -> Result<()> {
        let is_curved = |faces: &Vec<u32>| {
            SegmentPlane::through(self.surface, faces).is_none_or(|plane| plane.spread > self.flat)
        };
        let curved: Vec<bool> = memory::gathered(members(labels)?.iter().map(is_curved))?;
        for _ in 0..STRAIGHTEN_PASSES {
            let mut borders: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
            for f in 0..labels.len() {
                let may = |g: usize| self.regions.is_none_or(|regions| regions[g] == regions[f]);
                for (_, g) in self.surface.around(f).filter(|&(_, g)| may(g)) {
                    let (a, b) = (labels[f].min(labels[g]), labels[f].max(labels[g]));
                    if a != b && curved[a as usize] && curved[b as usize] {
                        memory::push(borders.entry([a, b]).or_default(), f as u32)?;
                    }
                }
            }
            for (pair, faces) in borders {
                self.progress.check()?;
                if self.progress.is_finishing() {
                    return Ok(());
                }
                self.cut(labels, pair, &faces);
            }
        }
        Ok(())
    }

    /// Moves the border between the segments of a `pair`, which touches `faces`.
    fn cut(&self, labels: &mut [u32], pair: [u32; 2], faces: &[u32]) {
        let rows = self.band(labels, pair, faces);
        let deepest = pair.map(|label| {
            let own = rows.iter().filter(|(f, _)| labels[**f as usize] == label);
            own.map(|(_, row)| *row).max().unwrap_or(0)
        });
        if deepest.contains(&0) {
            return;
        }
        // Nodes 0 and 1 are what the segments keep, their last rows; each other face is one of its own.
        let mut free = Vec::new();
        let mut nodes: BTreeMap<u32, u32> = BTreeMap::new();
        for (&f, &row) in &rows {
            let side = u32::from(labels[f as usize] == pair[1]);
            if row == deepest[side as usize] {
                nodes.insert(f, side);
            } else {
                nodes.insert(f, free.len() as u32 + 2);
                free.push(f);
            }
        }
        let mut edges = Vec::new();
        for (&f, &node) in &nodes {
            for (h, g) in self.surface.around(f as usize).filter(|(_, g)| *g as u32 > f) {
                if let Some(&other) = nodes.get(&(g as u32)).filter(|other| **other != node) {
                    edges.push(([node, other], self.costs[f as usize][h % 3]));
                }
            }
        }
        let first = Graph::new(free.len() + 2, &edges).cut(0, 1);
        for (f, is_first) in free.iter().zip(&first[2..]) {
            labels[*f as usize] = if *is_first { pair[0] } else { pair[1] };
        }
    }

    /// The faces of two segments around their border, each with its row, from 0 at the border.
    fn band(&self, labels: &[u32], pair: [u32; 2], faces: &[u32]) -> BTreeMap<u32, usize> {
        let mut row: BTreeSet<u32> =
            faces.iter().copied().filter(|f| pair.contains(&labels[*f as usize])).collect();
        let mut rows: BTreeMap<u32, usize> = row.iter().map(|f| (*f, 0)).collect();
        for depth in 1..=BAND_ROWS {
            let beside = |f: &u32| {
                let label = labels[*f as usize];
                self.surface
                    .around(*f as usize)
                    .map(|(_, g)| g as u32)
                    .filter(move |g| labels[*g as usize] == label)
            };
            row = row.iter().flat_map(beside).filter(|g| !rows.contains_key(g)).collect();
            rows.extend(row.iter().map(|f| (*f, depth)));
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::partition::contiguous;
    use crate::shapes;

    #[test]
    fn teeth_go_and_the_segments_stay() {
        let mesh = shapes::icosphere(3).mesh().unwrap();
        let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
        let costs = vec![[1.0; 3]; connectivity.n_faces()];
        let surface = Surface::new(connectivity, positions, 1.0, costs).unwrap();
        let side = |f: usize, tooth: f64| u32::from(surface.centroids[f][2] > tooth);
        let mut labels: Vec<u32> =
            (0..surface.n_faces()).map(|f| side(f, if f % 3 == 0 { 0.15 } else { 0.0 })).collect();
        let length = |labels: &[u32]| -> usize {
            (0..labels.len())
                .map(|f| surface.around(f).filter(|(_, g)| labels[*g] != labels[f]).count())
                .sum()
        };
        let before = length(&labels);
        Straighten::new(&surface, 0.0, None, &Progress::new()).unwrap().run(&mut labels).unwrap();
        assert!(3 * length(&labels) < 2 * before, "{} of {before}", length(&labels));
        assert_eq!(contiguous(&labels).unwrap().1, 2);
    }
}
