//! The edge Laplacian of He and Schaefer 2013.

use crate::block_rows::BlockRows;
use crate::mesh::Mesh;
use crate::operators::hinge::{usable_areas, Hinge};

/// The area-based edge operator (He and Schaefer 2013) on every edge between two faces, and those two faces.
///
/// A block an edge, its only nonzero row `D(e)`: the jump of the gradient across the edge times
/// `h_f h_g / (h_f + h_g)`, the heights of the two triangles, so that its coefficients at the two opposite
/// corners are positive and sum to 1, as those at the ends of the edge sum to −1. The difference, in the unit
/// of the values, between the two diagonals of the unfolded pair of triangles where they cross. Affine
/// functions on unfolded pairs are in its kernel.
#[must_use]
pub fn edge_laplacian_rows(mesh: &Mesh) -> (BlockRows, Vec<[usize; 2]>) {
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let areas = usable_areas(lengths);
    let mut rows = BlockRows::empty(connectivity.n_vertices());
    let mut faces = Vec::new();
    for h in connectivity.edges().filter(|h| areas[h / 3] > 0.0) {
        let Some(twin) = connectivity.twin(h).filter(|twin| areas[twin / 3] > 0.0) else { continue };
        let hinge = Hinge::new(lengths, &areas, h, twin);
        let ([_, h_f], [_, h_g]) = (hinge.face, hinge.neighbor);
        let scale = -h_f * h_g / (h_f + h_g);
        let vertices = [
            connectivity.tail(h),
            connectivity.head(h),
            connectivity.opposite(h),
            connectivity.opposite(twin),
        ];
        rows.push_block(
            vertices.into_iter().zip(hinge.jump()).map(|(v, jump)| (v, [scale * jump, 0.0, 0.0])),
        );
        faces.push([h / 3, twin / 3]);
    }
    (rows, faces)
}
