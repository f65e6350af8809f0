//! The conic program (21) of Rowe et al. 2024, as matrices: what is asked, how exactly, and what came out.

use sprs::CsMat;

use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::{Error, Result};

/// How the norms of several columns add up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coupling {
    /// One norm per block over all columns: invariant under rotations of the columns.
    #[default]
    Joint,
    /// One norm per block and column, as in the flow of the paper: each column is a problem of its own.
    Separate,
}

/// Which solver to use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Solver {
    /// The fast one.
    #[default]
    Auto,
    /// Alternating directions with a penalty per block and a reused factorization.
    Fast,
    /// Clarabel's interior-point method; `qdldl` below about 20 000 columns of the operator, `faer` above.
    Clarabel,
    /// Clarabel with the factorization `qdldl`.
    ClarabelQdldl,
    /// Clarabel with the factorization of `faer`.
    ClarabelFaer,
    /// One sparse Cholesky factorization: what quadratic energies are solved with, and only they.
    Cholesky,
}

impl Solver {
    /// Whether it is Clarabel, with whichever factorization.
    #[must_use]
    pub fn is_clarabel(self) -> bool {
        matches!(self, Self::Clarabel | Self::ClarabelQdldl | Self::ClarabelFaer)
    }
}

/// How a solution was left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The tolerance was reached.
    Solved,
    /// The iterations ran out first; the best point found is returned with its true gap.
    Inaccurate,
    /// The caller asked to finish early; the best point so far is returned with its true gap.
    Stopped,
}

impl Status {
    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Inaccurate => "inaccurate",
            Self::Stopped => "stopped",
        }
    }

    /// The less good of two.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        match (self, other) {
            (Self::Stopped, _) | (_, Self::Stopped) => Self::Stopped,
            (Self::Inaccurate, _) | (_, Self::Inaccurate) => Self::Inaccurate,
            _ => Self::Solved,
        }
    }
}

/// `min_u Σ_b w_b ‖(H u)_b‖ + Σ_i a_i ‖u_i − t_i‖²` subject to fixed rows of `u` and `A u = b`.
///
/// Rowe et al. 2024, eq. (21), in matrices eq. (39), with `a = α·mass`, weights per block,
/// and one or several columns.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// The operator `H`, a block a cone.
    pub operator: &'a BlockRows,
    /// `w`, one per block, at least zero.
    pub weights: Vec<f64>,
    /// `a`, one per row of `u`, at least zero; zero everywhere for interpolation.
    pub fidelity: Vec<f64>,
    /// `t`; also the values of the fixed rows, and where the iteration starts if there is no fidelity.
    pub target: Columns,
    /// Which rows of `u` keep the values of `target`.
    pub fixed: Vec<bool>,
    /// `A` (p × n) and `b` (p × k).
    pub linear_constraints: Option<(CsMat<f64>, Columns)>,
    /// Joint or separate norms.
    pub coupling: Coupling,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The relative duality gap to certify; `None` stops on residuals (true error about 1e-4).
    pub tolerance: Option<f64>,
    /// At most this many iterations; the solver's own bound where `None`.
    pub max_iterations: Option<usize>,
    /// The most bytes that the factor of the linear system may take; any that the system gives where `None`.
    pub memory_limit: Option<usize>,
    /// Whether to publish iterations as progress; a tool that publishes its own steps says no.
    pub announce: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: Some(1e-3), max_iterations: None, memory_limit: None, announce: true }
    }
}

/// A point, how good it is, and what it cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The minimizer found, fixed rows included.
    pub values: Columns,
    /// The objective there.
    pub objective: f64,
    /// A lower bound on the objective of every feasible point.
    pub dual_objective: f64,
    /// What counts as an objective of zero: a millionth of the objective at the target,
    /// or what rounding alone makes of it.
    pub floor: f64,
    /// `(objective − dual_objective) / scale`, computed from the point that is returned; `scale` is the
    /// objective, or where that is larger, `floor`, so that the gap has no unit and an affine solution does
    /// not divide by zero. Not below 0: where rounding lifts the bound above the objective, the two are equal
    /// as far as can be told.
    pub gap: f64,
    /// Iterations, summed over separate columns; of several connected pieces those of the one with most.
    pub iterations: usize,
    /// Numeric factorizations, likewise.
    pub factorisations: usize,
    /// How the solver stopped.
    pub status: Status,
    /// Which solver it was.
    pub solver: Solver,
}

