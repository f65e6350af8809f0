//! What `denoise` and `interpolate` share.

use pyo3::prelude::*;
use ridgeform_core::tools::{ScalarOptions, SolveOptions};

use crate::mesh::Mesh;
use crate::options::{self, EnergyWords};

/// The keywords of both, as they came from Python, but those of the solver.
pub(crate) struct ScalarWords<'a, 'py> {
    /// Those of the energy.
    pub energy: EnergyWords<'a, 'py>,
    /// `linear_constraints=`
    pub linear_constraints: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    /// `coupling=`
    pub coupling: &'a str,
    /// `sharpness=`
    pub sharpness: f64,
}

impl ScalarWords<'_, '_> {
    /// The options on `mesh`, for values of so many columns.
    ///
    /// # Errors
    /// `ArgumentError` for unknown words and for arrays that do not fit, and the errors of `solve`.
    pub(crate) fn read(
        self,
        py: Python<'_>,
        mesh: &Mesh,
        n_columns: usize,
        solve: impl FnOnce() -> PyResult<SolveOptions>,
    ) -> PyResult<ScalarOptions> {
        let constraints = self.linear_constraints;
        Ok(ScalarOptions {
            energy: self.energy.read(py, mesh)?,
            linear_constraints: constraints
                .map(|(a, b)| crate::matrix::read_constraints(&a, &b, mesh.n_vertices(), n_columns))
                .transpose()?,
            coupling: options::coupling(py, self.coupling)?,
            sharpness: self.sharpness,
            solve: solve()?,
        })
    }
}
