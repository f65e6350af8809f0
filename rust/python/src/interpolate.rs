//! `interpolate`: functions on a mesh through given values, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::progress::{handle, Progress};
use crate::solution::Solution;
use crate::{arrays, columns, doorway, matrix, options};

/// Minimise the L1 Hessian energy of functions that take given values at given vertices.
///
/// Solves min_u Σ_f w_f ‖(H u)_f‖ subject to u[indices] = values and A u = b; with several columns see `coupling`.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// indices : (j,) array of vertex indices
/// values : (j,) or (j,k) array, one row for each index
/// energy : "l1_hessian"
/// face_weights : (m,) array w ≥ 0, 1 where None
/// linear_constraints : (A, b) with A (p,n): SparseMatrix, SciPy sparse matrix or array, and b (p,) or (p,k)
/// coupling : "joint" (one norm for all columns) or "separate" (each column is a problem of its own)
/// dual : "barycentric" or "circumcentric" dual edges
/// sharpness : 0 (the convex problem) to 1, reweighted rounds that concentrate curvature
/// solver : "auto", "fast", "clarabel", "clarabel-qdldl" or "clarabel-faer"
/// tolerance : certified relative gap to reach; None stops on residuals and reports the gap reached
/// max_iterations, threads : int or None
/// progress : Progress or None
///
/// Returns
/// -------
/// Solution, its values (n,) or (n,k)
///
/// Raises
/// ------
/// ArgumentError, MeshError, SolveError (contradictory constraints), Cancelled
///
/// References
/// ----------
/// Rowe et al. 2024, eq. (22).
#[pyfunction]
#[pyo3(signature = (mesh, indices, values, *, energy="l1_hessian", face_weights=None, linear_constraints=None,
    coupling="joint", dual="barycentric", sharpness=0.0, solver="auto", tolerance=1e-3, max_iterations=None,
    threads=None, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn interpolate(
    py: Python<'_>,
    mesh: &Mesh,
    indices: &Bound<'_, PyAny>,
    values: &Bound<'_, PyAny>,
    energy: &str,
    face_weights: Option<&Bound<'_, PyAny>>,
    linear_constraints: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
    coupling: &str,
    dual: &str,
    sharpness: f64,
    solver: &str,
    tolerance: Option<f64>,
    max_iterations: Option<i64>,
    threads: Option<i64>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Solution> {
    options::only_l1_hessian(py, "energy", energy)?;
    let (n, m) = (mesh.n_vertices(), mesh.n_faces());
    let indices = arrays::indices("indices", indices, n, "vertex")?;
    let values = columns::read("values", values, indices.len(), "index")?;
    let options = tools::InterpolateOptions {
        face_weights: options::weights("face_weights", face_weights, m, "face")?,
        linear_constraints: linear_constraints
            .map(|(a, b)| matrix::read_constraints(&a, &b, n, values.columns.n_columns))
            .transpose()?,
        coupling: options::coupling(py, coupling)?,
        dual: options::dual(py, dual)?,
        sharpness,
        solve: options::solve(py, solver, tolerance, max_iterations, threads)?,
    };
    let progress = handle(progress);
    let solution = doorway::call(py, &progress, || {
        tools::interpolate(mesh.inner(), &indices, &values.columns, &options, &progress)
    })?;
    Ok(Solution::new(py, solution, values.single))
}
