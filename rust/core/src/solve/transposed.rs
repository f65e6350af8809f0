//! The operator read by columns, so that `Hᵀ y` is gathered row by row: no two threads write the same place.

use rayon::prelude::*;

use crate::block_rows::BlockRows;
use crate::solve::cones::Block;
use crate::solve::reduced::GRAIN;

/// Which entries of which blocks stand in each column.
#[derive(Debug, Clone)]
pub struct Transposed {
    starts: Vec<usize>,
    /// `(entry, block)` for each entry of each column, blocks ascending.
    entries: Vec<(u32, u32)>,
}

impl Transposed {
    /// Sorts the entries by column in two passes.
    #[must_use]
    pub fn new(operator: &BlockRows) -> Self {
        let n = operator.n_columns;
        let mut starts = vec![0usize; n + 1];
        for &column in &operator.columns {
            starts[column as usize + 1] += 1;
        }
        for j in 0..n {
            starts[j + 1] += starts[j];
        }
        let mut fill: Vec<usize> = starts[..n].to_vec();
        let mut entries = vec![(0, 0); operator.columns.len()];
        for b in 0..operator.n_blocks() {
            for entry in operator.starts[b]..operator.starts[b + 1] {
                let column = operator.columns[entry] as usize;
                entries[fill[column]] = (entry as u32, b as u32);
                fill[column] += 1;
            }
        }
        Self { starts, entries }
    }

    /// `out = Hᵀ y`.
    pub fn apply<const K: usize>(&self, operator: &BlockRows, y: &[Block<K>], out: &mut Vec<[f64; K]>) {
        (0..operator.n_columns)
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|j| {
                let mut sum = [0.0; K];
                for &(entry, block) in &self.entries[self.starts[j]..self.starts[j + 1]] {
                    let value = &operator.values[entry as usize];
                    for (v, row) in value.iter().zip(&y[block as usize]) {
                        for (s, x) in sum.iter_mut().zip(row) {
                            *s += v * x;
                        }
                    }
                }
                sum
            })
            .collect_into_vec(out);
    }
}
