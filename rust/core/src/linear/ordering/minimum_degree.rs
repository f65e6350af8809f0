//! Approximate minimum degree, as the library has it: the best order of small matrices and of the leaves of a
//! dissection.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::amd;
use faer::sparse::SymbolicSparseColMatRef;

use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::memory;

/// The rows of a pattern in an order that approximate minimum degree finds.
///
/// # Errors
/// [`SolveError::Factorization`] when the library refuses the pattern.
pub fn minimum_degree(pattern: &LowerPattern) -> Result<Vec<u32>, SolveError> {
    let n = pattern.n;
    let view = SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
    let (mut forward, mut backward) = (memory::repeated(0usize, n)?, memory::repeated(0usize, n)?);
    let scratch = amd::order_scratch::<usize>(n, pattern.rows.len());
    let refused = |_| SolveError::Memory { needed: scratch.size_bytes(), limit: None };
    let mut buffer = MemBuffer::try_new(scratch).map_err(refused)?;
    amd::order(&mut forward, &mut backward, view, amd::Control::default(), MemStack::new(&mut buffer))
        .map_err(|e| SolveError::Factorization { reason: format!("{e:?}") })?;
    let mut order = memory::room(n)?;
    order.extend(forward.iter().map(|&i| i as u32));
    Ok(order)
}