impl Problem<'_> {
    /// Number of rows of `u`.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.operator.n_columns
    }

    /// Refuses shapes that do not fit, weights or fidelities below zero, and entries that are not finite.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the culprit.
    pub fn check(&self) -> Result<()> {
        check_nonnegative("face_weights", &self.weights, self.operator.n_blocks())?;
        self.check_shapes()
    }

    /// [`Problem::check`], but for the sign of the weights, which quadratic problems leave open.
    pub(super) fn check_shapes(&self) -> Result<()> {
        let (n, m) = (self.n_rows(), self.operator.n_blocks());
        if self.weights.len() != m {
            return Err(Error::argument(
                "face_weights",
                format!("has {} entries, expected {m}", self.weights.len()),
            ));
        }
        self.target.check("values", n)?;
        check_nonnegative("fidelity", &self.fidelity, n)?;
        if self.fixed.len() != n {
            return Err(Error::argument("fixed", format!("has {} entries, expected {n}", self.fixed.len())));
        }
        if let Some((matrix, right)) = &self.linear_constraints {
            if matrix.cols() != n {
                return Err(Error::argument(
                    "linear_constraints",
                    format!("the matrix has {} columns, expected {n}", matrix.cols()),
                ));
            }
            right.check("linear_constraints", matrix.rows())?;
            if right.n_columns != self.target.n_columns {
                return Err(Error::argument(
                    "linear_constraints",
                    format!(
                        "the right side has {} columns, expected {}",
                        right.n_columns, self.target.n_columns
                    ),
                ));
            }
        }
        Ok(())
    }

    /// The scale that makes a gap relative: the objective, or the floor below which it counts as zero.
    #[must_use]
    pub fn gap_scale(objective: f64, floor: f64) -> f64 {
        objective.abs().max(floor).max(f64::MIN_POSITIVE)
    }

    /// The objective at `values`, from the whole operator: what a solution claims, computed from what it
    /// hands out. The energy is ½ Σ w ‖(H u)_b‖² where `quadratic`.
    #[must_use]
    pub fn objective(&self, values: &Columns, quadratic: bool) -> f64 {
        let block = |(b, weight): (usize, &f64)| {
            let squares = (0..values.n_columns).map(|c| {
                let row = self.operator.block_times(b, values.column(c));
                row.iter().map(|x| x * x).sum::<f64>()
            });
            weight
                * match self.coupling {
                    _ if quadratic => 0.5 * squares.sum::<f64>(),
                    Coupling::Joint => squares.sum::<f64>().sqrt(),
                    Coupling::Separate => squares.map(f64::sqrt).sum(),
                }
        };
        let energy: f64 = self.weights.iter().enumerate().map(block).sum();
        let distance = |c: usize| {
            let pairs = values.column(c).iter().zip(self.target.column(c)).zip(&self.fidelity);
            pairs.filter(|(_, a)| **a > 0.0).map(|((x, t), a)| a * (x - t) * (x - t)).sum::<f64>()
        };
        energy + (0..values.n_columns).map(distance).sum::<f64>()
    }
}

fn check_nonnegative(name: &'static str, values: &[f64], n: usize) -> Result<()> {
    if values.len() != n {
        return Err(Error::argument(name, format!("has {} entries, expected {n}", values.len())));
    }
    match values.iter().position(|x| !(x.is_finite() && *x >= 0.0)) {
        Some(i) => Err(Error::argument(
            name,
            format!("entry {i} is {}; it must be finite and at least 0", values[i]),
        )),
        None => Ok(()),
    }
}
