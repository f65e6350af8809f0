//! `SparseMatrix`: compressed sparse rows out to Python, and matrices of every kind in.

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyModuleNotFoundError;
use pyo3::prelude::*;
use ridgeform_core::linear::Columns;
use ridgeform_core::Error;
use sprs::{CsMat, TriMat};

use crate::arrays::{finite_floats, integers, shape_text, Numbers};
use crate::columns;
use crate::doorway;
use crate::errors::{argument, exception};

/// A sparse matrix in compressed rows (CSR): row i owns the entries `indptr[i]:indptr[i + 1]` of `indices`
/// and `data`.
#[pyclass(frozen, module = "ridgeform")]
pub struct SparseMatrix {
    matrix: CsMat<f64>,
}

impl SparseMatrix {
    /// Wrap `matrix`, which is brought into compressed rows.
    ///
    /// # Errors
    /// `RidgeformError` if it has more entries than 32-bit indices can count.
    pub fn new(py: Python<'_>, matrix: CsMat<f64>) -> PyResult<Self> {
        let most = matrix.nnz().max(matrix.rows()).max(matrix.cols());
        if i32::try_from(most).is_err() {
            let problem =
                format!("its matrix has {most} entries, more than 32-bit indices can count; split the mesh");
            return Err(exception(py, &Error::argument("mesh", problem)));
        }
        Ok(Self { matrix: matrix.into_csr() })
    }
}

#[pymethods]
impl SparseMatrix {
    /// Number of rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        self.matrix.shape()
    }

    /// Number of stored entries.
    #[getter]
    fn nnz(&self) -> usize {
        self.matrix.nnz()
    }

    /// Where each row's entries begin, (rows + 1,) int32, a fresh array.
    #[getter]
    fn indptr<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        int32(self.matrix.indptr().to_proper().iter()).into_pyarray(py)
    }

    /// The column of each entry, ascending within a row, (nnz,) int32, a fresh array.
    #[getter]
    fn indices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        int32(self.matrix.indices().iter()).into_pyarray(py)
    }

    /// The value of each entry, (nnz,) float64, a fresh array.
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.matrix.data().to_vec().into_pyarray(py)
    }

    /// The same matrix as a `scipy.sparse.csr_array`.
    ///
    /// Raises ImportError where SciPy is not installed; nothing else here needs it.
    fn to_scipy<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let sparse = py.import("scipy.sparse").map_err(|error| {
            if error.is_instance_of::<PyModuleNotFoundError>(py) {
                PyModuleNotFoundError::new_err(
                    "SparseMatrix.to_scipy needs SciPy; install it with: pip install scipy",
                )
            } else {
                error
            }
        })?;
        let matrix = slf.get();
        sparse.call_method1(
            "csr_array",
            ((matrix.data(py), matrix.indices(py), matrix.indptr(py)), matrix.shape()),
        )
    }

    /// The product with an array (columns,) or (columns,k): (rows,) or (rows,k) float64.
    ///
    /// Raises ArgumentError for another shape and for numbers that are not finite.
    fn __matmul__<'py>(&self, py: Python<'py>, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let factor = columns::read("array", other, self.matrix.cols(), "column of the matrix")?;
        let product = doorway::call_briefly(py, || Ok(factor.map(|column| times(&self.matrix, column))))?;
        Ok(columns::write(py, product))
    }

    /// None, so that NumPy leaves `array @ matrix` to Python, which refuses it.
    #[classattr]
    #[allow(non_upper_case_globals)]
    const __array_ufunc__: Option<u8> = None;

    fn __repr__(&self) -> String {
        let (rows, columns) = self.matrix.shape();
        format!("<ridgeform.SparseMatrix: {rows} x {columns}, {} entries>", self.matrix.nnz())
    }
}

/// Read a matrix with `n_columns` columns: a `SparseMatrix`, a SciPy sparse matrix or a 2-D array.
///
/// # Errors
/// `ArgumentError` for anything else and for entries that are not finite.
pub(crate) fn read(name: &'static str, object: &Bound<'_, PyAny>, n_columns: usize) -> PyResult<CsMat<f64>> {
    let py = object.py();
    let matrix = if let Ok(own) = object.cast::<SparseMatrix>() {
        own.get().matrix.clone()
    } else if object.hasattr("tocsr")? {
        from_scipy(name, object)?
    } else {
        from_dense(py, name, finite_floats(name, object)?)?
    };
    if matrix.cols() != n_columns {
        let problem = format!("expected {n_columns} columns, one for each vertex, got {}", matrix.cols());
        return Err(argument(py, name, problem));
    }
    Ok(matrix)
}

/// Read `linear_constraints=(A, b)`: A with `n` columns, b with a row for each of A's and `k` columns.
///
/// # Errors
/// `ArgumentError` for shapes that do not fit and for entries that are not finite.
pub(crate) fn read_constraints(
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    n: usize,
    k: usize,
) -> PyResult<(CsMat<f64>, Columns)> {
    let name = "linear_constraints";
    let a = read(name, a, n)?;
    let right = columns::read(name, b, a.rows(), "row of A")?.columns;
    if right.n_columns != k {
        let problem = format!("b has {} columns, but there are {k} columns of values", right.n_columns);
        return Err(argument(b.py(), name, problem));
    }
    Ok((a, right))
}

fn from_scipy(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<CsMat<f64>> {
    let py = object.py();
    let rows = object.call_method0("tocsr")?;
    let shape: (usize, usize) = rows.getattr("shape")?.extract()?;
    let starts = integers(name, &rows.getattr("indptr")?)?.data;
    let indices = integers(name, &rows.getattr("indices")?)?.data;
    let data = finite_floats(name, &rows.getattr("data")?)?.data;
    let mut triplets = TriMat::with_capacity(shape, data.len());
    for (row, range) in starts.windows(2).enumerate() {
        for k in range[0]..range[1] {
            let entry = usize::try_from(k)
                .ok()
                .and_then(|k| Some((usize::try_from(*indices.get(k)?).ok()?, *data.get(k)?)));
            match entry {
                Some((column, value)) if row < shape.0 && column < shape.1 => {
                    triplets.add_triplet(row, column, value)
                }
                _ => {
                    return Err(argument(
                        py,
                        name,
                        "is not a valid sparse matrix: an index lies outside its shape",
                    ))
                }
            }
        }
    }
    Ok(triplets.to_csr())
}

fn from_dense(py: Python<'_>, name: &'static str, numbers: Numbers<f64>) -> PyResult<CsMat<f64>> {
    let &[rows, columns] = numbers.shape.as_slice() else {
        let problem = format!("expected a matrix with two axes, got {}", shape_text(&numbers.shape));
        return Err(argument(py, name, problem));
    };
    let mut triplets = TriMat::new((rows, columns));
    for (i, &value) in numbers.data.iter().enumerate().filter(|(_, &value)| value != 0.0) {
        triplets.add_triplet(i / columns, i % columns, value);
    }
    Ok(triplets.to_csr())
}

fn times(matrix: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    matrix.outer_iterator().map(|row| row.iter().map(|(j, value)| value * x[j]).sum()).collect()
}

/// 32-bit copies of indices that [`SparseMatrix::new`] has found to fit.
fn int32<'a>(indices: impl Iterator<Item = &'a usize>) -> Vec<i32> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)]
    indices.map(|&i| i as i32).collect()
}
