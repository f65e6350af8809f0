//! The conic program (21) and its solvers: matrices only, never meshes.
//!
//! [`Problem`] says what is asked. [`Session`] answers it by alternating directions with a reused
//! factorization, [`solve`] with any solver by name. Every [`Solution`] carries a relative duality gap that
//! was computed from the point that is returned.

mod apart;
pub mod certificate;
pub mod clarabel;
pub mod cones;
mod constraints;
pub mod eigen;
pub mod fast;
mod free_operator;
pub mod normal_matrix;
mod normal_pattern;
mod outcome;
pub(crate) mod pieces;
mod primal_dual;
mod problem;
pub mod quadratic;
mod reduced;
mod session;
mod single;
mod stretching;

pub use free_operator::FreeOperator;
pub use problem::{Coupling, Problem, Settings, Solution, Solver, Status};
pub use reduced::Reduced;
pub use session::Session;
pub use single::MAX_JOINT_COLUMNS;

use crate::{Error, Progress, Result};
use single::Method;

/// Solves `problem` with the solver named, from a cold start.
///
/// # Errors
/// See [`Session::solve`].
pub fn solve(
    problem: &Problem<'_>,
    solver: Solver,
    settings: &Settings,
    progress: &Progress,
) -> Result<Solution> {
    let method = match solver {
        Solver::Auto | Solver::Fast => Method::Fast,
        Solver::ClarabelQdldl | Solver::ClarabelFaer => Method::Clarabel(solver),
        Solver::Clarabel if problem.n_rows() < clarabel::QDLDL_BELOW => {
            Method::Clarabel(Solver::ClarabelQdldl)
        }
        Solver::Clarabel => Method::Clarabel(Solver::ClarabelFaer),
        Solver::Cholesky => {
            return Err(Error::argument("solver", "Cholesky solves quadratic energies only; use auto"))
        }
    };
    Session::new().run(problem, method, settings, progress)
}
