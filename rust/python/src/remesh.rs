//! `remesh`: edges of about the same length.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::remesh as core;

use crate::mesh::Mesh;
use crate::numbers::at_least;
use crate::progress::{handle, Progress};
use crate::{arrays, doorway};

/// What `remesh` returns: the new mesh, and which of its vertices are the input's.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Remeshed {
    /// The vertex positions, (n',3) float64.
    vertices: Py<PyArray2<f64>>,
    /// The vertex indices of every face, (m',3) int32.
    faces: Py<PyArray2<i32>>,
    /// For every vertex the index of the input's vertex that it is, unmoved (fixed vertices, corners,
    /// non-manifold vertices), or -1, (n',) int32.
    origin: Py<PyArray1<i32>>,
    /// The target edge length.
    edge_length: f64,
    /// Number of rounds done.
    iterations: usize,
    /// "finished" (all rounds done) or "stopped" (`Progress.finish` was called).
    status: &'static str,
}

#[pymethods]
impl Remeshed {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (n, m) = (self.vertices.bind(py).len()?, self.faces.bind(py).len()?);
        Ok(format!("<ridgeform.Remeshed: {n} vertices, {m} faces, {}>", self.status))
    }
}

/// Remesh a surface with edges of about the same length and triangles close to equilateral,
/// without moving it.
///
/// Each round splits edges longer than 4/3 of the target, collapses those shorter than 4/5, flips edges
/// toward valence 6, moves vertices along the surface to the center of their neighbors and projects them back
/// onto the input. Borders and feature lines keep their course and their corners, non-manifold edges stay.
/// Nothing is folded over, and slivers are removed where possible.
///
/// Parameters
/// ----------
/// mesh : Mesh with positions
/// edge_length : float > 0, the target; None is the mean of the mesh's edges
/// iterations : number of rounds, 0 to 10,000
/// fixed : vertices that stay, bit by bit: (n,) booleans or (j,) indices; border and feature edges between
///     two of them and faces with three stay too
/// feature_angle : degrees, 0 to 180; edges whose faces turn by more are kept as lines; None keeps none
/// progress : Progress or None
///
/// Returns
/// -------
/// Remeshed
///
/// Raises
/// ------
/// ArgumentError, MeshError (no positions, no face with area), Cancelled
///
/// References
/// ----------
/// Botsch and Kobbelt 2004, A remeshing approach to multiresolution modeling.
#[pyfunction]
#[pyo3(signature = (mesh, *, edge_length=None, iterations=10, fixed=None, feature_angle=45.0, progress=None))]
pub(crate) fn remesh(
    py: Python<'_>,
    mesh: &Mesh,
    edge_length: Option<f64>,
    iterations: i64,
    fixed: Option<&Bound<'_, PyAny>>,
    feature_angle: Option<f64>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Remeshed> {
    let options = core::RemeshOptions {
        edge_length,
        iterations: at_least(py, "iterations", iterations, 0)?,
        fixed: arrays::mask("fixed", fixed, mesh.n_vertices(), "vertex")?,
        feature_angle: feature_angle.map(f64::to_radians),
    };
    let progress = handle(progress);
    let result = doorway::call(py, &progress, || core::remesh(mesh.inner(), &options, &progress))?;
    let origin: Vec<i32> = result.origin.iter().map(|v| v.map_or(-1, u32::cast_signed)).collect();
    Ok(Remeshed {
        vertices: arrays::float_rows(py, &result.vertices)?.unbind(),
        faces: arrays::index_rows(py, &result.faces)?.unbind(),
        origin: origin.into_pyarray(py).unbind(),
        edge_length: result.edge_length,
        iterations: result.iterations,
        status: if result.iterations < options.iterations { "stopped" } else { "finished" },
    })
}
