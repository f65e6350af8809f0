//! Functions on vertices: `(n,)` or `(n,k)` in Python, columns in the core,
//! and back in the shape that came in.

use numpy::ndarray::{Array1, Array2};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use ridgeform_core::linear::Columns;

use crate::arrays::{finite_floats, shape_text};
use crate::errors::argument;

/// Columns, and whether Python sees them as a single array (n,).
pub(crate) struct Values {
    /// The numbers.
    pub columns: Columns,
    /// (n,) instead of (n,1).
    pub single: bool,
}

impl Values {
    /// The same shape in Python with each column replaced.
    pub(crate) fn map(&self, replace: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let k = self.columns.n_columns;
        let data: Vec<f64> = (0..k).flat_map(|c| replace(self.columns.column(c))).collect();
        let columns = Columns { n_rows: data.len() / k, n_columns: k, data };
        Self { columns, single: self.single }
    }
}

/// Read an array (rows,) or (rows,k), k ≥ 1, of finite numbers.
///
/// # Errors
/// `ArgumentError` for another shape, `what` says what there is one row for,
/// and for numbers that are not finite.
pub(crate) fn read(
    name: &'static str,
    object: &Bound<'_, PyAny>,
    rows: usize,
    what: &str,
) -> PyResult<Values> {
    let numbers = finite_floats(name, object)?;
    let (single, k) = match numbers.shape[..] {
        [found] if found == rows => (true, 1),
        [found, k] if found == rows && k > 0 => (false, k),
        _ => {
            let problem = format!(
                "expected one row for each {what}, shape ({rows},) or ({rows}, k), got {}",
                shape_text(&numbers.shape)
            );
            return Err(argument(object.py(), name, problem));
        }
    };
    let data = (0..k).flat_map(|c| numbers.data.iter().skip(c).step_by(k).copied()).collect();
    Ok(Values { columns: Columns { n_rows: rows, n_columns: k, data }, single })
}

/// A fresh C-contiguous `float64` array (rows,) or (rows,k).
pub(crate) fn write<'py>(py: Python<'py>, values: Values) -> Bound<'py, PyAny> {
    let Columns { n_rows, n_columns, data } = values.columns;
    if values.single {
        return Array1::from_vec(data).into_pyarray(py).into_any();
    }
    let rows = Array2::from_shape_fn((n_rows, n_columns), |(i, c)| data[c * n_rows + i]);
    rows.into_pyarray(py).into_any()
}
