//! `fill_holes`: patches that continue the surface around a hole, ridges included.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use ridgeform_core::tools::{self, HoleStatus, LoopChoice, PatchShape, Sharpness};

use crate::errors::argument;
use crate::mesh::Mesh;
use crate::numbers::{at_least, at_least_if};
use crate::{arrays, doorway, options};

/// What `fill_holes` returns: the patches, the mesh with its patches, and how each hole went.
///
/// `vertices`, `faces` and `patch` are the whole mesh and are made when they are first asked for; the arrays
/// named `new_` are the patches alone, in time that does not depend on the mesh.
#[pyclass(frozen, module = "ridgeform")]
pub struct Filled {
    mesh: Py<Mesh>,
    /// The vertices of the patches that are not the mesh's, (k,3) float64, hole by hole.
    #[pyo3(get)]
    new_vertices: Py<PyArray2<f64>>,
    /// The faces of the patches, (p,3) int32, oriented as the faces around;
    /// new vertices are numbered from the mesh's count on.
    #[pyo3(get)]
    new_faces: Py<PyArray2<i32>>,
    /// For every face of `new_faces` the entry of `holes` that it fills, (p,) int32.
    #[pyo3(get)]
    new_patch: Py<PyArray1<i32>>,
    whole_vertices: PyOnceLock<Py<PyArray2<f64>>>,
    whole_faces: PyOnceLock<Py<PyArray2<i32>>>,
    whole_patch: PyOnceLock<Py<PyArray1<i32>>>,
    /// What became of every hole that was chosen, a list of FilledHole.
    #[pyo3(get)]
    holes: Vec<Py<FilledHole>>,
    /// The edges of sharp and flat patches, rim included, that are bent by more than 30 degrees,
    /// (k,2) int32, smaller vertex first.
    #[pyo3(get)]
    ridges: Py<PyArray2<i32>>,
    /// "stopped" (`Progress.finish` was called), "finished" (a hole took all iterations) or "converged" (all
    /// patches rest).
    #[pyo3(get)]
    status: &'static str,
}

#[pymethods]
impl Filled {
    /// The vertices, (n',3) float64: the input's first, bit by bit, then those of the patches, hole by hole.
    #[getter]
    fn vertices(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        let make = || {
            let new = self.new_vertices.bind(py).readonly();
            let old = self.mesh.get().inner().positions().unwrap_or_default();
            arrays::joined_rows(py, old, |x| x, new.as_slice()?)
        };
        Ok(self.whole_vertices.get_or_try_init(py, make)?.clone_ref(py))
    }

    /// The faces, (m',3) int32: the input's first, unchanged, then those of the patches,
    /// oriented as the faces around.
    #[getter]
    fn faces(&self, py: Python<'_>) -> PyResult<Py<PyArray2<i32>>> {
        let make = || {
            let new = self.new_faces.bind(py).readonly();
            arrays::joined_rows(
                py,
                self.mesh.get().inner().connectivity().faces(),
                u32::cast_signed,
                new.as_slice()?,
            )
        };
        Ok(self.whole_faces.get_or_try_init(py, make)?.clone_ref(py))
    }

