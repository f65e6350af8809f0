//! `HᵀRH + D` for a block operator `H`, a scalar `R` per block and a diagonal `D`, on a pattern found once.

use crate::block_rows::{BlockRows, BLOCK};
use crate::buckets::Buckets;
use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::memory;
use crate::solve::primal_dual::Stiffness;

/// Where each product of two entries of a block lands in the lower triangle of `HᵀRH`.
#[derive(Debug, Clone)]
pub struct NormalMatrix {
    /// Per block, for its entries `i >= j` in row order, the index into the values.
    landing: Vec<u32>,
    pattern: LowerPattern,
}

impl NormalMatrix {
    /// Finds the pattern in one pass over the blocks and one sort of each column.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give what it takes.
    pub fn new(operator: &BlockRows) -> Result<Self, SolveError> {
        let n = operator.n_columns;
        let mut gathered = Buckets::try_new(n, |visit| {
            (0..n).for_each(|j| visit(j, j as u32));
            for b in 0..operator.n_blocks() {
                let (columns, _) = operator.block(b);
                for (i, &row) in columns.iter().enumerate() {
                    columns[..i].iter().for_each(|&column| visit(column as usize, row));
                }
            }
        })?;
        let mut starts = memory::room(n + 1)?;
        (0..n).for_each(|j| gathered.of_mut(j).sort_unstable());
        let distinct = |j| gathered.of(j).chunk_by(|a, b| a == b).count();
        let mut rows: Vec<usize> = memory::room((0..n).map(distinct).sum())?;
        starts.push(0);
        for j in 0..n {
            let first = rows.len();
            for &row in gathered.of(j) {
                if rows.len() == first || rows[rows.len() - 1] != row as usize {
                    rows.push(row as usize);
                }
            }
            starts.push(rows.len());
        }
        let size = |b| operator.block(b).0.len();
        let products = (0..operator.n_blocks()).map(|b| size(b) * (size(b) + 1) / 2).sum();
        let mut landing = memory::room(products)?;
        for b in 0..operator.n_blocks() {
            let columns = &operator.columns[operator.starts[b]..operator.starts[b + 1]];
            for (i, &row) in columns.iter().enumerate() {
                for &column in &columns[..=i] {
                    let range = starts[column as usize]..starts[column as usize + 1];
                    let offset = rows[range.clone()].partition_point(|&r| r < row as usize);
                    landing.push((range.start + offset) as u32);
                }
            }
        }
        Ok(Self { landing, pattern: LowerPattern { n, starts, rows } })
    }

    /// The lower triangle's pattern; every diagonal entry is there.
    #[must_use]
    pub fn pattern(&self) -> &LowerPattern {
        &self.pattern
    }

    /// The values of `HᵀRH + diag(d)`, one per entry of the pattern.
    pub fn assemble(&self, operator: &BlockRows, r: &[f64], diagonal: &[f64], values: &mut Vec<f64>) {
        self.sum(operator, |b, x| x.map(|v| v * r[b]), diagonal, values);
    }

    /// The values of `HᵀVH + diag(d)` for a matrix `V` per block.
    pub fn assemble_stiff(
        &self,
        operator: &BlockRows,
        stiffness: &[Stiffness],
        diagonal: &[f64],
        values: &mut Vec<f64>,
    ) {
        self.sum(operator, |b, x| stiffness[b].times(x), diagonal, values);
    }

    fn sum(
        &self,
        operator: &BlockRows,
        weigh: impl Fn(usize, &[f64; BLOCK]) -> [f64; BLOCK],
        diagonal: &[f64],
        values: &mut Vec<f64>,
    ) {
        values.clear();
        values.resize(self.pattern.rows.len(), 0.0);
        let mut landing = self.landing.iter();
        for b in 0..operator.n_blocks() {
            let (_, entries) = operator.block(b);
            for (i, x) in entries.iter().enumerate() {
                let scaled = weigh(b, x);
                for (y, &at) in entries[..=i].iter().zip(&mut landing) {
                    values[at as usize] += scaled[0] * y[0] + scaled[1] * y[1] + scaled[2] * y[2];
                }
            }
        }
        for (j, d) in diagonal.iter().enumerate() {
            values[self.pattern.starts[j]] += d;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::linear::cholesky::Cholesky;

    fn operator() -> BlockRows {
        BlockRows {
            n_columns: 4,
            starts: vec![0, 3, 3, 5],
            columns: vec![0, 1, 3, 1, 2],
            values: vec![[1.0, 2.0, 0.0], [0.0, 1.0, -1.0], [3.0, 0.5, 1.0], [2.0, 0.0, 1.0], [-1.0, 1.0, 4.0]],
        }
    }

    /// `HᵀRH + D`, entry by entry.
    fn dense(h: &BlockRows, r: &[f64], d: &[f64]) -> Vec<Vec<f64>> {
        let mut out = vec![vec![0.0; h.n_columns]; h.n_columns];
        for (b, weight) in r.iter().enumerate() {
            let (columns, values) = h.block(b);
            for (&i, x) in columns.iter().zip(values) {
                for (&j, y) in columns.iter().zip(values) {
                    out[i as usize][j as usize] += weight * (x[0] * y[0] + x[1] * y[1] + x[2] * y[2]);
                }
            }
        }
        for (i, d) in d.iter().enumerate() {
            out[i][i] += d;
        }
        out
    }

    #[test]
    fn agrees_with_the_dense_product_and_solves() {
        let (h, r, d) = (operator(), [2.0, 7.0, 0.5], [0.1, 0.2, 0.3, 0.4]);
        let normal = NormalMatrix::new(&h).unwrap();
        let mut values = Vec::new();
        normal.assemble(&h, &r, &d, &mut values);
        let expected = dense(&h, &r, &d);
        let pattern = normal.pattern();
        let mut seen = 0;
        for (j, bounds) in pattern.starts.windows(2).enumerate() {
            assert_eq!(pattern.rows[bounds[0]], j, "the diagonal comes first");
            for k in bounds[0]..bounds[1] {
                assert!((values[k] - expected[pattern.rows[k]][j]).abs() < 1e-13);
                seen += usize::from(pattern.rows[k] != j) + 1;
            }
        }
        assert_eq!(seen, 4 + 2 * 4, "no entry is missing: four off the diagonal");

        let mut cholesky = Cholesky::analyze(pattern.clone(), None).unwrap();
        cholesky.factorize(&values).unwrap();
        let x = [1.0, -2.0, 3.0, 0.5, 0.0, 4.0, -1.0, 2.0];
        let mut right: Vec<[f64; 2]> = expected
            .iter()
            .map(|row| std::array::from_fn(|c| row.iter().enumerate().map(|(j, v)| v * x[4 * c + j]).sum()))
            .collect();
        cholesky.solve(&mut right);
        for (i, right) in right.iter().enumerate() {
            assert!((0..2).all(|c| (right[c] - x[4 * c + i]).abs() < 1e-12));
        }
        assert!(cholesky.factorize(&vec![0.0; values.len()]).is_err());
    }
}
