//! The one mapping from the core's errors to the exceptions of `ridgeform.errors`.

use pyo3::prelude::*;
use pyo3::types::PyType;
use ridgeform_core::error::SolveError;
use ridgeform_core::Error;

/// A `MeshError`, `ArgumentError`, `SolveError`, `MemoryLimitError`,
/// `Cancelled` or `RidgeformError` that says what `error` says.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error {
        Error::Mesh(_) => "MeshError",
        Error::Argument { .. } => "ArgumentError",
        Error::Memory { .. } | Error::Solve(SolveError::Memory { .. }) => "MemoryLimitError",
        Error::Solve(_) => "SolveError",
        Error::Cancelled => "Cancelled",
        _ => "RidgeformError",
    };
    raise(py, class, error.to_string())
}

/// An `ArgumentError` for the argument `name`.
pub(crate) fn argument(py: Python<'_>, name: &'static str, problem: impl Into<String>) -> PyErr {
    exception(py, &Error::argument(name, problem))
}

/// A `RidgeformError` for a panic in the core, with the panic's message.
pub(crate) fn internal(py: Python<'_>, message: &str) -> PyErr {
    let sentence =
        format!("an internal check failed: {message}; please report this with the mesh that caused it");
    raise(py, "RidgeformError", sentence)
}

/// The exception `class` of `ridgeform.errors`, or the error met while looking it up.
fn raise(py: Python<'_>, class: &str, message: String) -> PyErr {
    let found = py
        .import("ridgeform.errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| Ok(class.cast_into::<PyType>()?));
    match found {
        Ok(class) => PyErr::from_type(class, message),
        Err(error) => error,
    }
}
