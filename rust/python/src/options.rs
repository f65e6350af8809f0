//! The keywords that several functions share, from Python's words and numbers to the core's types.

use pyo3::prelude::*;
use ridgeform_core::operators::Dual;
use ridgeform_core::solve::{Coupling, Solver};
use ridgeform_core::tools::SolveOptions;

use crate::arrays::finite_floats;
use crate::errors::argument;

/// The value that goes with the word `given`.
///
/// # Errors
/// `ArgumentError` that lists the accepted words.
pub fn choice<T: Copy>(py: Python<'_>, name: &'static str, given: &str, accepted: &[(&str, T)]) -> PyResult<T> {
    accepted.iter().find(|(word, _)| *word == given).map(|&(_, value)| value).ok_or_else(|| {
        let words: Vec<_> = accepted.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        argument(py, name, format!("\"{given}\" is not known here; use {}", words.join(" or ")))
    })
}

/// `energy=` and `kind=`: the L1 Hessian energy is the one that exists.
///
/// # Errors
/// `ArgumentError` for any other.
pub fn only_l1_hessian(py: Python<'_>, name: &'static str, given: &str) -> PyResult<()> {
    choice(py, name, given, &[("l1_hessian", ())])
}

/// `dual=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub fn dual(py: Python<'_>, given: &str) -> PyResult<Dual> {
    choice(py, "dual", given, &[("barycentric", Dual::Barycentric), ("circumcentric", Dual::Circumcentric)])
}

/// `coupling=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub fn coupling(py: Python<'_>, given: &str) -> PyResult<Coupling> {
    choice(py, "coupling", given, &[("joint", Coupling::Joint), ("separate", Coupling::Separate)])
}

/// `solver=`, `tolerance=`, `max_iterations=` and `threads=`.
///
/// # Errors
/// `ArgumentError` for an unknown solver and for counts below 1; the core judges the tolerance.
pub fn solve(
    py: Python<'_>,
    solver: &str,
    tolerance: Option<f64>,
    max_iterations: Option<i64>,
    threads: Option<i64>,
) -> PyResult<SolveOptions> {
    let solvers = [
        ("auto", Solver::Auto),
        ("fast", Solver::Fast),
        ("clarabel", Solver::Clarabel),
        ("clarabel-qdldl", Solver::ClarabelQdldl),
        ("clarabel-faer", Solver::ClarabelFaer),
    ];
    Ok(SolveOptions {
        solver: choice(py, "solver", solver, &solvers)?,
        tolerance,
        max_iterations: max_iterations.map(|count| at_least(py, "max_iterations", count, 1)).transpose()?,
        threads: threads.map(|count| at_least(py, "threads", count, 1)).transpose()?,
    })
}

/// A whole number that must not be less than `least`.
///
/// # Errors
/// `ArgumentError` below that.
pub fn at_least(py: Python<'_>, name: &'static str, given: i64, least: usize) -> PyResult<usize> {
    let refuse = || argument(py, name, format!("got {given}; pass a whole number of at least {least}"));
    usize::try_from(given).ok().filter(|&count| count >= least).ok_or_else(refuse)
}

/// One finite number for each of `length` things, or None.
///
/// # Errors
/// `ArgumentError` for another shape and for numbers that are not finite; `what` names the things.
pub fn weights(
    name: &'static str,
    given: Option<&Bound<'_, PyAny>>,
    length: usize,
    what: &str,
) -> PyResult<Option<Vec<f64>>> {
    given.map(|object| finite_floats(name, object)?.exactly(object.py(), name, length, what)).transpose()
}
