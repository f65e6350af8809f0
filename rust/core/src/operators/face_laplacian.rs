//! The Laplacian of functions with one value a face: discrete exterior calculus on the dual mesh.

use crate::error::SolveError;
use crate::memory;
use crate::mesh::{triangle, Connectivity};

/// Distances between centroids below this part of their edge's length count as that much: two faces folded
/// onto each other would be coupled infinitely strongly.
const LEAST_DISTANCE: f64 = 1e-3;

/// The weight of every halfedge, one row a face, column `i` opposite corner `i`: the edge's length over the
/// distance of its faces' `centroids` in space; 0 where there is no twin or a face without area.
///
/// With them the Dirichlet energy of a function `v` on the faces is `Σ weight (v_f − v_g)²` over the interior
/// edges: the face Laplacian `L` of Rowe et al. 2024, supplement E (Desbrun et al. 2005).
///
/// # Errors
/// [`crate::error::SolveError::Memory`] when the system does not give that much.
pub fn face_laplacian_weights(
    connectivity: &Connectivity,
    lengths: &[[f64; 3]],
    centroids: &[[f64; 3]],
) -> Result<Vec<[f64; 3]>, SolveError> {
    let mut weights = memory::repeated([0.0; 3], connectivity.n_faces())?;
    for h in connectivity.edges() {
        let Some(twin) = connectivity.twin(h) else { continue };
        let (f, g) = (h / 3, twin / 3);
        if triangle::is_degenerate(lengths[f]) || triangle::is_degenerate(lengths[g]) {
            continue;
        }
        let length = lengths[f][h % 3];
        let squared: f64 = centroids[f].iter().zip(&centroids[g]).map(|(a, b)| (a - b) * (a - b)).sum();
        let weight = length / squared.sqrt().max(LEAST_DISTANCE * length);
        weights[f][h % 3] = weight;
        weights[g][twin % 3] = weight;
    }
    Ok(weights)
}
