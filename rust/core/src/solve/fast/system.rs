//! The linear system of the fast solver: pattern and ordering once,
//! factorization as often as the penalties change.

use crate::block_rows::BlockRows;
use crate::error::SolveError;
use crate::linear::cholesky::{Cholesky, Precision};
use crate::solve::free_operator::FreeOperator;
use crate::solve::normal_matrix::NormalMatrix;
use crate::solve::primal_dual::Stiffness;
use crate::solve::reduced::Reduced;
use crate::{memory, Error, Progress, Result};

/// Rows whose fidelity is below this share of the mean diagonal are raised to it by a proximal term: it makes
/// the matrix definite where the operator alone does not. It weighs the change of `u`, and vanishes with it.
const PROXIMAL: f64 = 1e-10;

/// How much more of it is tried when the factorization still fails, and how often.
const PROXIMAL_GROWTH: f64 = 100.0;
const PROXIMAL_ATTEMPTS: i32 = 4;

/// From so many rows on a factor in single precision pays: a flow takes a tenth less time at 3000 and 5000
/// rows, a seventh at 9000, as long at 1400.
const LARGE: usize = 2000;

/// The most that the mean of the diagonal may be of the least fidelity for a factor in single precision. That
/// is off by a part of 6e-8 of the matrix, which says little of changes that the matrix itself says little
/// of. Measured, iterations are as many as in double precision up to 5e9, to a gap of 1e-6 as well; at 2e20
/// they gain nothing.
const UNLIKE: f64 = 1e8;

/// `2a + HᵀRH` with its factor.
#[derive(Debug)]
pub struct System {
    normal: NormalMatrix,
    cholesky: Cholesky,
    values: Vec<f64>,
    /// The matrix is this times the one that was factored.
    scale: f64,
    /// The change that a solve makes.
    change: Vec<f64>,
}

