//! `A u = b` inside a linear system, by its Schur complement: for few rows, sparse or dense.

use sprs::CsMat;

use crate::error::SolveError;
use crate::linear::cholesky::Cholesky;
use crate::linear::small::DenseCholesky;
use crate::linear::Columns;
use crate::memory;
use crate::solve::free_operator::FreeOperator;

/// Constraints on the free rows, and the Schur complement that belongs to the last factorization.
#[derive(Debug)]
pub struct LinearConstraints<const K: usize> {
    /// `A` on the free rows, a sparse row each.
    rows: Vec<Vec<(u32, f64)>>,
    /// `b` less what the fixed rows contribute.
    pub right: Vec<[f64; K]>,
    /// `K⁻¹Aᵀ`, column by column.
    response: Vec<[f64; 1]>,
    /// The factored `A K⁻¹ Aᵀ`.
    schur: Option<DenseCholesky>,
}

impl<const K: usize> LinearConstraints<K> {
    /// Moves the fixed rows to the right side.
    ///
    /// # Errors
    /// [`SolveError::Infeasible`] when a constraint has no free row left and does not hold.
    pub fn new(
        matrix: &CsMat<f64>,
        right: &Columns,
        free: &FreeOperator<'_>,
        columns: &[usize],
        fixed_row: &dyn Fn(usize) -> [f64; K],
    ) -> Result<Self, SolveError> {
        let by_rows;
        let matrix = if matrix.is_csr() {
            matrix
        } else {
            by_rows = matrix.to_csr();
            &by_rows
        };
        let mut rows = Vec::new();
        let mut rights = Vec::new();
        for (p, row) in matrix.outer_iterator().enumerate() {
            let mut rest: [f64; K] =
                std::array::from_fn(|c| columns.get(c).map_or(0.0, |&k| right.column(k)[p]));
            let size = rest.iter().fold(1.0f64, |a, x| a.max(x.abs()));
            let mut kept = memory::room(row.nnz())?;
            for (i, &value) in row.iter() {
                match free.place[i] {
                    Some(k) => kept.push((k, value)),
                    None => {
                        let x = fixed_row(i);
                        rest.iter_mut().zip(&x).for_each(|(r, x)| *r -= value * x);
                    }
                }
            }
            if kept.iter().any(|&(_, v)| v != 0.0) {
                rows.push(kept);
                rights.push(rest);
            } else if rest.iter().any(|r| r.abs() > 1e-9 * size) {
                return Err(SolveError::Infeasible {
                    reason: format!("linear constraint {p} speaks of fixed values only and contradicts them"),
                });
            }
        }
        Ok(Self { rows, right: rights, response: Vec::new(), schur: None })
    }

    /// Number of constraints.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The rows of `A`, as (free row, value).
    #[must_use]
    pub fn rows(&self) -> &[Vec<(u32, f64)>] {
        &self.rows
    }

    /// `A u`.
    #[must_use]
    pub fn apply(&self, u: &[[f64; K]]) -> Vec<[f64; K]> {
        let times = |row: &Vec<(u32, f64)>| {
            row.iter().fold([0.0; K], |mut sum, &(i, v)| {
                sum.iter_mut().zip(&u[i as usize]).for_each(|(s, x)| *s += v * x);
                sum
            })
        };
        self.rows.iter().map(times).collect()
    }

    /// `out += Aᵀ y`.
    pub fn add_transposed(&self, y: &[[f64; K]], out: &mut [[f64; K]]) {
        for (row, y) in self.rows.iter().zip(y) {
            for &(i, v) in row {
                out[i as usize].iter_mut().zip(y).for_each(|(o, y)| *o += v * y);
            }
        }
    }

    /// Forms and factors the Schur complement of the matrix that `cholesky` holds,
    /// of which `n` rows are of `u`.
    ///
    /// # Errors
    /// [`SolveError::Infeasible`] when the rows of `A` depend on each other.
    pub fn prepare(&mut self, cholesky: &mut Cholesky, n: usize) -> Result<(), SolveError> {
        let p = self.rows.len();
        memory::refill(&mut self.response, [0.0], n * p)?;
        for (row, column) in self.rows.iter().zip(self.response.chunks_exact_mut(n.max(1))) {
            for &(i, v) in row {
                column[i as usize][0] += v;
            }
            cholesky.solve(column)?;
        }
        let mut schur = memory::repeated(0.0, p * p)?;
        for (i, row) in self.rows.iter().enumerate() {
            for j in 0..=i {
                let column = &self.response[j * n..(j + 1) * n];
                schur[j * p + i] = row.iter().map(|&(k, v)| v * column[k as usize][0]).sum();
            }
        }
        let dependent = || SolveError::Infeasible {
            reason: "the linear constraints depend on each other; remove those that repeat others".into(),
        };
        self.schur = Some(DenseCholesky::new(&schur, p).ok_or_else(dependent)?);
        Ok(())
    }

    /// Corrects an unconstrained solution `u` of the system so that `A u = b`; returns the multipliers `y` of
    /// `matrix · u + Aᵀ y = right side`.
    pub fn correct(&self, u: &mut [[f64; K]]) -> Vec<[f64; K]> {
        let mut y = self.apply(u);
        for (row, right) in y.iter_mut().zip(&self.right) {
            row.iter_mut().zip(right).for_each(|(r, b)| *r -= b);
        }
        self.subtract_response(u, y)
    }

    /// The same for a change of the solution: so that `A u = 0`.
    pub fn correct_change(&self, u: &mut [[f64; K]]) -> Vec<[f64; K]> {
        self.subtract_response(u, self.apply(u))
    }

    fn subtract_response(&self, u: &mut [[f64; K]], mut y: Vec<[f64; K]>) -> Vec<[f64; K]> {
        let n = u.len();
        if let Some(schur) = &self.schur {
            schur.solve(&mut y);
        }
        for (column, y) in self.response.chunks_exact(n.max(1)).zip(&y) {
            for (x, [r]) in u.iter_mut().zip(column) {
                x.iter_mut().zip(y).for_each(|(x, y)| *x -= r * y);
            }
        }
        y
    }
}
