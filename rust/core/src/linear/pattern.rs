//! Where a sparse symmetric matrix has entries.

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
