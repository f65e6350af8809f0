//! `interpolate`: functions on a mesh through given values, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::solution::Solution;
use crate::{arrays, columns, doorway};

scalar_function! {
    /// Minimize an energy of functions that take given values at given vertices.
    ///
    /// Solves min_u E(u) subject to u[indices] = values and A u = b; with several columns see `coupling`.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh
    /// indices : (j,) array of vertex indices
    /// values : (j,) or (j,k) array, one row for each index
    scalar keywords
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
    signature = (mesh, indices, values, *);
    pub fn interpolate(py: Python<'_>, scalar, progress;
        mesh: &Mesh,
        indices: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
    ) -> PyResult<Solution> {
        let indices = arrays::indices("indices", indices, mesh.n_vertices(), "vertex")?;
        let values = columns::read("values", values, indices.len(), "index")?;
        let scalar = scalar(mesh, values.columns.n_columns)?;
        let solution = doorway::call(py, &progress, || {
            tools::interpolate(mesh.inner(), &indices, &values.columns, &scalar, &progress)
        })?;
        Ok(Solution::new(py, solution, values.single))
    }
}
