//! `Solution`: what `denoise` and `interpolate` return.

use pyo3::prelude::*;
use ridgeform_core::solve;

use crate::columns::{self, Values};

/// A minimizer, how good it is and what it took.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Solution {
    /// The minimizer, float64, in the shape of the values that were given: (n,) or (n,k).
    values: Py<PyAny>,
    /// The objective at `values`.
    objective: f64,
    /// The certified relative duality gap: no feasible point has an objective lower by more than this share.
    /// With a quadratic energy, what another step of the linear solver would lower it by.
    gap: f64,
    /// Inner iterations, all rounds and columns together; of several connected pieces of the mesh those of
    /// the piece that took most.
    iterations: usize,
    /// Numeric factorizations, likewise.
    factorisations: usize,
    /// "solved" (the tolerance was reached), "inaccurate" (it was not: the best point is returned) or
    /// "stopped".
    status: &'static str,
    /// The solver that was used; "cholesky" with a quadratic energy.
    solver: &'static str,
}

impl Solution {
    /// Hand `solution` to Python; `single` for values of shape (n,).
    pub fn new(py: Python<'_>, solution: solve::Solution, single: bool) -> Self {
        let values = columns::write(py, Values { columns: solution.values, single }).unbind();
        Self {
            values,
            objective: solution.objective,
            gap: solution.gap,
            iterations: solution.iterations,
            factorisations: solution.factorisations,
            status: solution.status.name(),
            solver: solver_name(solution.solver),
        }
    }
}

#[pymethods]
impl Solution {
    fn __repr__(&self) -> String {
        format!(
            "<ridgeform.Solution: {}, objective {:.6e}, gap {:.1e}, {} iterations of {}>",
            self.status, self.objective, self.gap, self.iterations, self.solver
        )
    }
}

fn solver_name(solver: solve::Solver) -> &'static str {
    match solver {
        solve::Solver::Auto => "auto",
        solve::Solver::Fast => "fast",
        solve::Solver::Clarabel => "clarabel",
        solve::Solver::ClarabelQdldl => "clarabel-qdldl",
        solve::Solver::ClarabelFaer => "clarabel-faer",
        solve::Solver::Cholesky => "cholesky",
    }
}
