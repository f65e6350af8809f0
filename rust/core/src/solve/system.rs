//! The linear system of the fast solver: pattern and ordering once, factorisation as often as the penalties change.

use crate::error::SolveError;
use crate::solve::cholesky::Cholesky;
use crate::solve::normal_matrix::NormalMatrix;
use crate::solve::reduced::{FreeOperator, Reduced};

/// Rows without fidelity get this share of the mean diagonal as a proximal term: it makes the matrix definite where the
/// operator alone does not, and vanishes from the iteration as it converges.
const PROXIMAL: f64 = 1e-10;

/// `2a + HᵀRH` with its factor.
#[derive(Debug)]
pub struct System {
    normal: NormalMatrix,
    cholesky: Cholesky,
    values: Vec<f64>,
    proximal: Vec<f64>,
    buffer: Vec<f64>,
}

impl System {
    /// Analyses the pattern of the free operator for up to `n_right` right sides.
    ///
    /// # Errors
    /// [`SolveError::Factorisation`] when memory runs out.
    pub fn new(free: &FreeOperator, n_right: usize) -> Result<Self, SolveError> {
        let normal = NormalMatrix::new(&free.operator);
        let cholesky = Cholesky::analyse(normal.pattern().clone(), n_right)?;
        Ok(Self { normal, cholesky, values: Vec::new(), proximal: Vec::new(), buffer: Vec::new() })
    }

    /// Numeric factorisations made so far.
    #[must_use]
    pub fn n_factorisations(&self) -> usize {
        self.cholesky.n_factorisations()
    }

    /// Factors the matrix for the penalties `r`.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or dependent linear constraints.
    pub fn factorise<const K: usize>(&mut self, reduced: &mut Reduced<'_, K>, r: &[f64]) -> Result<(), SolveError> {
        let twice: Vec<f64> = reduced.fidelity.iter().map(|a| 2.0 * a).collect();
        self.normal.assemble(&reduced.free.operator, r, &twice, &mut self.values);
        let starts = &self.normal.pattern().starts;
        let n = twice.len();
        let mean = starts[..n].iter().map(|&s| self.values[s]).sum::<f64>() / n.max(1) as f64;
        let small = if mean > 0.0 { PROXIMAL * mean } else { 1.0 };
        self.proximal = twice.iter().map(|&a| if a > 0.0 { 0.0 } else { small }).collect();
        for (&s, p) in starts.iter().zip(&self.proximal) {
            self.values[s] += p;
        }
        self.cholesky.factorise(&self.values)?;
        if let Some(constraints) = &mut reduced.constraints {
            constraints.prepare(&mut self.cholesky)?;
        }
        Ok(())
    }

    /// Solves `(2a + HᵀRH) u + Aᵀy = 2a·t + right`, `A u = b`; `u` holds the last iterate before and the solution after.
    /// Returns `y`.
    pub fn solve<const K: usize>(
        &mut self,
        reduced: &Reduced<'_, K>,
        right: &[[f64; K]],
        u: &mut [[f64; K]],
    ) -> Vec<[f64; K]> {
        let n = u.len();
        self.buffer.resize(n * K, 0.0);
        for (i, (row, x)) in right.iter().zip(u.iter()).enumerate() {
            let (a, p) = (2.0 * reduced.fidelity[i], self.proximal[i]);
            for c in 0..K {
                self.buffer[c * n + i] = row[c] + a * reduced.target[i][c] + p * x[c];
            }
        }
        self.cholesky.solve(&mut self.buffer, K);
        for (i, x) in u.iter_mut().enumerate() {
            *x = std::array::from_fn(|c| self.buffer[c * n + i]);
        }
        reduced.constraints.as_ref().map_or_else(Vec::new, |constraints| constraints.correct(u))
    }
}