/// What the blocks of the operator are weighed by in the matrix.
#[derive(Debug, Clone, Copy)]
pub enum Weighing<'a> {
    /// A penalty for each.
    Penalties(&'a [f64]),
    /// A matrix for each.
    Stiffness(&'a [Stiffness]),
}

impl System {
    /// Analyzes the pattern of the free operator.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the factor does not fit into `memory_limit` bytes, [`Error::Cancelled`].
    pub fn new(free: &FreeOperator<'_>, memory_limit: Option<usize>, progress: &Progress) -> Result<Self> {
        let normal = NormalMatrix::stretched(&free.operator, progress)?;
        let pattern = normal.pattern();
        let values = memory::room(pattern.rows.len())?;
        let precision = if pattern.n < LARGE { Precision::Double } else { Precision::Single };
        let cholesky = Cholesky::analyze_in(precision, pattern, memory_limit, progress)?;
        Ok(Self { normal, cholesky, values, scale: 1.0, change: Vec::new() })
    }

    /// Whether `operator` has entries where the one before had them, so that its matrix has this pattern.
    #[must_use]
    pub fn fits(&self, operator: &BlockRows) -> bool {
        self.normal.fits(operator)
    }

    /// Bytes of the factor.
    #[must_use]
    pub fn factor_bytes(&self) -> usize {
        self.cholesky.precision().size() * self.cholesky.factor_len()
    }

    /// Numeric factorizations made so far.
    #[must_use]
    pub fn n_factorizations(&self) -> usize {
        self.cholesky.n_factorizations()
    }

    /// Factors the matrix.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or dependent linear constraints; [`Error::Cancelled`].
    pub fn factorize<const K: usize>(
        &mut self,
        reduced: &mut Reduced<'_, K>,
        weighing: Weighing<'_>,
        progress: &Progress,
    ) -> Result<()> {
        let twice: Vec<f64> = memory::gathered(reduced.fidelity.iter().map(|a| 2.0 * a))?;
        let (h, values) = (&reduced.free.operator, &mut self.values);
        match weighing {
            Weighing::Penalties(r) => self.normal.assemble(h, r, &twice, values),
            Weighing::Stiffness(stiffness) => self.normal.assemble_stiff(h, stiffness, &twice, values),
        }
        let starts = &self.normal.pattern().starts;
        let diagonal: Vec<f64> = memory::gathered(starts[..twice.len()].iter().map(|&s| self.values[s]))?;
        let mean = diagonal.iter().sum::<f64>() / diagonal.len().max(1) as f64;
        let scale = if mean > 0.0 { mean } else { 1.0 };
        let least = twice.iter().copied().fold(f64::INFINITY, f64::min);
        // Steps of the primal-dual method have stiff matrices, and constraints solve for more than a change.
        let is_tame = matches!(weighing, Weighing::Penalties(_)) && mean <= UNLIKE * least;
        if !(is_tame && reduced.constraints.is_none()) {
            self.cholesky.set_precision(Precision::Double)?;
        }
        for attempt in 0..PROXIMAL_ATTEMPTS {
            let least = PROXIMAL * PROXIMAL_GROWTH.powi(attempt) * scale;
            for ((&s, d), a) in starts.iter().zip(&diagonal).zip(&twice) {
                self.values[s] = d + (least - a).max(0.0);
            }
            let mut done = self.cholesky.factorize(&self.values, progress);
            let is_indefinite = matches!(done, Err(Error::Solve(SolveError::Factorization { .. })));
            if is_indefinite && self.cholesky.precision() == Precision::Single {
                self.cholesky.set_precision(Precision::Double)?;
                done = self.cholesky.factorize(&self.values, progress);
            }
            match done {
                Err(Error::Solve(SolveError::Factorization { .. })) if attempt + 1 < PROXIMAL_ATTEMPTS => {}
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        self.scale = 1.0;
        if let Some(constraints) = &mut reduced.constraints {
            constraints.prepare(&mut self.cholesky, twice.len())?;
        }
        Ok(())
    }

    /// Turns the factored matrix into `factor` times itself: all penalties scaled alike,
    /// where there is no fidelity.
    pub fn rescale(&mut self, factor: f64) {
        self.scale *= factor;
    }

    /// Solves `(2a + HᵀRH) u + Aᵀy = 2a·t + Hᵀ(R(z − c) − p)`, `A u = b`, for how far `u` is from that:
    /// `right` is `Hᵀ(R(z − H u − c) − p)` of `u` as it comes. So what a solution is off by is a part of the
    /// change, and vanishes with it. Returns `y`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve<const K: usize>(
        &mut self,
        reduced: &Reduced<'_, K>,
        right: &[[f64; K]],
        u: &mut [[f64; K]],
    ) -> std::result::Result<Vec<[f64; K]>, SolveError> {
        let mut kept = std::mem::take(&mut self.change);
        memory::refill(&mut kept, 0.0, K * u.len())?;
        let (change, _) = kept.as_chunks_mut::<K>();
        for (i, (change, row)) in change.iter_mut().zip(right).enumerate() {
            let (a, target, x) = (2.0 * reduced.fidelity[i], &reduced.target[i], &u[i]);
            *change = std::array::from_fn(|c| (row[c] + a * (target[c] - x[c])) / self.scale);
        }
        self.substitute(reduced.n_columns, change)?;
        for (x, change) in u.iter_mut().zip(&*change) {
            x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
        }
        self.change = kept;
        let mut y = reduced.constraints.as_ref().map_or_else(Vec::new, |constraints| constraints.correct(u));
        y.iter_mut().flatten().for_each(|y| *y *= self.scale);
        Ok(y)
    }

    /// The change of a solution that makes up for `rest` missing on the right side, in place,
    /// and the change of `y`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve_change<const K: usize>(
        &mut self,
        reduced: &Reduced<'_, K>,
        rest: &mut [[f64; K]],
    ) -> std::result::Result<Vec<[f64; K]>, SolveError> {
        rest.iter_mut().flatten().for_each(|x| *x /= self.scale);
        self.substitute(reduced.n_columns, rest)?;
        let mut y = reduced
            .constraints
            .as_ref()
            .map_or_else(Vec::new, |constraints| constraints.correct_change(rest));
        y.iter_mut().flatten().for_each(|y| *y *= self.scale);
        Ok(y)
    }

    fn substitute<const K: usize>(
        &mut self,
        n_columns: usize,
        right: &mut [[f64; K]],
    ) -> std::result::Result<(), SolveError> {
        match n_columns {
            3 => self.cholesky.solve_columns::<3, K>(right),
            _ => self.cholesky.solve_columns::<K, K>(right),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::linear::Columns;
    use crate::operators::{Dual, HessianPattern};
    use crate::shapes::icosphere;
    use crate::solve::{Coupling, Problem};

    /// What remains of each solve's equations after it, the first solve from the target, and the precision of
    /// the factor.
    fn remains(levels: usize, fidelity: f64, weighing: f64) -> (Vec<f64>, Precision) {
        let mesh = icosphere(levels).noisy(0.3 / f64::from(1 << levels), 1).mesh().unwrap();
        let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
        let pattern = HessianPattern::new(connectivity).unwrap();
        let operator = pattern.assemble(connectivity, lengths, Dual::default()).unwrap();
        let n = operator.n_columns;
        let problem = Problem {
            operator: &operator,
            weights: vec![1.0; operator.n_blocks()],
            fidelity: vec![fidelity; n],
            target: Columns::from_points(mesh.positions().unwrap()).unwrap(),
            fixed: vec![false; n],
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let free = FreeOperator::new(&operator, &problem.fixed).unwrap();
        let mut reduced = Reduced::<4>::new(&problem, &free, &[0, 1, 2]).unwrap();
        let r: Vec<f64> = (0..reduced.n_blocks()).map(|b| weighing * (1.0 + 30.0 * (b % 7) as f64)).collect();
        let mut system = System::new(&free, None, &Progress::new()).unwrap();
        system.factorize(&mut reduced, Weighing::Penalties(&r), &Progress::new()).unwrap();
        let mut u = reduced.target.clone();
        let mut sizes = Vec::new();
        for _ in 0..3 {
            let h = reduced.apply(&u).unwrap();
            let right = reduced.apply_transposed(|b| h[b].map(|row| row.map(|x| -r[b] * x))).unwrap();
            let left = |i: usize, c: usize| {
                right[i][c] + 2.0 * reduced.fidelity[i] * (reduced.target[i][c] - u[i][c])
            };
            sizes.push(
                (0..n).flat_map(|i| (0..3).map(move |c| (i, c))).map(|(i, c)| left(i, c).powi(2)).sum(),
            );
            system.solve(&reduced, &right, &mut u).unwrap();
        }
        (sizes.into_iter().map(f64::sqrt).collect(), system.cholesky.precision())
    }

    #[test]
    fn what_a_solve_leaves_the_next_one_makes_up_for() {
        for (fidelity, weighing) in [(1.0, 1.0), (1.0, 1e3), (1e-4, 1e-6), (1e6, 1e6)] {
            let (sizes, precision) = remains(4, fidelity, weighing);
            assert_eq!(precision, Precision::Single, "{fidelity}, {weighing}");
            assert!(sizes[1] < 1e-3 * sizes[0] && sizes[2] < 1e-7 * sizes[0], "{sizes:?}");
        }
    }

    #[test]
    fn small_systems_and_such_as_fidelity_says_little_of_have_all_digits() {
        for (levels, fidelity, weighing) in [(3, 1.0, 1.0), (4, 1e-9, 1.0), (4, 0.0, 1.0)] {
            let (sizes, precision) = remains(levels, fidelity, weighing);
            assert_eq!(precision, Precision::Double, "{levels}, {fidelity}, {weighing}");
            assert!(fidelity == 0.0 || sizes[1] < 1e-6 * sizes[0], "{sizes:?}");
        }
    }
}
