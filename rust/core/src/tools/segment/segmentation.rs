//! What came out of a segmentation.

use super::hierarchy::Hierarchy;
use crate::linear::Columns;
use crate::mesh::Mesh;
use crate::solve::Status;
use crate::{memory, Result};

/// What came out of a segmentation.
#[derive(Debug, Clone, PartialEq)]
pub struct Segmentation {
    /// The segment of each face, from 0 in the order of their first faces; −1 for faces that took no part.
    pub labels: Vec<i32>,
    /// How many segments there are.
    pub n_segments: usize,
    /// `v`: near 1 inside segments, near 0 at borders, one for each face; 1 for faces that took no part.
    pub indicator: Vec<f64>,
    /// `u`: the signal with borders sharpened, in the units of the input;
    /// for positions the sharpened surface.
    pub values: Columns,
    /// The vertices of the edges between segments.
    pub boundary_edges: Vec<[u32; 2]>,
    /// Coarser and finer segmentations, nested.
    pub hierarchy: Hierarchy,
    /// The noise found in the signal, in its units; 0 where the fidelity was given.
    pub noise: f64,
    /// The fidelity weight at the end.
    pub fidelity: f64,
    /// The values of `ε`, from the first to the last.
    pub epsilons: Vec<f64>,
    /// How often indicator and signal took turns.
    pub alternations: usize,
    /// `Solved`, or `Stopped` if the caller asked to finish early: then with fewer values of `ε`.
    pub status: Status,
}

/// The vertices of the edges between faces of different labels, −1 not counted as one.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(in crate::tools) fn boundary_edges(mesh: &Mesh, labels: &[i32]) -> Result<Vec<[u32; 2]>> {
    let connectivity = mesh.connectivity();
    let between = |h: usize| {
        connectivity.mate(h).is_some_and(|mate| {
            let (a, b) = (labels[h / 3], labels[mate / 3]);
            a != b && a >= 0 && b >= 0
        })
    };
    let ends = |h: usize| [connectivity.tail(h), connectivity.head(h)];
    Ok(memory::sifted(connectivity.edges().filter(|&h| between(h)).map(ends))?)
}
