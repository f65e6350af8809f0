//! How fronts are stored: dense, column by column, padded to whole vector registers.

use crate::error::SolveError;
use crate::linear::real::Real;
use crate::memory;

/// Columns that are brought up to date and eliminated together.
pub(super) const COLUMNS: usize = 4;

/// Strides are multiples of this: two of the widest vector registers.
const ALIGNMENT: usize = 16;

/// Groups of so many rows are enough for the stride to matter.
const LONG: usize = 4;

/// A dense matrix stored column by column, rows and columns padded so that whole registers and groups of
/// columns fit.
#[derive(Debug, Default)]
pub(crate) struct Padded<R> {
    /// The numbers; those in the padding mean nothing.
    pub values: Vec<R>,
    /// From one column to the next.
    pub stride: usize,
}

/// The stride of a matrix with so many rows.
#[must_use]
pub(super) fn stride_of(n_rows: usize) -> usize {
    let groups = n_rows.div_ceil(ALIGNMENT);
    // Even multiples put the same row of many columns in few sets of the cache:
    // up to a fifth slower products.
    ALIGNMENT * if groups > LONG { groups | 1 } else { groups }
}

/// Numbers in a matrix of so many rows and columns.
#[must_use]
pub(super) fn len_of(n_rows: usize, n_columns: usize) -> usize {
    // Registers that start inside the last column may end behind it.
    stride_of(n_rows) * n_columns.next_multiple_of(COLUMNS) + ALIGNMENT
}

impl<R: Real> Padded<R> {
    /// Becomes a matrix whose lower triangle is zero. What was above the diagonal may stay: nothing reads it.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(crate) fn clear(&mut self, n_rows: usize, n_columns: usize) -> Result<(), SolveError> {
        self.stride = stride_of(n_rows);
        let len = len_of(n_rows, n_columns);
        memory::grow(&mut self.values, len, R::ZERO)?;
        for (j, column) in self.values[..len].chunks_mut(self.stride.max(1)).enumerate() {
            let from = (j / ALIGNMENT * ALIGNMENT).min(column.len());
            column[from..].fill(R::ZERO);
        }
        Ok(())
    }
}

/// Numbers in what is left of a front with `n` rows below its panel, stored like [`Padded`].
#[must_use]
pub(super) fn update_len(n: usize) -> usize {
    if n == 0 {
        return 0;
    }
    len_of(n, n)
}
