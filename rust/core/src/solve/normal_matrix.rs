//! `HᵀRH + D` for a block operator `H`, a scalar `R` per block and a diagonal `D`, on a pattern found once.

use crate::block_rows::{BlockRows, BLOCK};
use crate::linear::pattern::LowerPattern;
use crate::solve::normal_pattern::pattern_of;
use crate::solve::primal_dual::Stiffness;
use crate::solve::stretching::Stretching;
use crate::{memory, Progress, Result};

/// What is added to the stiffness of a block that is cut, as a part of its scale: where a cone is as good as
/// straight, rounding would leave nothing that holds the new unknowns. A direction of Newton's method is not
/// exact to so many digits.
const LEAST_STIFFNESS: f64 = 1e-10;

/// Where each product of two entries of a block lands in the lower triangle of `HᵀRH`.
#[derive(Debug, Clone)]
pub struct NormalMatrix {
    /// Per block, for its entries `i >= j` in row order, the index into the values.
    landing: Vec<u32>,
    pattern: LowerPattern,
    stretching: Option<Stretching>,
}

impl NormalMatrix {
    /// Finds the pattern in one pass over the blocks and one sort of each column.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`] when the system does not give what it takes.
    pub fn new(operator: &BlockRows) -> Result<Self> {
        Self::of(operator, None)
    }

    /// The same where no block has a negative weight: blocks with many columns are cut into pieces, and the
    /// matrix has further rows for the unknowns between them, behind those of the operator. With zeros there
    /// on the right side its solutions are those of the matrix that is not cut.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`] when the system does not give what it takes;
    /// [`crate::Error::Cancelled`].
    pub fn stretched(operator: &BlockRows, progress: &Progress) -> Result<Self> {
        match Stretching::new(operator, progress)? {
            None => Self::new(operator),
            Some(stretching) => Self::cut(stretching),
        }
    }

    fn cut(stretching: Stretching) -> Result<Self> {
        let rows = stretching.pattern().clone();
        Self::of(&rows, Some(stretching))
    }

    fn of(operator: &BlockRows, stretching: Option<Stretching>) -> Result<Self> {
        let pattern = pattern_of(operator, |_| true)?;
        let LowerPattern { starts, rows, .. } = &pattern;
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
        Ok(Self { landing, pattern, stretching })
    }

    /// The lower triangle's pattern; every diagonal entry is there.
    #[must_use]
    pub fn pattern(&self) -> &LowerPattern {
        &self.pattern
    }

    /// Whether every product of two entries of `operator` lands where it did of the one before: whether it
    /// has the same pattern, and can be cut in the same way.
    #[must_use]
    pub fn fits(&self, operator: &BlockRows) -> bool {
        if let Some(stretching) = &self.stretching {
            return stretching.fits(operator);
        }
        let LowerPattern { n, starts, rows } = &self.pattern;
        let mut landing = self.landing.iter().map(|&at| at as usize);
        operator.n_columns == *n
            && (0..operator.n_blocks()).all(|b| {
                let columns = operator.block(b).0;
                (0..columns.len()).all(|i| {
                    columns[..=i].iter().all(|&column| {
                        let column = starts[column as usize]..starts[column as usize + 1];
                        landing
                            .next()
                            .is_some_and(|at| column.contains(&at) && rows[at] == columns[i] as usize)
                    })
                })
            })
            && landing.next().is_none()
    }

    /// The values of `HᵀRH + diag(d)`, one per entry of the pattern.
    pub fn assemble(&self, operator: &BlockRows, r: &[f64], diagonal: &[f64], values: &mut Vec<f64>) {
        match &self.stretching {
            None => self.sum(operator, |b, x| x.map(|v| v * r[b]), diagonal, values),
            Some(cut) => {
                self.sum(&cut.rows(operator), |b, x| x.map(|v| v * r[cut.block(b)]), diagonal, values);
                self.hold_unknowns(operator, values);
            }
        }
    }

    /// The values of `HᵀVH + diag(d)` for a matrix `V` per block.
    pub fn assemble_stiff(
        &self,
        operator: &BlockRows,
        stiffness: &[Stiffness],
        diagonal: &[f64],
        values: &mut Vec<f64>,
    ) {
        match &self.stretching {
            None => self.sum(operator, |b, x| stiffness[b].times(x), diagonal, values),
            Some(cut) => {
                let weigh = |b: usize, x: &[f64; BLOCK]| {
                    let stiffness = &stiffness[cut.block(b)];
                    let least = if cut.is_piece(b) { LEAST_STIFFNESS * stiffness.scale } else { 0.0 };
                    let product = stiffness.times(x);
                    std::array::from_fn(|r| product[r] + least * x[r])
                };
                self.sum(&cut.rows(operator), weigh, diagonal, values);
                self.hold_unknowns(operator, values);
            }
        }
    }

    /// Unknowns between the pieces of a block without weight are zero.
    fn hold_unknowns(&self, operator: &BlockRows, values: &mut [f64]) {
        for &start in &self.pattern.starts[operator.n_columns..self.pattern.n] {
            if values[start] == 0.0 {
                values[start] = 1.0;
            }
        }
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
            values: vec![
                [1.0, 2.0, 0.0],
                [0.0, 1.0, -1.0],
                [3.0, 0.5, 1.0],
                [2.0, 0.0, 1.0],
                [-1.0, 1.0, 4.0],
            ],
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

        let mut cholesky = Cholesky::analyze(pattern, None, &Progress::new()).unwrap();
        cholesky.factorize(&values, &Progress::new()).unwrap();
        let x = [1.0, -2.0, 3.0, 0.5, 0.0, 4.0, -1.0, 2.0];
        let mut right: Vec<[f64; 2]> = expected
            .iter()
            .map(|row| std::array::from_fn(|c| row.iter().enumerate().map(|(j, v)| v * x[4 * c + j]).sum()))
            .collect();
        cholesky.solve(&mut right).unwrap();
        for (i, right) in right.iter().enumerate() {
            assert!((0..2).all(|c| (right[c] - x[4 * c + i]).abs() < 1e-12));
        }
        assert!(cholesky.factorize(&vec![0.0; values.len()], &Progress::new()).is_err());
    }

    /// Values may change; a column, an entry, or a block that goes somewhere else is another pattern.
    #[test]
    fn only_an_operator_with_the_same_entries_fits() {
        let h = operator();
        let normal = NormalMatrix::new(&h).unwrap();
        let changed = |change: &dyn Fn(&mut BlockRows)| {
            let mut other = operator();
            change(&mut other);
            other
        };
        assert!(normal.fits(&changed(&|other| other.values[2] = [0.0; BLOCK])));
        for (what, other) in [
            ("a column", changed(&|other| other.columns[4] = 3)),
            ("another number of columns", changed(&|other| other.n_columns = 5)),
            ("an entry in another block", changed(&|other| other.starts = vec![0, 2, 2, 5])),
            ("blocks joined", changed(&|other| other.starts = vec![0, 5])),
            ("a block less", changed(&|other| other.starts = vec![0, 3])),
        ] {
            assert!(!normal.fits(&other), "{what}");
        }
        // A block without entries lands nowhere.
        assert!(normal.fits(&changed(&|other| other.starts = vec![0, 3, 5])));
    }
}
