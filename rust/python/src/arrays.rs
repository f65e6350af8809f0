//! The one doorway for arrays: any numeric dtype and memory order in,
//! fresh C-contiguous `float64` and `int32` out.

use numpy::ndarray::Array2;
use numpy::{
    dtype, Element, IntoPyArray, PyArray1, PyArray2, PyArrayDescr, PyArrayDescrMethods, PyReadonlyArray2,
    PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use ridgeform_core::memory;

use crate::errors::{argument, exception};

/// The name of arrays that go out, in errors.
const RESULT: &str = "the result";

/// Numbers in C order, and the shape that they came in.
pub(crate) struct Numbers<T> {
    /// The entries, last axis fastest.
    pub data: Vec<T>,
    /// The length of every axis.
    pub shape: Vec<usize>,
}

impl<T: Copy> Numbers<T> {
    /// The entries as rows of `N`, for an array of shape (k, N).
    ///
    /// # Errors
    /// `ArgumentError` for another shape.
    pub(crate) fn rows<const N: usize>(self, py: Python<'_>, name: &'static str) -> PyResult<Vec<[T; N]>> {
        // An empty list has shape (0,): it is an array of no rows.
        if self.shape.len() != 2 && !self.data.is_empty() || self.shape.len() == 2 && self.shape[1] != N {
            return Err(argument(
                py,
                name,
                format!("expected an array of shape (k, {N}), got {}", shape_text(&self.shape)),
            ));
        }
        copied(py, name, self.data.as_chunks().0)
    }

    /// The entries, for an array of shape (length,).
    ///
    /// # Errors
    /// `ArgumentError` for another shape; `what` says what there is one entry for.
    pub(crate) fn exactly(
        self,
        py: Python<'_>,
        name: &'static str,
        length: usize,
        what: &str,
    ) -> PyResult<Vec<T>> {
        if self.shape != [length] {
            let problem = format!(
                "expected one entry for each {what}, shape ({length},), got {}",
                shape_text(&self.shape)
            );
            return Err(argument(py, name, problem));
        }
        Ok(self.data)
    }
}

/// The array itself if it is one of shape (k, N) in C order with entries of type `T`,
/// to be read without a copy.
pub(crate) fn plain_rows<'py, T: Element, const N: usize>(
    object: &Bound<'py, PyAny>,
) -> Option<PyReadonlyArray2<'py, T>> {
    let array: PyReadonlyArray2<'py, T> = object.extract().ok()?;
    (array.shape()[1] == N && array.is_c_contiguous() && array.as_slice().is_ok()).then_some(array)
}

