//! Divisions of the faces that are nested with the one asked for: what `Parts` and `Segmentation` share.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use ridgeform_core::tools::Hierarchy;

use crate::errors;
use crate::numbers::at_least;

/// The division into the number that the argument `name` gives, or the nearest that there is, (m,) int32.
///
/// # Errors
/// `ArgumentError` for numbers below 1.
pub(crate) fn labels_at<'py>(
    py: Python<'py>,
    hierarchy: &Hierarchy,
    name: &'static str,
    given: i64,
) -> PyResult<Bound<'py, PyArray1<i32>>> {
    let labels = hierarchy.labels_at(at_least(py, name, given, 1)?);
    Ok(labels.map_err(|error| errors::exception(py, &error))?.into_pyarray(py))
}

/// What `repr` says: how many there are of what, and how few and many there could be.
pub(crate) fn text(class: &str, count: usize, things: &str, hierarchy: &Hierarchy, status: &str) -> String {
    let [most, fewest] = hierarchy.range();
    format!("<ridgeform.{class}: {count} {things} of {fewest} to {most}, {status}>")
}
