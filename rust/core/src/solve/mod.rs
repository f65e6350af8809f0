//! The conic program (21) and its solvers: matrices only, never meshes.
//!
//! [`Problem`] says what is asked. [`FastSolver`] answers it by alternating directions with a reused factorisation,
//! [`solve`] with any solver by name. Every [`Solution`] carries a relative duality gap that was computed from the point
//! that is returned.

pub mod bounded;
pub mod certificate;
pub mod cholesky;
mod columns;
pub mod cones;
pub mod conic;
mod conjugate_gradients;
pub mod dissection;
pub mod eigen;
pub mod fast;
mod fast_solver;
mod linear_constraints;
mod multifrontal;
pub mod normal_matrix;
pub mod penalty;
mod primal_dual;
mod problem;
pub mod quadratic;
mod reduced;
mod subtrees;
mod sweep;
pub mod system;
mod triangular;

pub use columns::Columns;
pub use fast_solver::{FastSolver, MAX_JOINT_COLUMNS};
pub use problem::{Coupling, Problem, Settings, Solution, Solver, Status};
pub use reduced::{FreeOperator, Reduced};
pub use sweep::Sweep;

use crate::{Error, Progress, Result};
use fast_solver::Method;

/// Solves `problem` with the solver named, from a cold start.
///
/// # Errors
/// See [`FastSolver::solve`].
pub fn solve(problem: &Problem<'_>, solver: Solver, settings: &Settings, progress: &Progress) -> Result<Solution> {
    let method = match solver {
        Solver::Auto | Solver::Fast => Method::Fast,
        Solver::ClarabelQdldl | Solver::ClarabelFaer => Method::Clarabel(solver),
        Solver::Clarabel if problem.n_rows() < conic::QDLDL_BELOW => Method::Clarabel(Solver::ClarabelQdldl),
        Solver::Clarabel => Method::Clarabel(Solver::ClarabelFaer),
        Solver::Cholesky => return Err(Error::argument("solver", "Cholesky solves quadratic energies only; use auto")),
    };
    FastSolver::new().run(problem, method, settings, progress)
}
