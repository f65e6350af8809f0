//! `denoise`: functions on a mesh close to given ones, with sparse second derivatives.

use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::mesh::Mesh;
use crate::solution::Solution;
use crate::{arrays, columns, doorway};

scalar_function! {
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
    /// fixed : vertices that keep their values: (n,) booleans or (j,) indices
    scalar keywords
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
    signature = (mesh, values, *, fidelity, fixed=None);
    pub fn denoise(py: Python<'_>, scalar, progress;
        mesh: &Mesh,
        values: &Bound<'_, PyAny>,
        fidelity: f64,
        fixed: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Solution> {
        let n = mesh.n_vertices();
        let values = columns::read("values", values, n, "vertex")?;
        let scalar = scalar(mesh, values.columns.n_columns)?;
        let options = tools::DenoiseOptions {
            fidelity,
            fixed: arrays::mask("fixed", fixed, n, "vertex")?,
            scalar,
        };
        let solution = doorway::call(py, &progress, || {
            tools::denoise(mesh.inner(), &values.columns, &options, &progress)
        })?;
        Ok(Solution::new(py, solution, values.single))
    }
}
