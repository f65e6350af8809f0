//! `coarsen`: a coarser mesh of a surface, and where each vertex lies on it.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::{levels, memory::Tool};

use crate::mesh::Mesh;
use crate::numbers::at_least;
use crate::progress::{handle, Progress};
use crate::{arrays, doorway};

/// What `coarsen` returns: the coarser mesh, and where the vertices of the finer one are on it.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Coarsened {
    /// The vertex positions, (n',3) float64.
    vertices: Py<PyArray2<f64>>,
    /// The vertex indices of every face, (m',3) int32.
    faces: Py<PyArray2<i32>>,
    /// For every vertex of the finer mesh the one that stands for it, (n,) int32; -1 where it has no faces.
    parents: Py<PyArray1<i32>>,
    /// For every vertex of the finer mesh the face of the coarser one that is closest to it, around its
    /// parent, (n,) int32; -1 where it has no faces or is held.
    places: Py<PyArray1<i32>>,
    /// The weights of that face's corners at the closest point, (n,3) float64, rows of sum 1.
    weights: Py<PyArray2<f64>>,
}

#[pymethods]
impl Coarsened {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (n, m) = (self.vertices.bind(py).len()?, self.faces.bind(py).len()?);
        Ok(format!("<ridgeform.Coarsened: {n} vertices, {m} faces>"))
    }
}

/// A mesh with fewer vertices, by collapsing the edges that leave the surface least, and where the vertices
/// of the finer one are on it.
///
/// A vertex stands for those that collapsed into it, and is where their faces, weighted by area, have it:
/// under noise nearer to the surface than they are. Open borders keep their line, non-manifold edges stay,
/// and no collapse turns a face over or makes a sliver. What the coarser mesh has comes to a vertex v of the
/// finer one by `weights[v] @ values[faces[places[v]]]`.
///
/// Parameters
/// ----------
/// mesh : Mesh with positions
/// n_vertices : number of vertices wanted, ≥ 1; more are left where edges cannot collapse
/// kept : vertices that stay, bit by bit, each on its own: (n,) booleans or (j,) indices; None for none
/// held : vertices that never become one with others that are not, nor have a place on the coarser mesh,
///     given in the same way
/// progress : Progress or None
///
/// Returns
/// -------
/// Coarsened
///
/// Raises
/// ------
/// ArgumentError, MeshError (no positions), Cancelled
///
/// References
/// ----------
/// Garland and Heckbert 1997, Surface simplification using quadric error metrics.
#[pyfunction]
#[pyo3(signature = (mesh, n_vertices, *, kept=None, held=None, progress=None))]
pub(crate) fn coarsen(
    py: Python<'_>,
    mesh: &Mesh,
    n_vertices: i64,
    kept: Option<&Bound<'_, PyAny>>,
    held: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Coarsened> {
    let wanted = at_least(py, "n_vertices", n_vertices, 1)?;
    let kept = arrays::mask("kept", kept, mesh.n_vertices(), "vertex")?;
    let held = arrays::mask("held", held, mesh.n_vertices(), "vertex")?;
    let progress = handle(progress);
    let level = doorway::call(py, &progress, || {
        mesh.inner().demand(Tool::Remesh).admit(None)?;
        levels::level(mesh.inner(), held.as_deref(), kept.as_deref(), wanted, &progress)
    })?;
    let faces = level.carry.places().map(|place| place.map_or(-1, |(face, _)| face.cast_signed()));
    let weights: Vec<[f64; 3]> = level.carry.places().map(|place| place.map_or([0.0; 3], |p| p.1)).collect();
    Ok(Coarsened {
        vertices: arrays::float_rows(py, level.mesh.positions().unwrap_or_default())?.unbind(),
        faces: arrays::index_rows(py, level.mesh.connectivity().faces())?.unbind(),
        places: faces.collect::<Vec<_>>().into_pyarray(py).unbind(),
        weights: arrays::float_rows(py, &weights)?.unbind(),
        parents: level.parents.iter().map(|v| v.cast_signed()).collect::<Vec<_>>().into_pyarray(py).unbind(),
    })
}
