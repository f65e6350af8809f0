//! `vibration_modes`: orthonormal functions of least energy.

use pyo3::exceptions::PyRuntimeWarning;
use pyo3::prelude::*;
use ridgeform_core::solve::Status;
use ridgeform_core::tools;

use crate::columns::{self, Values};
use crate::mesh::Mesh;
use crate::numbers::at_least;
use crate::{doorway, options};

solver_function! {
    /// The first vibration modes of a surface: orthonormal functions of least energy, one after the other.
    ///
    /// With a quadratic energy they are the eigenvectors of the smallest eigenvalues. With an L1 energy they
    /// are compressed modes with sharp ridges: alternately u = argmin E(u) among functions orthogonal to the
    /// modes before with (c, u) = 1, and c = u / |u|, until the energy falls by a smaller share than the
    /// tolerance, starting from the modes of the squares; functions without energy (constants, on a plane
    /// affine functions) come first.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh
    /// count : number of modes, from 1 to the number of vertices with an area
    /// energy : as for `interpolate`
    /// face_weights : (m,) array w ≥ 0, 1 where None
    /// dual, delaunay : as for `interpolate`
    solver keywords
    /// progress : Progress or None; its iteration is the number of modes done
    ///
    /// Returns
    /// -------
    /// (n,count) array, a mode a column, with ascending energies, orthonormal with respect to `voronoi_mass`
    /// (of the flipped mesh with `delaunay`); the entry of largest magnitude is positive. After
    /// `Progress.finish` there may be fewer columns.
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError, SolveError, Cancelled;
    /// warns with RuntimeWarning if a problem in between missed its tolerance
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, eq. (38), in the limit of large μ; Brandt and Hildebrandt 2017.
    signature = (mesh, count, *, energy="l1_hessian", face_weights=None, dual="barycentric", delaunay=false),
        tolerance = 1e-3;
    pub fn vibration_modes<'py>(py: Python<'py>, solve, progress;
        mesh: &Mesh,
        count: i64,
        energy: &str,
        face_weights: Option<&Bound<'py, PyAny>>,
        dual: &str,
        delaunay: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let count = at_least(py, "count", count, 1)?;
        let options = tools::ModeOptions {
            energy: options::EnergyWords { energy, face_weights, dual, delaunay }.read(py, mesh)?,
            solve: solve()?,
        };
        let modes = doorway::call(py, &progress, || {
            tools::vibration_modes(mesh.inner(), count, &options, &progress)
        })?;
        if modes.status == Status::Inaccurate {
            let category = py.get_type::<PyRuntimeWarning>();
            let message = c"a problem between the modes missed its tolerance; allow more iterations or a \
            larger tolerance";
            PyErr::warn(py, &category, message, 1)?;
        }
        Ok(columns::write(py, Values { columns: modes.values, single: false }))
    }
}
