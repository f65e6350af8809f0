//! Orders of rows that leave few entries in a factor.

mod dissection;
mod graph;
mod minimum_degree;
mod postorder;
mod separator;

pub use dissection::nested_dissection;
pub use minimum_degree::minimum_degree;
pub use postorder::postordered;

use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;

/// From this number of rows on nested dissection comes first. On matrices of this kind it leaves 19 % fewer
/// entries than minimum degree at 58k and at 200k rows, and none at 9k, and costs half a factorization
/// (measured).
const DISSECTED_FROM: usize = 25_000;

/// The rows of a pattern in the order in which a factorization eliminates them:
/// a postorder of its elimination tree.
///
/// # Errors
/// [`SolveError::Factorization`] when the ordering fails, [`SolveError::Memory`].
pub fn eliminated(pattern: &LowerPattern) -> Result<Vec<usize>, SolveError> {
    let first =
        if pattern.n < DISSECTED_FROM { minimum_degree(pattern)? } else { nested_dissection(pattern)? };
    postordered(pattern, &first)
}
