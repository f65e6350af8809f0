//! `denoise`: functions on a mesh close to given ones, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::progress::{handle, Progress};
use crate::solution::Solution;
use crate::{arrays, columns, doorway, matrix, options};

/// Minimise an energy of functions plus `fidelity` times their squared distance to `values`.
///
/// Solves min_u E(u) + fidelity (u - values)ᵀ M (u - values), M the Voronoi mass, subject to A u = b; with
/// several columns see `coupling`.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// values : (n,) or (n,k) array, one row for each vertex
/// fidelity : float > 0, in energy per area and squared value: twice as large a mesh wants a quarter of it
/// energy : "l1_hessian" (sharp ridges), "l2_hessian", "l2_curved_hessian" or "l2_laplacian" (smooth), "l1_hessian_stein2018",
///     "l1_edge_laplacian"; see `energy`
/// fixed : vertices that keep their values: (n,) booleans or (j,) indices
/// face_weights : (m,) array w ≥ 0, 1 where None; energies on vertices and edges take the mean of the faces around them
/// linear_constraints : (A, b) with A (p,n): SparseMatrix, SciPy sparse matrix or array, and b (p,) or (p,k)
/// coupling : "joint" (one norm for all columns) or "separate" (each column is a problem of its own)
/// dual : "barycentric", "circumcentric" (MeshError where a dual edge has no length) or "circumcentric_or_barycentric"
///     (barycentres for such edges); for "l1_hessian" only
/// delaunay : flip edges to the intrinsic Delaunay triangulation first; values stay at the vertices, face weights are averaged
///     over the two faces of each flip; not for energies in space
/// sharpness : 0 (the convex problem) to 1, reweighted rounds that concentrate curvature; for "l1_hessian" only
/// solver : "auto", "fast", "clarabel", "clarabel-qdldl" or "clarabel-faer"; "auto" alone for quadratic energies, which take
///     one sparse factorisation
/// tolerance : certified relative gap to reach; None stops on residuals and reports the gap reached
/// max_iterations, threads : int or None
/// memory_limit : bytes that the factor of the linear system, the larger part of all memory, may take, or None; SolveError
///     with the bytes needed where it does not fit. Clarabel does not know it
/// progress : Progress or None
///
/// Returns
/// -------
/// Solution
///
/// Raises
/// ------
/// ArgumentError, MeshError, SolveError (contradictory constraints; "l2_curved_hessian" on open saddles with
/// few given values, where it is not convex), Cancelled
///
/// References
/// ----------
/// Rowe et al. 2024, eqs. (21) and (23).
#[pyfunction]
#[pyo3(signature = (mesh, values, *, fidelity, energy="l1_hessian", fixed=None, face_weights=None, linear_constraints=None,
    coupling="joint", dual="barycentric", delaunay=false, sharpness=0.0, solver="auto", tolerance=1e-3, max_iterations=None,
    memory_limit=None, threads=None, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn denoise(
    py: Python<'_>,
    mesh: &Mesh,
    values: &Bound<'_, PyAny>,
    fidelity: f64,
    energy: &str,
    fixed: Option<&Bound<'_, PyAny>>,
    face_weights: Option<&Bound<'_, PyAny>>,
    linear_constraints: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
    coupling: &str,
    dual: &str,
    delaunay: bool,
    sharpness: f64,
    solver: &str,
    tolerance: Option<f64>,
    max_iterations: Option<i64>,
    memory_limit: Option<i64>,
    threads: Option<i64>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Solution> {
    let n = mesh.n_vertices();
    let values = columns::read("values", values, n, "vertex")?;
    let energy = options::EnergyWords { energy, face_weights, dual, delaunay };
    let scalar = tools::ScalarOptions {
        energy: energy.read(py, mesh)?,
        linear_constraints: linear_constraints
            .map(|(a, b)| matrix::read_constraints(&a, &b, mesh.n_vertices(), values.columns.n_columns))
            .transpose()?,
        coupling: options::coupling(py, coupling)?,
        sharpness,
        solve: options::solve(py, solver, tolerance, max_iterations, memory_limit, threads)?,
    };
    let options = tools::DenoiseOptions {
        fidelity,
        fixed: fixed.map(|given| arrays::mask("fixed", given, n, "vertex")).transpose()?,
        scalar,
    };
    let progress = handle(progress);
    let solution = doorway::call(py, &progress, || tools::denoise(mesh.inner(), &values.columns, &options, &progress))?;
    Ok(Solution::new(py, solution, values.single))
}
