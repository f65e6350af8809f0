//! The cotangent Laplacian, and the energy of its square.

use crate::block_rows::BlockRows;
use crate::buckets::Buckets;
use crate::mesh::{triangle, Connectivity};
use crate::operators::voronoi_mass;
use crate::{memory, Result};

/// The cotangent Laplacian (Pinkall and Polthier 1993), `n × n`, symmetric and positive semidefinite:
/// `uᵀ L u = ∫ |∇u|²` for the piecewise linear `u`. Off the diagonal it has `−(cot α + cot β) / 2`; its rows
/// sum to 0.
///
/// Degenerate faces ([`triangle::is_degenerate`]) contribute nothing.
///
/// # Errors
/// [`crate::error::SolveError::Memory`].
pub fn cotangent_laplacian(connectivity: &Connectivity, lengths: &[[f64; 3]]) -> Result<sprs::CsMat<f64>> {
    let n = connectivity.n_vertices();
    let halves = |&l: &[f64; 3]| {
        if triangle::is_degenerate(l) {
            [0.0; 3]
        } else {
            triangle::cotangents(l).map(|c| 0.5 * c)
        }
    };
    let weights: Vec<[f64; 3]> = memory::gathered(lengths.iter().map(halves))?;
    let mut neighbors = Buckets::new(n, |visit| {
        for (h, &weight) in weights.as_flattened().iter().enumerate() {
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            visit(tail as usize, (head, weight));
            visit(head as usize, (tail, weight));
        }
    })?;
    let mut indptr = memory::room(n + 1)?;
    let most = 2 * connectivity.edges().count() + n;
    let (mut indices, mut data) = (memory::room(most)?, memory::room(most)?);
    indptr.push(0);
    for v in 0..n {
        let row = neighbors.of_mut(v);
        // Stable, so that both rows of an edge add its weights in the same order: symmetric to the last bit.
        row.sort_by_key(|&(column, _)| column);
        let diagonal: f64 =
            row.iter().filter(|&&(column, _)| column as usize != v).map(|(_, weight)| weight).sum();
        let place = row.partition_point(|&(column, _)| (column as usize) < v);
        let before = row[..place].chunk_by(|a, b| a.0 == b.0);
        let after = row[place..].chunk_by(|a, b| a.0 == b.0).filter(|edge| edge[0].0 as usize != v);
        let weights =
            |edge: &[(u32, f64)]| (edge[0].0 as usize, -edge.iter().map(|(_, weight)| weight).sum::<f64>());
        for (column, value) in before.map(weights).chain([(v, diagonal)]).chain(after.map(weights)) {
            indices.push(column);
            data.push(value);
        }
        indptr.push(indices.len());
    }
    Ok(sprs::CsMat::new((n, n), indptr, indices, data))
}

/// Rows whose squares sum to `∫ |Δu|² = uᵀ L M⁻¹ L u` (Rowe et al. 2024, eq. (1), left, twice): a block a
/// vertex, its only nonzero row `(L u)_v / √M_v`, with the [`cotangent_laplacian`] `L` and the
/// [`voronoi_mass`] `M`.
///
/// At the boundary `L` itself sets the normal derivative to zero (zero Neumann conditions). Vertices without
/// mass have an empty block.
///
/// # Errors
/// [`crate::error::SolveError::Memory`].
pub fn laplacian_squares(connectivity: &Connectivity, lengths: &[[f64; 3]]) -> Result<BlockRows> {
    let laplacian = cotangent_laplacian(connectivity, lengths)?;
    let n = connectivity.n_vertices();
    let mut rows = BlockRows::with_room(n, n, laplacian.nnz())?;
    for (row, mass) in laplacian.outer_iterator().zip(voronoi_mass(connectivity, lengths)?) {
        let scale = if mass > 0.0 { 1.0 / mass.sqrt() } else { 0.0 };
        let entries = row.iter().filter(|&(_, &value)| value * scale != 0.0);
        rows.push_block(entries.map(|(column, value)| (column as u32, [value * scale, 0.0, 0.0])));
    }
    Ok(rows)
}
