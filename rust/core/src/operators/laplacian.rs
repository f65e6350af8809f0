//! The cotangent Laplacian.

use crate::mesh::{triangle, Connectivity};

/// The cotangent Laplacian (Pinkall and Polthier 1993), `n × n`, symmetric and positive semidefinite: `uᵀ L u = ∫ |∇u|²` for
/// the piecewise linear `u`. Off the diagonal it has `−(cot α + cot β) / 2`; its rows sum to 0.
///
/// Degenerate faces ([`triangle::is_degenerate`]) contribute nothing.
#[must_use]
pub fn cotangent_laplacian(connectivity: &Connectivity, lengths: &[[f64; 3]]) -> sprs::CsMat<f64> {
    let n = connectivity.n_vertices();
    let mut triplets = sprs::TriMat::with_capacity((n, n), 12 * connectivity.n_faces());
    for (f, &l) in lengths.iter().enumerate().filter(|(_, &l)| !triangle::is_degenerate(l)) {
        for (i, cotangent) in triangle::cotangents(l).into_iter().enumerate() {
            let (tail, head) = (connectivity.tail(3 * f + i) as usize, connectivity.head(3 * f + i) as usize);
            let weight = 0.5 * cotangent;
            triplets.add_triplet(tail, tail, weight);
            triplets.add_triplet(head, head, weight);
            triplets.add_triplet(tail, head, -weight);
            triplets.add_triplet(head, tail, -weight);
        }
    }
    triplets.to_csr()
}
