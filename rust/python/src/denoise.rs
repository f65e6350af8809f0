//! `denoise`: functions on a mesh close to given ones, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::solution::Solution;
use crate::{arrays, columns, doorway, options, scalar};

solver_function! {
    /// Minimize an energy of functions plus `fidelity` times their squared distance to `values`.
    ///
    /// Solves min_u E(u) + fidelity (u - values)ᵀ M (u - values), M the Voronoi mass, subject to A u = b;
    /// with several columns see `coupling`.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh
    /// values : (n,) or (n,k) array, one row for each vertex
    /// fidelity : float > 0, in energy per area and squared value:
    ///     twice as large a mesh wants a quarter of it
    /// energy : "l1_hessian" (sharp ridges), "l2_hessian", "l2_curved_hessian" or "l2_laplacian" (smooth),
    ///     "l1_hessian_stein2018", "l1_edge_laplacian"; see `energy`
    /// fixed : vertices that keep their values: (n,) booleans or (j,) indices
    /// face_weights : (m,) array w ≥ 0, 1 where None; energies on vertices and edges take the mean of the
    ///     faces around them
    /// linear_constraints : (A, b) with A (p,n): SparseMatrix, SciPy sparse matrix or array,
    ///     and b (p,) or (p,k)
    /// coupling : "joint" (one norm for all columns) or "separate" (each column is a problem of its own)
    /// dual : "barycentric", "circumcentric" (MeshError where a dual edge has no length) or
    ///     "circumcentric_or_barycentric" (barycenters for such edges); for "l1_hessian" only
    /// delaunay : flip edges to the intrinsic Delaunay triangulation first; values stay at the vertices, face
    ///     weights are averaged over the two faces of each flip; not for energies in space
    /// sharpness : 0 (the convex problem) to 1, reweighted rounds that concentrate curvature;
    ///     for "l1_hessian" only
    solver keywords
    /// progress : Progress or None
    ///
    /// Returns
    /// -------
    /// Solution
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError, SolveError (contradictory constraints; "l2_curved_hessian" on open saddles
    /// with few given values, where it is not convex), Cancelled
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, eqs. (21) and (23).
    signature = (mesh, values, *, fidelity, energy="l1_hessian", fixed=None, face_weights=None,
        linear_constraints=None, coupling="joint", dual="barycentric", delaunay=false, sharpness=0.0),
        tolerance = 1e-3;
    pub fn denoise(py: Python<'_>, solve, progress;
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
    ) -> PyResult<Solution> {
        let n = mesh.n_vertices();
        let values = columns::read("values", values, n, "vertex")?;
        let energy = options::EnergyWords { energy, face_weights, dual, delaunay };
        let words = scalar::ScalarWords { energy, linear_constraints, coupling, sharpness };
        let scalar = words.read(py, mesh, values.columns.n_columns, solve)?;
        let options = tools::DenoiseOptions {
            fidelity,
            fixed: fixed.map(|given| arrays::mask("fixed", given, n, "vertex")).transpose()?,
            scalar,
        };
        let solution = doorway::call(py, &progress, || {
            tools::denoise(mesh.inner(), &values.columns, &options, &progress)
        })?;
        Ok(Solution::new(py, solution, values.single))
    }
}
