//! Approximate minimum degree, as the library has it: the best order of small matrices and of the leaves of a dissection.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::amd;
use faer::sparse::SymbolicSparseColMatRef;

use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;

/// The rows of a pattern in an order that approximate minimum degree finds.
///
/// # Errors
/// [`SolveError::Factorization`] when the library refuses the pattern.
pub fn minimum_degree(pattern: &LowerPattern) -> Result<Vec<u32>, SolveError> {
    let n = pattern.n;
    let view = SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
    let (mut forward, mut backward) = (vec![0usize; n], vec![0usize; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, pattern.rows.len()));
    amd::order(&mut forward, &mut backward, view, amd::Control::default(), MemStack::new(&mut memory))
        .map_err(|e| SolveError::Factorization { reason: format!("{e:?}") })?;
    Ok(forward.iter().map(|&i| i as u32).collect())
}
