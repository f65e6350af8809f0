//! How sharp the borders between segments are: the bend across each border edge, measured on both sides of it
//! and corrected for the curvature inside the segments.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::slopes::Slopes;
use super::surface::{Surface, NONE};
use super::walk::{Bend, Marks, Walk};
use crate::{memory, Result};

/// The common border of two segments, `labels[0] < labels[1]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Border {
    pub labels: [u32; 2],
    pub length: f64,
    /// The mean bend (the jump of the gradient, radians for positions) over the cost of a border there;
    /// more for a short contact.
    pub strength: f64,
}

impl Slopes {
    /// The borders between the segments, sorted by their labels.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn borders(&self, surface: &Surface<'_>, labels: &[u32]) -> Result<Vec<Border>> {
        let is_border = |&h: &usize| {
            let g = surface.neighbors[h / 3][h % 3];
            g != NONE && labels[g as usize] != labels[h / 3]
        };
        let edges: Vec<usize> = memory::sifted(surface.connectivity.edges().filter(is_border))?;
        let n = surface.n_faces();
        let at_border = memory::joined((0..n).into_par_iter().map(|f| surface.is_at_border(labels, f)))?;
        let walk = Walk { slopes: self, surface, labels, at_border: &at_border };
        let bend = |marks: &mut Result<Marks>, &h: &usize| match marks {
            Ok(marks) => walk.bend(h, marks),
            Err(error) => Err(error.clone()),
        };
        let bends = edges.par_iter().with_min_len(64).map_init(|| Marks::new(n), bend);
        let mut bends: Vec<Bend> = memory::all(memory::joined(bends)?)?;
        bends.sort_unstable_by_key(|bend| (bend.labels, bend.halfedge));
        let same = bends.chunk_by(|a, b| a.labels == b.labels);
        let mut borders: Vec<Border> = memory::sifted(same.map(Border::of))?;
        let mut perimeters: BTreeMap<u32, f64> = BTreeMap::new();
        for border in &borders {
            for label in border.labels {
                *perimeters.entry(label).or_default() += border.length;
            }
        }
        for border in &mut borders {
            let perimeter = perimeters[&border.labels[0]].min(perimeters[&border.labels[1]]);
            border.strength *=
                (self.least_contact * perimeter / border.length.max(f64::MIN_POSITIVE)).max(1.0);
        }
        Ok(borders)
    }
}

impl Border {
    fn of(bends: &[Bend]) -> Self {
        let length: f64 = bends.iter().map(|b| b.length).sum();
        let sum: f64 = bends.iter().map(|b| b.length * b.bend / b.cost).sum();
        Self { labels: bends[0].labels, length, strength: sum / length.max(f64::MIN_POSITIVE) }
    }
}
