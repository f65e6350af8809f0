//! `Mesh`: the core's mesh, made once from arrays, and its `MeshReport`.

use std::sync::{Arc, Mutex};

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::error::MeshError;
use ridgeform_core::memory::{Demand, Tool};
use ridgeform_core::{mesh as core, Error};

use crate::arrays::{self, float_rows, floats, index_array, index_rows, integers, plain_rows};
use crate::numbers::at_least_if;
use crate::{doorway, errors};

/// An immutable triangle mesh from vertices (n,3), any length unit, and faces (m,3),
/// counter-clockwise vertex indices.
///
/// Non-manifold edges, inconsistent orientation and faces without area are accepted and count as boundary;
/// `report` tells of them. Raises MeshError for coordinates that are not finite and for faces that name
/// missing vertices, ArgumentError for arrays of another shape.
#[pyclass(frozen, module = "ridgeform")]
pub struct Mesh {
    inner: core::Mesh,
    /// Kept once it was asked for.
    report: Mutex<Option<Arc<core::MeshReport>>>,
}

impl Mesh {
    /// Wrap a mesh of the core.
    pub fn new(inner: core::Mesh) -> Self {
        Self { inner, report: Mutex::default() }
    }

    /// The core's mesh.
    pub fn inner(&self) -> &core::Mesh {
        &self.inner
    }

    /// Number of vertices, those without faces included.
    pub fn n_vertices(&self) -> usize {
        self.inner.connectivity().n_vertices()
    }

    /// Number of faces.
    pub fn n_faces(&self) -> usize {
        self.inner.connectivity().n_faces()
    }
}

#[pymethods]
impl Mesh {
    #[new]
    fn from_arrays(py: Python<'_>, vertices: &Bound<'_, PyAny>, faces: &Bound<'_, PyAny>) -> PyResult<Self> {
        let vertices = match plain_rows::<f64, 3>(vertices) {
            Some(array) => arrays::copied(py, "vertices", array.as_slice()?.as_chunks().0)?,
            None => floats("vertices", vertices)?.rows(py, "vertices")?,
        };
        let faces = read_faces(faces, Some(vertices.len()))?;
        let demand = making(vertices.len(), faces.len());
        doorway::call_sized(py, demand, || core::Mesh::new(vertices, faces)).map(Self::new)
    }

    /// A mesh known by its edge lengths only: lengths (m,3), column i opposite corner i of the face.
    ///
    /// Without n_vertices the vertices are those up to the largest index that a face names. Such a mesh has
    /// all operators, `denoise` and `interpolate`, but no positions to stylize. Raises MeshError for lengths
    /// that are negative, not finite, different on the two faces of an edge or that form no triangle.
    #[staticmethod]
    #[pyo3(signature = (faces, lengths, n_vertices=None))]
    fn from_edge_lengths(
        py: Python<'_>,
        faces: &Bound<'_, PyAny>,
        lengths: &Bound<'_, PyAny>,
        n_vertices: Option<i64>,
    ) -> PyResult<Self> {
        let n_vertices = at_least_if(py, "n_vertices", n_vertices, 0)?;
        if let Some(n) = n_vertices.filter(|&n| n > i32::MAX as usize) {
            return Err(errors::argument(
                py,
                "n_vertices",
                format!("got {n}; 32-bit indices number {} at most", i32::MAX),
            ));
        }
        let faces = read_faces(faces, n_vertices)?;
        let lengths = floats("lengths", lengths)?.rows(py, "lengths")?;
        let most = || faces.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        let demand = making(n_vertices.unwrap_or_else(most), faces.len());
        doorway::call_sized(py, demand, || core::Mesh::from_edge_lengths(faces, lengths, n_vertices))
            .map(Self::new)
    }

    /// The vertex positions, (n,3) float64, a fresh array; None for a mesh known by its edge lengths only.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.inner.positions().map(|positions| float_rows(py, positions)).transpose()
    }

    /// The vertex indices of every face, (m,3) int32, a fresh array.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i32>>> {
        index_rows(py, self.inner.connectivity().faces())
    }

    /// The edge lengths of every face, (m,3) float64, column i opposite corner i, a fresh array.
    #[getter]
    fn edge_lengths<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        float_rows(py, self.inner.edge_lengths())
    }

    /// Number of vertices, those without faces included.
    #[getter(n_vertices)]
    fn get_n_vertices(&self) -> usize {
        self.n_vertices()
    }

    /// Number of faces.
    #[getter(n_faces)]
    fn get_n_faces(&self) -> usize {
        self.n_faces()
    }

    /// What is unusual about the mesh, a MeshReport.
    #[getter]
    fn report(&self, py: Python<'_>) -> PyResult<MeshReport> {
        // Never waited for: a lock held at a fork is not released in the child,
        // and making the report again is cheap.
        if let Some(report) = self.report.try_lock().ok().and_then(|kept| kept.clone()) {
            return MeshReport::new(py, &report);
        }
        let demand = self.inner.demand(Tool::Report);
        let report = Arc::new(doorway::call_sized(py, demand, || core::report(&self.inner))?);
        if let Ok(mut kept) = self.report.try_lock() {
            *kept = Some(Arc::clone(&report));
        }
        MeshReport::new(py, &report)
    }

    fn __repr__(&self) -> String {
        let known = if self.inner.positions().is_some() { "" } else { ", edge lengths only" };
        format!("<ridgeform.Mesh: {} vertices, {} faces{known}>", self.n_vertices(), self.n_faces())
    }
}

