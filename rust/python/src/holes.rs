//! `find_holes`: which boundary loops are holes.

use numpy::PyArray1;
use pyo3::prelude::*;
use ridgeform_core::hole_filling;
use ridgeform_core::memory::Tool;

use crate::arrays::index_array;
use crate::doorway;
use crate::mesh::Mesh;

/// A boundary loop, and what can be said of it as a hole.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Hole {
    /// Its vertices, (k,) int32, in the direction of the faces' halfedges.
    vertices: Py<PyArray1<i32>>,
    /// Whether it is the outer border of an open sheet rather than a hole in it.
    is_outer_border: bool,
    /// Why it cannot be filled, a clause in words; None if nothing is known against it.
    refusal: Option<String>,
}

#[pymethods]
impl Hole {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let kind = if self.is_outer_border { "outer border" } else { "hole" };
        let refused =
            self.refusal.as_ref().map_or(String::new(), |reason| format!(", not fillable: {reason}"));
        Ok(format!("<ridgeform.Hole: {kind} of {} edges{refused}>", self.vertices.bind(py).len()?))
    }
}

/// All boundary loops, a list of Hole in the order of `boundary_loops`, then the rims that do not close:
/// which are holes, and which of them cannot be filled.
///
/// Faces are oriented and seams joined first. A loop is an outer border if the faces along it lie inside it;
/// where they stand too steeply to say so and the loop is no planar rim that calls for a lid, it is the
/// largest loop of a component whose area vectors add up to more than 0.57 of its area. A tube has none: its
/// two ends are holes. MeshError for a mesh without positions.
#[pyfunction]
pub(crate) fn find_holes(py: Python<'_>, mesh: &Mesh) -> PyResult<Vec<Hole>> {
    let holes = doorway::call_sized(py, mesh.inner().demand(Tool::FindHoles), || {
        hole_filling::find_holes(mesh.inner())
    })?;
    let convert = |hole: hole_filling::Hole| {
        PyResult::Ok(Hole {
            vertices: index_array(py, &hole.vertices)?.unbind(),
            is_outer_border: hole.is_outer_border,
            refusal: hole.refusal.map(|reason| reason.to_string()),
        })
    };
    holes.into_iter().map(convert).collect()
}
