//! Where a sparse symmetric matrix has entries.

use crate::error::SolveError;
use crate::memory;

/// The lower triangle of a symmetric matrix, column by column with sorted rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LowerPattern {
    /// Number of rows and columns.
    pub n: usize,
    /// Column `j` owns the entries `starts[j]..starts[j + 1]`.
    pub starts: Vec<usize>,
    /// The row of each entry, `>= j`; the diagonal entry comes first.
    pub rows: Vec<usize>,
}

impl LowerPattern {
    /// A copy.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn copied(&self) -> Result<Self, SolveError> {
        Ok(Self { n: self.n, starts: memory::twin(&self.starts)?, rows: memory::twin(&self.rows)? })
    }
}
