//! `interpolate`: functions on a mesh through given values, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::solution::Solution;
use crate::{arrays, columns, doorway, options, scalar};

solver_function! {
    /// Minimize an energy of functions that take given values at given vertices.
    ///
    /// Solves min_u E(u) subject to u[indices] = values and A u = b; with several columns see `coupling`.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh
    /// indices : (j,) array of vertex indices
    /// values : (j,) or (j,k) array, one row for each index
    /// energy : "l1_hessian" (sharp ridges), "l2_hessian", "l2_curved_hessian" or "l2_laplacian" (smooth),
    ///     "l1_hessian_stein2018", "l1_edge_laplacian"; see `energy`
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
    /// Solution, its values (n,) or (n,k)
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError, SolveError (contradictory constraints; "l2_curved_hessian" on open saddles
    /// with few given values, where it is not convex), Cancelled
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, eq. (22).
    signature = (mesh, indices, values, *, energy="l1_hessian", face_weights=None, linear_constraints=None,
        coupling="joint", dual="barycentric", delaunay=false, sharpness=0.0), tolerance = 1e-3;
    pub fn interpolate(py: Python<'_>, solve, progress;
        mesh: &Mesh,
        indices: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
        energy: &str,
        face_weights: Option<&Bound<'_, PyAny>>,
        linear_constraints: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
        coupling: &str,
        dual: &str,
        delaunay: bool,
        sharpness: f64,
    ) -> PyResult<Solution> {
        let indices = arrays::indices("indices", indices, mesh.n_vertices(), "vertex")?;
        let values = columns::read("values", values, indices.len(), "index")?;
        let energy = options::EnergyWords { energy, face_weights, dual, delaunay };
        let words = scalar::ScalarWords { energy, linear_constraints, coupling, sharpness };
        let scalar = words.read(py, mesh, values.columns.n_columns, solve)?;
        let solution = doorway::call(py, &progress, || {
            tools::interpolate(mesh.inner(), &indices, &values.columns, &scalar, &progress)
        })?;
        Ok(Solution::new(py, solution, values.single))
    }
}
