//! Numbers that Python hands over.

use pyo3::prelude::*;

use crate::errors::argument;

/// A whole number that must not be less than `least`.
///
/// # Errors
/// `ArgumentError` below that.
pub(crate) fn at_least(py: Python<'_>, name: &'static str, given: i64, least: usize) -> PyResult<usize> {
    let refuse = || argument(py, name, format!("got {given}; pass a whole number of at least {least}"));
    usize::try_from(given).ok().filter(|&count| count >= least).ok_or_else(refuse)
}
