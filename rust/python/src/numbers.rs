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

/// The same where a number is given.
///
/// # Errors
/// As [`at_least`].
pub(crate) fn at_least_if(
    py: Python<'_>,
    name: &'static str,
    given: Option<i64>,
    least: usize,
) -> PyResult<Option<usize>> {
    given.map(|number| at_least(py, name, number, least)).transpose()
}
