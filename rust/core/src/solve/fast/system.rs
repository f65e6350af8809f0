//! The linear system of the fast solver: pattern and ordering once,
//! factorization as often as the penalties change.

use crate::block_rows::BlockRows;
use crate::error::SolveError;
use crate::linear::cholesky::Cholesky;
use crate::memory;
use crate::solve::free_operator::FreeOperator;
use crate::solve::normal_matrix::NormalMatrix;
use crate::solve::primal_dual::Stiffness;
use crate::solve::reduced::Reduced;

/// Rows whose fidelity is below this share of the mean diagonal are raised to it by a proximal term: it makes
/// the matrix definite where the operator alone does not, and vanishes from the iteration as it converges.
const PROXIMAL: f64 = 1e-10;

/// How much more of it is tried when the factorization still fails, and how often.
const PROXIMAL_GROWTH: f64 = 100.0;
const PROXIMAL_ATTEMPTS: i32 = 4;

/// `2a + HᵀRH` with its factor.
#[derive(Debug)]
pub struct System {
    normal: NormalMatrix,
    cholesky: Cholesky,
    values: Vec<f64>,
    proximal: Vec<f64>,
    /// The matrix is this times the one that was factored.
    scale: f64,
    /// Whether every solution is refined once.
    refined: bool,
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
    /// [`SolveError::Memory`] when the factor does not fit into `memory_limit` bytes.
    pub fn new(free: &FreeOperator, memory_limit: Option<usize>) -> Result<Self, SolveError> {
        let normal = NormalMatrix::stretched(&free.operator)?;
        let pattern = normal.pattern().copied()?;
        let values = memory::room(pattern.rows.len())?;
        let cholesky = Cholesky::analyze(pattern, memory_limit)?;
        Ok(Self { normal, cholesky, values, proximal: Vec::new(), scale: 1.0, refined: false })
    }

    /// Whether the matrix of `operator`, of the same pattern as the one before, has this pattern as well.
    #[must_use]
    pub fn fits(&self, operator: &BlockRows) -> bool {
        self.normal.fits(operator)
    }

    /// Bytes of the factor.
    #[must_use]
    pub fn factor_bytes(&self) -> usize {
        size_of::<f64>() * self.cholesky.factor_len()
    }

    /// Numeric factorizations made so far.
    #[must_use]
    pub fn n_factorizations(&self) -> usize {
        self.cholesky.n_factorizations()
    }

    /// Factors the matrix.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or dependent linear constraints.
    pub fn factorize<const K: usize>(
        &mut self,
        reduced: &mut Reduced<'_, K>,
        weighing: Weighing<'_>,
    ) -> Result<(), SolveError> {
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
        for attempt in 0..PROXIMAL_ATTEMPTS {
            let least = PROXIMAL * PROXIMAL_GROWTH.powi(attempt) * scale;
            self.proximal = memory::gathered(twice.iter().map(|a| (least - a).max(0.0)))?;
            for ((&s, d), p) in starts.iter().zip(&diagonal).zip(&self.proximal) {
                self.values[s] = d + p;
            }
            match self.cholesky.factorize(&self.values) {
                Err(SolveError::Factorization { .. }) if attempt + 1 < PROXIMAL_ATTEMPTS => {}
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

    /// From now on takes the residual of every solution and solves for it: in matrices with very unlike
    /// weights a solution is far less exact than its digits.
    pub fn refine(&mut self) {
        self.refined = true;
    }

    /// `right − matrix · u` of the matrix that was factored.
    fn residual<const K: usize>(
        &self,
        right: &[[f64; K]],
        u: &[[f64; K]],
    ) -> Result<Vec<[f64; K]>, SolveError> {
        let mut out = memory::twin(right)?;
        let pattern = self.normal.pattern();
        for j in 0..pattern.n {
            let column = pattern.starts[j]..pattern.starts[j + 1];
            for (&i, value) in pattern.rows[column.clone()].iter().zip(&self.values[column]) {
                for c in 0..K {
                    out[i][c] -= value * u[j][c];
                    if i != j {
                        out[j][c] -= value * u[i][c];
                    }
                }
            }
        }
        Ok(out)
    }

    /// Turns the factored matrix into `factor` times itself: all penalties scaled alike,
    /// where there is no fidelity.
    pub fn rescale(&mut self, factor: f64) {
        self.scale *= factor;
        self.proximal.iter_mut().for_each(|p| *p *= factor);
    }

    /// The proximal weight of each row: [`System::solve`] adds `proximal · (u − u before)` to the left side.
    #[must_use]
    pub fn proximal(&self) -> &[f64] {
        &self.proximal
    }

    /// Solves `(2a + HᵀRH) u + Aᵀy = 2a·t + right`, `A u = b`; `u` holds the last iterate before and the
    /// solution after. Returns `y`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve<const K: usize>(
        &mut self,
        reduced: &Reduced<'_, K>,
        right: &[[f64; K]],
        u: &mut [[f64; K]],
    ) -> Result<Vec<[f64; K]>, SolveError> {
        for (i, (x, row)) in u.iter_mut().zip(right).enumerate() {
            let (a, p) = (2.0 * reduced.fidelity[i], self.proximal[i]);
            let target = &reduced.target[i];
            *x = std::array::from_fn(|c| (row[c] + a * target[c] + p * x[c]) / self.scale);
        }
        if self.refined {
            let mut right = memory::room(self.normal.pattern().n)?;
            right.extend_from_slice(u);
            right.resize(self.normal.pattern().n, [0.0; K]);
            let mut solution = memory::twin(&right)?;
            self.substitute(reduced.n_columns, &mut solution)?;
            let mut rest = self.residual(&right, &solution)?;
            self.substitute(reduced.n_columns, &mut rest)?;
            for ((u, x), rest) in u.iter_mut().zip(&solution).zip(&rest) {
                *u = std::array::from_fn(|c| x[c] + rest[c]);
            }
        } else {
            self.substitute(reduced.n_columns, u)?;
        }
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
    ) -> Result<Vec<[f64; K]>, SolveError> {
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
    ) -> Result<(), SolveError> {
        match n_columns {
            3 => self.cholesky.solve_columns::<3, K>(right),
            _ => self.cholesky.solve_columns::<K, K>(right),
        }
    }
}