/// Read floating-point numbers.
///
/// # Errors
/// `ArgumentError` for anything that is not an array of real numbers.
pub(crate) fn floats(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<Numbers<f64>> {
    let array = numeric_array(name, object)?;
    convert(name, &array)
}

/// Read floating-point numbers that must all be finite.
///
/// # Errors
/// As [`floats`]; `ArgumentError` that names the first row with a NaN or an infinity.
pub(crate) fn finite_floats(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<Numbers<f64>> {
    let numbers = floats(name, object)?;
    if let Some(i) = numbers.data.iter().position(|x| !x.is_finite()) {
        let row = i / numbers.shape.iter().skip(1).product::<usize>().max(1);
        let problem = format!("row {row} holds {}; every number must be finite", numbers.data[i]);
        return Err(argument(object.py(), name, problem));
    }
    Ok(numbers)
}

/// Read whole numbers; floating-point arrays are accepted if they hold nothing else.
///
/// # Errors
/// `ArgumentError` for anything that is not an array of whole numbers.
pub(crate) fn integers(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<Numbers<i64>> {
    let py = object.py();
    let array = numeric_array(name, object)?;
    match array.dtype().kind() {
        b'b' => Err(argument(py, name, "expected whole numbers, got booleans")),
        b'f' => {
            let numbers: Numbers<f64> = convert(name, &array)?;
            // Beyond 2^53 a float64 no longer tells neighboring whole numbers apart.
            let whole = |x: &f64| x.fract() == 0.0 && x.abs() <= 9_007_199_254_740_992.0;
            if let Some(x) = numbers.data.iter().find(|x| !whole(x)) {
                return Err(argument(py, name, format!("expected whole numbers, got {x}")));
            }
            #[allow(clippy::cast_possible_truncation)]
            let data = converted(py, name, &numbers.data, |&x| x as i64)?;
            Ok(Numbers { data, shape: numbers.shape })
        }
        _ => convert(name, &array),
    }
}

/// Read a set of `length` things, where one is given: a boolean mask of shape (length,), or an array of
/// indices below `length`.
///
/// # Errors
/// `ArgumentError` for another shape or an index out of range; `what` names the things.
pub(crate) fn mask(
    name: &'static str,
    given: Option<&Bound<'_, PyAny>>,
    length: usize,
    what: &str,
) -> PyResult<Option<Vec<bool>>> {
    let Some(object) = given else { return Ok(None) };
    if numeric_array(name, object)?.dtype().kind() == b'b' {
        let numbers: Numbers<f64> = floats(name, object)?;
        let marks = numbers.exactly(object.py(), name, length, what)?;
        return Ok(Some(marks.iter().map(|&x| x != 0.0).collect()));
    }
    let mut set = vec![false; length];
    for i in indices(name, object, length, what)? {
        set[i] = true;
    }
    Ok(Some(set))
}

/// Read indices of `length` things, shape (k,), in the order given.
///
/// # Errors
/// `ArgumentError` for another shape or an index out of range; `what` names the things.
pub(crate) fn indices(
    name: &'static str,
    object: &Bound<'_, PyAny>,
    length: usize,
    what: &str,
) -> PyResult<Vec<usize>> {
    let py = object.py();
    let numbers = integers(name, object)?;
    if numbers.shape.len() != 1 {
        let problem = format!("expected {what} indices of shape (k,), got {}", shape_text(&numbers.shape));
        return Err(argument(py, name, problem));
    }
    let index = |&i: &i64| {
        let outside = || {
            argument(
                py,
                name,
                format!("index {i} is out of range: there are {length} entries, one for each {what}"),
            )
        };
        usize::try_from(i).ok().filter(|&i| i < length).ok_or_else(outside)
    };
    numbers.data.iter().map(index).collect()
}

/// A copy of `values`.
///
/// # Errors
/// `MemoryLimitError` where there is no room for it.
pub(crate) fn copied<T: Copy>(py: Python<'_>, name: &'static str, values: &[T]) -> PyResult<Vec<T>> {
    memory::copied(name, values).map_err(|error| exception(py, &error))
}

/// `convert` of each of `values`.
///
/// # Errors
/// `MemoryLimitError` where there is no room for them.
pub(crate) fn converted<T, U>(
    py: Python<'_>,
    name: &'static str,
    values: &[T],
    convert: impl Fn(&T) -> U,
) -> PyResult<Vec<U>> {
    let mut array = memory::reserved(name, values.len()).map_err(|error| exception(py, &error))?;
    array.extend(values.iter().map(convert));
    Ok(array)
}

/// `(3, 2)` as Python writes it.
pub(crate) fn shape_text(shape: &[usize]) -> String {
    match shape {
        [] => "a single number".into(),
        [length] => format!("shape ({length},)"),
        _ => format!("shape ({})", shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// A fresh (k, N) `float64` array.
///
/// # Errors
/// `MemoryLimitError` where there is no room for it, as of all arrays that are made here.
pub(crate) fn float_rows<'py, const N: usize>(
    py: Python<'py>,
    rows: &[[f64; N]],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(Array2::from(copied(py, RESULT, rows)?).into_pyarray(py))
}

/// A fresh (k, N) `int32` array.
///
/// # Errors
/// As [`float_rows`].
pub(crate) fn index_rows<'py, const N: usize>(
    py: Python<'py>,
    rows: &[[u32; N]],
) -> PyResult<Bound<'py, PyArray2<i32>>> {
    Ok(Array2::from(converted(py, RESULT, rows, |row| row.map(u32::cast_signed))?).into_pyarray(py))
}

/// A fresh array of `rows`, converted by `convert`, and after them `more` rows, flat; written once.
pub(crate) fn joined_rows<T: Copy, U: Element + Copy, const N: usize>(
    py: Python<'_>,
    rows: &[[T; N]],
    convert: impl Fn(T) -> U,
    more: &[U],
) -> PyResult<Py<PyArray2<U>>> {
    let mut whole =
        memory::reserved(RESULT, rows.len() + more.len() / N).map_err(|error| exception(py, &error))?;
    whole.extend(rows.iter().map(|row| row.map(&convert)));
    whole.extend_from_slice(more.as_chunks::<N>().0);
    Ok(Array2::from(whole).into_pyarray(py).unbind())
}

/// A fresh (k,) `int32` array.
///
/// # Errors
/// As [`float_rows`].
pub(crate) fn index_array<'py>(py: Python<'py>, indices: &[u32]) -> PyResult<Bound<'py, PyArray1<i32>>> {
    Ok(converted(py, RESULT, indices, |i| i.cast_signed())?.into_pyarray(py))
}

/// `object` as a NumPy array of booleans, integers or floating-point numbers.
fn numeric_array<'py>(
    name: &'static str,
    object: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = object.py();
    let refuse =
        |found: String| argument(py, name, format!("expected an array of real numbers, got {found}"));
    let array = py
        .import("numpy")?
        .call_method1("asarray", (object,))
        .map_err(|error| refuse(format!("something NumPy cannot read ({error})")))?
        .cast_into::<PyUntypedArray>()?;
    match array.dtype().kind() {
        b'b' | b'i' | b'u' | b'f' => Ok(array),
        _ if object.hasattr("tocsr")? => Err(refuse("a sparse matrix".into())),
        _ => Err(refuse(format!("dtype {}", array.dtype()))),
    }
}

/// The entries of `array` as `T`, converted and copied once.
fn convert<T: Element + Copy>(name: &'static str, array: &Bound<'_, PyUntypedArray>) -> PyResult<Numbers<T>> {
    let py = array.py();
    let shape = array.shape().to_vec();
    let wanted: Bound<'_, PyArrayDescr> = dtype::<T>(py);
    let arguments = PyDict::new(py);
    arguments.set_item("dtype", wanted)?;
    arguments.set_item("requirements", ["C_CONTIGUOUS", "ALIGNED"])?;
    let plain = py.import("numpy")?.call_method("require", (array,), Some(&arguments))?;
    let plain: PyReadonlyArrayDyn<'_, T> = plain.extract()?;
    let data = copied(py, name, plain.as_slice().map_err(|error| argument(py, name, error.to_string()))?)?;
    Ok(Numbers { data, shape })
}