/// What is unusual about a mesh: counts, and the edges,
/// vertices and faces that are not as in a clean surface.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct MeshReport {
    /// Number of connected components among the faces; faces that share a vertex are connected.
    n_components: usize,
    /// Number of boundary loops.
    n_boundary_loops: usize,
    /// Edges with more than two faces or two inconsistently oriented ones, (k,2) int32 vertex indices.
    nonmanifold_edges: Py<PyArray2<i32>>,
    /// Those of the non-manifold edges that have two faces, (k,2) int32.
    inconsistent_edges: Py<PyArray2<i32>>,
    /// Faces turned against the faces around them, (k,) int32; tools take them the other way around,
    /// `orient` turns them.
    flipped_faces: Py<PyArray1<i32>>,
    /// Vertices whose faces do not form one fan, (k,) int32.
    nonmanifold_vertices: Py<PyArray1<i32>>,
    /// Faces without area, (k,) int32.
    degenerate_faces: Py<PyArray1<i32>>,
    /// Faces with the same three vertices as an earlier face, (k,) int32.
    duplicate_faces: Py<PyArray1<i32>>,
    /// Faces that lie on another one from a common edge on, as second lids do, (k,) int32.
    doubled_faces: Py<PyArray1<i32>>,
    /// Vertices in the middle of border edges of other faces, (k,) int32;
    /// `segment` takes the two sides as joined.
    t_junctions: Py<PyArray1<i32>>,
    /// Vertices that no face names, (k,) int32.
    unreferenced_vertices: Py<PyArray1<i32>>,
}

impl MeshReport {
    fn new(py: Python<'_>, report: &core::MeshReport) -> PyResult<Self> {
        let indices = |list: &[u32]| index_array(py, list).map(Bound::unbind);
        Ok(Self {
            n_components: report.n_components,
            n_boundary_loops: report.n_boundary_loops,
            nonmanifold_edges: index_rows(py, &report.nonmanifold_edges)?.unbind(),
            inconsistent_edges: index_rows(py, &report.inconsistent_edges)?.unbind(),
            flipped_faces: indices(&report.flipped_faces)?,
            nonmanifold_vertices: indices(&report.nonmanifold_vertices)?,
            degenerate_faces: indices(&report.degenerate_faces)?,
            duplicate_faces: indices(&report.duplicate_faces)?,
            doubled_faces: indices(&report.doubled_faces)?,
            t_junctions: indices(&report.t_junctions)?,
            unreferenced_vertices: indices(&report.unreferenced_vertices)?,
        })
    }
}

#[pymethods]
impl MeshReport {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let count = |list: &Py<PyArray1<i32>>| list.bind(py).len();
        Ok(format!(
            "<ridgeform.MeshReport: {} components, {} boundary loops, {} non-manifold edges, {} non-manifold \
            vertices, \
             {} degenerate, {} duplicate, {} doubled faces, {} T-junctions, {} unreferenced vertices>",
            self.n_components,
            self.n_boundary_loops,
            self.nonmanifold_edges.bind(py).len()?,
            count(&self.nonmanifold_vertices)?,
            count(&self.degenerate_faces)?,
            count(&self.duplicate_faces)?,
            count(&self.doubled_faces)?,
            count(&self.t_junctions)?,
            count(&self.unreferenced_vertices)?,
        ))
    }
}

/// What making a mesh takes.
fn making(n_vertices: usize, n_faces: usize) -> Demand {
    Demand::new(Tool::Mesh, n_vertices, n_faces)
}

/// Read faces; indices that the core's type cannot hold are refused here, the others by the core.
pub(crate) fn read_faces(faces: &Bound<'_, PyAny>, n_vertices: Option<usize>) -> PyResult<Vec<[u32; 3]>> {
    let py = faces.py();
    // The two usual types are read where they are: a copy of each kind costs as much as all else here.
    if let Some(array) = plain_rows::<i32, 3>(faces) {
        return vertex_rows(py, array.as_slice()?.as_chunks().0, n_vertices);
    }
    if let Some(array) = plain_rows::<i64, 3>(faces) {
        return vertex_rows(py, array.as_slice()?.as_chunks().0, n_vertices);
    }
    vertex_rows(py, &integers("faces", faces)?.rows::<3>(py, "faces")?, n_vertices)
}

/// The rows in the core's type.
fn vertex_rows<T: Copy + Into<i64>>(
    py: Python<'_>,
    rows: &[[T; 3]],
    n_vertices: Option<usize>,
) -> PyResult<Vec<[u32; 3]>> {
    // Half of the range is the most that int32 arrays can give back.
    let fits = |&vertex: &T| (0..=i64::from(i32::MAX)).contains(&vertex.into());
    if let Some(face) = rows.iter().position(|row| !row.iter().all(fits)) {
        let vertex = rows[face].iter().find(|&vertex| !fits(vertex)).map_or(-1, |&vertex| vertex.into());
        let n_vertices = n_vertices.unwrap_or(i32::MAX as usize);
        return Err(errors::exception(
            py,
            &Error::Mesh(MeshError::VertexOutOfRange { face, vertex, n_vertices }),
        ));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    arrays::converted(py, "faces", rows, |row| row.map(|vertex| vertex.into() as u32))
}
