//! A sparse matrix made of blocks of [`BLOCK`] rows that share their columns: one block a face,
//! one cone a block.

use crate::error::SolveError;
use crate::{memory, Error, Result};

/// Rows of one block: `xx`, `yy`, `√2·xy` of a face's Hessian (same Frobenius norm as the four entries).
pub const BLOCK: usize = 3;

/// A sparse matrix of `BLOCK · n_blocks` rows. All rows of a block have the same columns,
/// sorted and without repeats.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockRows {
    /// Number of columns.
    pub n_columns: usize,
    /// Block `b` owns the entries `starts[b]..starts[b + 1]`; length `n_blocks + 1`.
    pub starts: Vec<usize>,
    /// The column of each entry.
    pub columns: Vec<u32>,
    /// The `BLOCK` row values of each entry.
    pub values: Vec<[f64; BLOCK]>,
}

impl BlockRows {
    /// A matrix with columns and no blocks yet.
    #[must_use]
    pub fn empty(n_columns: usize) -> Self {
        Self { n_columns, starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    /// The same, with room for so many blocks and entries.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn with_room(n_columns: usize, n_blocks: usize, n_entries: usize) -> Result<Self> {
        let mut starts = memory::room(n_blocks + 1)?;
        starts.push(0);
        Ok(Self { n_columns, starts, columns: memory::room(n_entries)?, values: memory::room(n_entries)? })
    }

    /// Appends a block with these `(column, row values)`, in any order; values of a repeated column add up.
    pub fn push_block(&mut self, entries: impl IntoIterator<Item = (u32, [f64; BLOCK])>) {
        let mut sorted: Vec<(u32, [f64; BLOCK])> = entries.into_iter().collect();
        sorted.sort_by_key(|&(column, _)| column);
        for same in sorted.chunk_by(|a, b| a.0 == b.0) {
            let mut sum = [0.0; BLOCK];
            for (_, value) in same {
                sum.iter_mut().zip(value).for_each(|(s, v)| *s += v);
            }
            self.columns.push(same[0].0);
            self.values.push(sum);
        }
        self.starts.push(self.columns.len());
    }

    /// Number of blocks.
    #[must_use]
    pub fn n_blocks(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The columns and values of block `b`.
    #[inline(always)]
    #[must_use]
    pub fn block(&self, b: usize) -> (&[u32], &[[f64; BLOCK]]) {
        let range = self.starts[b]..self.starts[b + 1];
        (&self.columns[range.clone()], &self.values[range])
    }

    /// `Hᵀ W H u` for this matrix `H` and a weight for each block.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn normal_times(&self, weights: &[f64], u: &[f64]) -> std::result::Result<Vec<f64>, SolveError> {
        let mut out = memory::repeated(0.0, u.len())?;
        for (b, w) in weights.iter().enumerate() {
            let h = self.block_times(b, u);
            let (columns, values) = self.block(b);
            for (&column, v) in columns.iter().zip(values) {
                out[column as usize] += w * (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]);
            }
        }
        Ok(out)
    }

    /// Block `b` times the vector `u`.
    #[must_use]
    pub fn block_times(&self, b: usize, u: &[f64]) -> [f64; BLOCK] {
        let (columns, values) = self.block(b);
        let mut sum = [0.0; BLOCK];
        for (&column, value) in columns.iter().zip(values) {
            let x = u[column as usize];
            for (s, v) in sum.iter_mut().zip(value) {
                *s += v * x;
            }
        }
        sum
    }

    /// `‖(H u)_b‖²` of every block, jointly over the columns of `values` (column-major).
    ///
    /// # Errors
    /// [`Error::Argument`] if `values` are not whole columns, [`SolveError::Memory`].
    pub fn block_squares(&self, values: &[f64]) -> Result<Vec<f64>> {
        let n = self.n_columns;
        if !values.len().is_multiple_of(n) {
            let problem = format!(
                "{} numbers are not whole columns of {n} vertex values; pass one per vertex",
                values.len()
            );
            return Err(Error::argument("values", problem));
        }
        let square =
            |b: usize| values.chunks_exact(n.max(1)).map(|column| self.block_square(b, column)).sum();
        Ok(memory::gathered((0..self.n_blocks()).map(square))?)
    }

    /// `‖(H u)_b‖²` of block `b` for one column.
    #[must_use]
    pub fn block_square(&self, b: usize, u: &[f64]) -> f64 {
        self.block_times(b, u).iter().map(|x| x * x).sum()
    }
}
