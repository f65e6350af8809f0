//! Divisions of the faces that are nested with the one asked for: what `Parts` and `Segmentation` share.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use ridgeform_core::tools::Hierarchy;

use crate::errors;
use crate::numbers::at_least;

/// The methods of a class with a `hierarchy` of divisions into so many `$things`, `$count` of which it has;
/// `$own` are those that no other class has.
macro_rules! nested_divisions {
    ($class:ident, $count:ident, $things:literal; $($own:tt)*) => {
        #[pymethods]
        impl $class {
            #[doc = concat!("The division into `", stringify!($count), "` ", $things, ", or the nearest")]
            /// number that `range` allows, from the hierarchy: at once, and nested.
            ///
            /// Parameters
            /// ----------
            #[doc = concat!(stringify!($count), " : number of ", $things, ", ≥ 1")]
            ///
            /// Returns
            /// -------
            /// (m,) int32, from 0 in the order of their first faces; -1 for faces that took no part
            ///
            /// Raises
            /// ------
            /// ArgumentError
            fn labels_at<'py>(&self, py: Python<'py>, $count: i64) -> PyResult<Bound<'py, PyArray1<i32>>> {
                $crate::nested::labels_at(py, &self.hierarchy, stringify!($count), $count)
            }

            #[doc = concat!("Fewest and most ", $things, " that `labels_at` has.")]
            #[getter]
            fn range(&self) -> (usize, usize) {
                let [most, fewest] = self.hierarchy.range();
                (fewest, most)
            }

            fn __repr__(&self) -> String {
                let class = stringify!($class);
                $crate::nested::text(class, self.$count, $things, &self.hierarchy, self.status)
            }

            $($own)*
        }
    };
}
pub(crate) use nested_divisions;

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
