//! The keywords that several functions share, from Python's words and numbers to the core's types.

use pyo3::prelude::*;
use ridgeform_core::operators::{Dual, Energy};
use ridgeform_core::solve::{Coupling, Solver};
use ridgeform_core::tools::{EnergyOptions, Levels, Scale, SolveOptions};

use crate::arrays::finite_floats;
use crate::errors::argument;
use crate::mesh::Mesh;
use crate::numbers::at_least_if;

/// The value that goes with the word `given`.
///
/// # Errors
/// `ArgumentError` that lists the accepted words.
pub(crate) fn choice<T: Copy>(
    py: Python<'_>,
    name: &'static str,
    given: &str,
    accepted: &[(&str, T)],
) -> PyResult<T> {
    accepted.iter().find(|(word, _)| *word == given).map(|&(_, value)| value).ok_or_else(|| {
        let words: Vec<_> = accepted.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        argument(py, name, format!("\"{given}\" is not known here; use {}", words.join(" or ")))
    })
}

/// `energy=` and `kind=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub(crate) fn energy(py: Python<'_>, name: &'static str, given: &str) -> PyResult<Energy> {
    choice(py, name, given, &Energy::ALL)
}

/// `dual=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub(crate) fn dual(py: Python<'_>, given: &str) -> PyResult<Dual> {
    let duals = [
        ("barycentric", Dual::Barycentric),
        ("circumcentric", Dual::Circumcentric),
        ("circumcentric_or_barycentric", Dual::CircumcentricOrBarycentric),
    ];
    choice(py, "dual", given, &duals)
}

const SCALES: [(&str, Scale); 4] = [
    ("max_edge", Scale::MaxEdge),
    ("bounding_box", Scale::BoundingBox),
    ("area", Scale::Area),
    ("extent", Scale::Extent),
];

const SOLVERS: [(&str, Solver); 5] = [
    ("auto", Solver::Auto),
    ("fast", Solver::Fast),
    ("clarabel", Solver::Clarabel),
    ("clarabel-qdldl", Solver::ClarabelQdldl),
    ("clarabel-faer", Solver::ClarabelFaer),
];

/// `coupling=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub(crate) fn coupling(py: Python<'_>, given: &str) -> PyResult<Coupling> {
    choice(py, "coupling", given, &[("joint", Coupling::Joint), ("separate", Coupling::Separate)])
}

/// Whether a tool works on coarser meshes first: `coarse_to_fine` of the functions.
pub(crate) fn levels(coarse_to_fine: Option<bool>) -> Levels {
    match coarse_to_fine {
        None => Levels::Auto,
        Some(true) => Levels::Always,
        Some(false) => Levels::Never,
    }
}

/// `scale=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub(crate) fn scale(py: Python<'_>, given: &str) -> PyResult<Scale> {
    choice(py, "scale", given, &SCALES)
}

/// `scale=` of functions that take a length as well; `otherwise` where nothing is given.
///
/// # Errors
/// `ArgumentError` for an unknown word and for a length that is not positive, `TypeError` for another type.
pub(crate) fn scale_or_length(
    py: Python<'_>,
    given: Option<&Bound<'_, PyAny>>,
    otherwise: Scale,
) -> PyResult<Scale> {
    let Some(given) = given else { return Ok(otherwise) };
    if let Ok(word) = given.extract::<String>() {
        return scale(py, &word);
    }
    let Ok(length) = given.extract::<f64>() else {
        let kind = given.get_type().name()?;
        let problem = format!("scale: expected a word or a length, got {kind}");
        return Err(pyo3::exceptions::PyTypeError::new_err(problem));
    };
    if !(length > 0.0 && length.is_finite()) {
        return Err(argument(py, "scale", format!("is {length}; a length must be positive and finite")));
    }
    Ok(Scale::Length(length))
}

/// `solver=`.
///
/// # Errors
/// `ArgumentError` for an unknown word.
pub(crate) fn solver(py: Python<'_>, given: &str) -> PyResult<Solver> {
    choice(py, "solver", given, &SOLVERS)
}

/// `solver=`, `tolerance=`, `max_iterations=`, `memory_limit=` and `threads=`.
///
/// # Errors
/// `ArgumentError` for an unknown solver and for counts below 1; the core judges the tolerance.
pub(crate) fn solve(
    py: Python<'_>,
    solver: &str,
    tolerance: Option<f64>,
    max_iterations: Option<i64>,
    memory_limit: Option<i64>,
    threads: Option<i64>,
) -> PyResult<SolveOptions> {
    Ok(SolveOptions {
        solver: self::solver(py, solver)?,
        tolerance,
        max_iterations: at_least_if(py, "max_iterations", max_iterations, 1)?,
        memory_limit: at_least_if(py, "memory_limit", memory_limit, 1)?,
        threads: at_least_if(py, "threads", threads, 1)?,
    })
}

/// One finite number for each of `length` things, or None.
///
/// # Errors
/// `ArgumentError` for another shape and for numbers that are not finite; `what` names the things.
pub(crate) fn weights(
    name: &'static str,
    given: Option<&Bound<'_, PyAny>>,
    length: usize,
    what: &str,
) -> PyResult<Option<Vec<f64>>> {
    given.map(|object| finite_floats(name, object)?.exactly(object.py(), name, length, what)).transpose()
}

/// `edge_weights=`: three finite numbers for each face, or None; the core judges how many.
///
/// # Errors
/// `ArgumentError` for another shape and for numbers that are not finite.
pub(crate) fn edge_weights(
    py: Python<'_>,
    given: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<Vec<[f64; 3]>>> {
    let name = "edge_weights";
    given.map(|object| finite_floats(name, object)?.rows::<3>(py, name)).transpose()
}

/// The keywords that say which energy, as they came from Python.
#[derive(Clone, Copy)]
pub(crate) struct EnergyWords<'a, 'py> {
    /// `energy=`
    pub energy: &'a str,
    /// `face_weights=`
    pub face_weights: Option<&'a Bound<'py, PyAny>>,
    /// `dual=`
    pub dual: &'a str,
    /// `delaunay=`
    pub delaunay: bool,
}

impl EnergyWords<'_, '_> {
    /// The options on `mesh`.
    ///
    /// # Errors
    /// `ArgumentError` for unknown words and for weights that do not fit.
    pub(crate) fn read(self, py: Python<'_>, mesh: &Mesh) -> PyResult<EnergyOptions> {
        Ok(EnergyOptions {
            kind: energy(py, "energy", self.energy)?,
            face_weights: weights("face_weights", self.face_weights, mesh.n_faces(), "face")?,
            dual: dual(py, self.dual)?,
            delaunay: self.delaunay,
        })
    }
}