    /// For every face the entry of `holes` that it fills, or -1 for the input's, (m',) int32.
    #[getter]
    fn patch(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i32>>> {
        let make = || {
            let new = self.new_patch.bind(py).readonly();
            let mut whole = Vec::with_capacity(self.mesh.get().n_faces() + new.len()?);
            whole.resize(self.mesh.get().n_faces(), -1);
            whole.extend_from_slice(new.as_slice()?);
            PyResult::Ok(whole.into_pyarray(py).unbind())
        };
        Ok(self.whole_patch.get_or_try_init(py, make)?.clone_ref(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let refused = self.holes.iter().filter(|hole| hole.get().status == "refused").count();
        let sharp = self.holes.iter().filter(|hole| hole.get().sharpness > 0.0).count();
        let (filled, edges) = (self.holes.len() - refused, self.ridges.bind(py).as_any().len().unwrap_or(0));
        format!(
            "<ridgeform.Filled: {filled} holes filled, {sharp} of them sharp ({edges} ridge edges), \
            {refused} refused>"
        )
    }
}

/// What became of one hole: how sharp it was filled, how its flow ended, or why it was left open.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct FilledHole {
    /// The vertices around it, (k,) int32.
    boundary: Py<PyArray1<i32>>,
    /// "converged" (the patch no longer moves, or is the smooth one), "finished" (all iterations done),
    /// "stopped" (`Progress.finish` was called) or "refused" (left open, see `reason`).
    status: &'static str,
    /// Why it was refused, or None.
    reason: Option<String>,
    /// What the patch looks like: "flat", "smooth" or "sharp"; None where the hole was refused.
    shape: Option<&'static str>,
    /// The sharpness used; 0 where the patch is smooth or flat.
    sharpness: f64,
    /// The L1 Hessian energy of the coordinates of patch and surroundings before and after the flow;
    /// zeros without one.
    energy: (f64, f64),
    /// The certified relative duality gap of the flow's last step.
    gap: f64,
    /// Steps of the flow done.
    iterations: usize,
}

#[pymethods]
impl FilledHole {
    fn __repr__(&self, py: Python<'_>) -> String {
        let edges = self.boundary.bind(py).as_any().len().unwrap_or(0);
        let how = self.shape.unwrap_or("open");
        format!(
            "<ridgeform.FilledHole: {edges} edges, {how}, {} after {} steps>",
            self.status, self.iterations
        )
    }
}

solver_function! {
    /// Fill holes so that the surface around them goes on, ridges included.
    ///
    /// Faces are oriented and seams joined first, as `orient` and `weld` do; what comes out is given for the
    /// mesh as it was. A planar rim that the surface meets steeply all round, as the missing side of a box or
    /// the cut end of a tube, is closed flat. Every other hole is triangulated (Liepa 2003) and remeshed at
    /// the resolution of its rim. The patch starts as the smooth one. Where the surface around the hole has
    /// ridges, the L1 Hessian flow, edge flips along the ridges and snapping of vertices onto the planes
    /// around them bring the ridges back. Everything outside the patches stays as it is, and costs nothing.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh with positions
    /// loops : None for all holes; or a list of indices into `find_holes(mesh)`,
    ///     or of arrays of the vertices around a hole
    /// max_edges : with loops=None, only holes of at most so many edges
    /// outer : with loops=None, also close the outer borders of open sheets
    /// edge_length : float > 0, of the patches; None continues that of the rim
    /// iterations : steps of the flow at most, ≥ 0; 0 leaves the smooth patch
    /// fidelity : float > 0, how strongly a step holds on to the shape, in the unit that `scale` sets
    /// shape : "auto" (per hole: flat, sharp or smooth), "flat" (in the mean plane of the rim, all but
    ///     notches in it; as "auto" where that would overlap itself), "smooth" (no ridges) or "sharp"
    /// sharpness : "auto" (per hole: sharp where there are ridges around it, else smooth), or 0 (the paper's
    ///     flow, without flips and snapping) to 1 (most angular)
    /// coupling : "joint" (independent of the axes) or "separate" (the paper's)
    /// scale : "max_edge", "bounding_box", "area" or "extent" of the patch is 1
    /// dual : "barycentric", "circumcentric" or "circumcentric_or_barycentric"
    solver keywords
    /// progress : Progress or None; its snapshot_surface() shows the patch in work
    ///
    /// Returns
    /// -------
    /// Filled
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError (no positions; vertices in `loops` that are no boundary loop), SolveError,
    /// Cancelled. Holes that cannot be filled are left open and reported in `Filled.holes`.
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, section 7.4.2; Liepa 2003; Botsch and Kobbelt 2004.
    signature = (mesh, *, loops=None, max_edges=None, outer=false, edge_length=None, iterations=50,
        fidelity=50.0, shape="auto", sharpness=None, coupling="joint", scale="max_edge", dual="barycentric"),
        tolerance = None,
    text_signature = "(mesh, *, loops=None, max_edges=None, outer=False, edge_length=None, iterations=50, \
    fidelity=50.0, \
    shape='auto', sharpness='auto', coupling='joint', scale='max_edge', dual='barycentric', solver='auto', \
    tolerance=None,     max_iterations=None, memory_limit=None, threads=None, progress=None)";
    pub fn fill_holes(py: Python<'_>, solve, progress;
        mesh: &Bound<'_, Mesh>,
        loops: Option<&Bound<'_, PyAny>>,
        max_edges: Option<i64>,
        outer: bool,
        edge_length: Option<f64>,
        iterations: i64,
        fidelity: f64,
        shape: &str,
        sharpness: Option<&Bound<'_, PyAny>>,
        coupling: &str,
        scale: &str,
        dual: &str,
    ) -> PyResult<Filled> {
        let options = tools::FillHolesOptions {
            loops: loops.map(|given| read_loops(given, mesh.get().n_vertices())).transpose()?,
            max_edges: at_least_if(py, "max_edges", max_edges, 3)?,
            outer,
            edge_length,
            iterations: at_least(py, "iterations", iterations, 0)?,
            fidelity,
            shape: read_shape(py, shape)?,
            sharpness: read_sharpness(py, sharpness)?,
            coupling: options::coupling(py, coupling)?,
            scale: options::scale(py, scale)?,
            dual: options::dual(py, dual)?,
            solve: solve()?,
        };
        let inner = mesh.get().inner();
        let result = doorway::call(py, &progress, || tools::fill_holes(inner, &options, &progress))?;
        let holes = result.holes.iter().map(|hole| Py::new(py, filled_hole(py, hole)?));
        Ok(Filled {
            mesh: mesh.clone().unbind(),
            new_vertices: arrays::float_rows(py, &result.vertices)?.unbind(),
            new_faces: arrays::index_rows(py, &result.faces)?.unbind(),
            new_patch: arrays::index_array(py, &result.patch)?.unbind(),
            whole_vertices: PyOnceLock::new(),
            whole_faces: PyOnceLock::new(),
            whole_patch: PyOnceLock::new(),
            holes: holes.collect::<PyResult<_>>()?,
            ridges: arrays::index_rows(py, &result.ridges)?.unbind(),
            status: result.status.name(),
        })
    }
}

fn filled_hole(py: Python<'_>, hole: &tools::FilledHole) -> PyResult<FilledHole> {
    let reason = match hole.status {
        HoleStatus::Refused(reason) => Some(reason.to_string()),
        _ => None,
    };
    Ok(FilledHole {
        boundary: arrays::index_array(py, &hole.boundary)?.unbind(),
        status: hole.status.name(),
        shape: reason.is_none().then(|| hole.shape.name()),
        reason,
        sharpness: hole.sharpness,
        energy: hole.energy.into(),
        gap: hole.gap,
        iterations: hole.iterations,
    })
}

/// `shape=`: one of the words.
fn read_shape(py: Python<'_>, word: &str) -> PyResult<PatchShape> {
    let shapes = [PatchShape::Auto, PatchShape::Flat, PatchShape::Smooth, PatchShape::Sharp];
    options::choice(py, "shape", word, &shapes.map(|shape| (shape.name(), shape)))
}

/// `sharpness=`: the word "auto" (also the default) or a number.
fn read_sharpness(py: Python<'_>, given: Option<&Bound<'_, PyAny>>) -> PyResult<Sharpness> {
    let Some(given) = given else { return Ok(Sharpness::Auto) };
    if let Ok(word) = given.extract::<String>() {
        return options::choice(py, "sharpness", &word, &[("auto", Sharpness::Auto)]);
    }
    given.extract().map(Sharpness::Value).map_err(|_| {
        argument(py, "sharpness", format!("expected \"auto\" or a number between 0 and 1, got {given}"))
    })
}

/// `loops=`: indices of loops, or arrays of vertices.
fn read_loops(given: &Bound<'_, PyAny>, n_vertices: usize) -> PyResult<Vec<LoopChoice>> {
    let py = given.py();
    let refuse = || argument(py, "loops", "expected a list of loop indices or of arrays of vertex indices");
    let read = |item: Bound<'_, PyAny>| {
        if item.hasattr("__len__")? && item.len().is_ok() {
            let vertices = arrays::indices("loops", &item, n_vertices, "vertex")?;
            return Ok(LoopChoice::Vertices(vertices.into_iter().map(|v| v as u32).collect()));
        }
        let index = arrays::integers("loops", &item)?;
        match index.data.as_slice() {
            [index] => Ok(LoopChoice::Index(at_least(py, "loops", *index, 0)?)),
            _ => Err(refuse()),
        }
    };
    given.try_iter().map_err(|_| refuse())?.map(|item| read(item?)).collect()
}
