//! `restore`: a noisy part put onto the surfaces that it was made of.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use ridgeform_core::surfaces::Surface;
use ridgeform_core::tools::{self, RestoredSurface};

use crate::mesh::Mesh;
use crate::{arrays, doorway};

/// What `restore` returns: the new positions, and the surfaces that the faces lie on.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Restored {
    /// The new vertex positions, (n,3) float64, in the units of the input.
    vertices: Py<PyArray2<f64>>,
    /// Index into `surfaces` for each face, (m,) int32; -1 for faces that took no part.
    labels: Py<PyArray1<i32>>,
    /// For each surface a dict that JSON can hold: "kind" ("plane", "sphere", "cylinder", "cone", "torus" or
    /// "free"), its parameters ("normal" and "offset"; "center" and "radius"; "point", "axis" and "radius";
    /// "apex", "axis", half "angle" in radians, "point" on the axis and "radius" there; "center", "axis",
    /// "major" and "minor"), "inside" (whether the faces look to its inside, as in a bore), "rms" (root mean
    /// square distance of the vertices as they came), and "faces", how many.
    surfaces: Py<PyList>,
    /// Standard deviation of the noise along the normal, in the units of the input: as given or as found.
    noise: f64,
    /// What `regularize` made parallel, orthogonal or equal, in words.
    relations: Vec<String>,
    /// Vertices that would have had to move farther than allowed:
    /// they are on fewer surfaces than their faces, or stayed.
    n_held: usize,
    /// Faces that are still folded over their surface.
    n_folded: usize,
    /// "restored", "unsure" (no piece is sure to be a surface of a known kind: nothing moved) or "stopped"
    /// (`Progress.finish` was called: vertices may be as they came).
    status: &'static str,
}

#[pymethods]
impl Restored {
    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<ridgeform.Restored: {} surfaces, {}>", self.surfaces.bind(py).len(), self.status)
    }
}

fn described<'py>(py: Python<'py>, piece: &RestoredSurface) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kind", piece.surface.map_or("free", |surface| surface.kind().name()))?;
    match piece.surface {
        None => {}
        Some(Surface::Plane { normal, offset }) => {
            dict.set_item("normal", normal.to_vec())?;
            dict.set_item("offset", offset)?;
        }
        Some(Surface::Sphere { center, radius }) => {
            dict.set_item("center", center.to_vec())?;
            dict.set_item("radius", radius)?;
        }
        Some(Surface::Cylinder { point, axis, radius }) => {
            dict.set_item("point", point.to_vec())?;
            dict.set_item("axis", axis.to_vec())?;
            dict.set_item("radius", radius)?;
        }
        Some(cone @ Surface::Cone { point, axis, radius, slope }) => {
            dict.set_item("apex", cone.apex().map(|apex| apex.to_vec()))?;
            dict.set_item("axis", axis.to_vec())?;
            dict.set_item("angle", slope)?;
            dict.set_item("point", point.to_vec())?;
            dict.set_item("radius", radius)?;
        }
        Some(Surface::Torus { center, axis, major, minor }) => {
            dict.set_item("center", center.to_vec())?;
            dict.set_item("axis", axis.to_vec())?;
            dict.set_item("major", major)?;
            dict.set_item("minor", minor)?;
        }
    }
    dict.set_item("inside", piece.is_inside_out)?;
    dict.set_item("rms", piece.rms)?;
    dict.set_item("faces", piece.n_faces)?;
    Ok(dict)
}

solver_function! {
    /// Put a noisy part onto the planes, spheres, cylinders, cones and tori that it was made of.
    ///
    /// Segments are labeled with surfaces by one energy: the negative logarithm of the likelihood of the
    /// vertices under the mesh's own noise, the length of borders, and a price for each parameter. Neighbors
    /// that one surface explains are merged, and faces at borders moved. Then every vertex goes onto its
    /// surface, onto the curve of two, into the corner of three, and vertices move within these until no
    /// triangle is folded. Connectivity stays.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh with positions
    /// max_move : float > 0, how far a vertex may move, in the mesh's units; None: four standard deviations
    ///     of the noise and half a mean edge
    /// noise : float > 0, standard deviation of the noise along the normal, in the mesh's units, less than
    ///     its size; None: as found in the mesh
    /// regularize : degrees, 0 to 30, up to which directions are made parallel and orthogonal, and in the
    ///     same proportion radii equal; None: surfaces as fitted
    /// free : whether pieces of no known kind are denoised by the flow; otherwise they stay
    /// fixed : vertices that stay where they are: (n,) booleans or (j,) indices
    /// faces : faces to restore, (m,) booleans or (j,) indices; None for all. Vertices of others stay
    solver keywords
    /// progress : Progress or None
    ///
    /// Returns
    /// -------
    /// Restored
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError (no positions, no face with area), SolveError, Cancelled
    ///
    /// References
    /// ----------
    /// Isack and Boykov, Energy-based geometric multi-model fitting, 2012; Delong et al., Fast approximate
    /// energy minimization with label costs, 2012.
    signature = (mesh, *, max_move=None, noise=None, regularize=None, free=true, fixed=None, faces=None),
        tolerance = 1e-3;
    pub fn restore(py: Python<'_>, solve, progress;
        mesh: &Mesh,
        max_move: Option<f64>,
        noise: Option<f64>,
        regularize: Option<f64>,
        free: bool,
        fixed: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Restored> {
        let (n, m) = (mesh.n_vertices(), mesh.n_faces());
        let options = tools::RestoreOptions {
            max_move,
            noise,
            regularize,
            free,
            fixed: arrays::mask("fixed", fixed, n, "vertex")?,
            faces: arrays::mask("faces", faces, m, "face")?,
            solve: solve()?,
        };
        let found = doorway::call(py, &progress, || tools::restore(mesh.inner(), &options, &progress))?;
        let surfaces = found.surfaces.iter().map(|piece| described(py, piece)).collect::<PyResult<Vec<_>>>()?;
        Ok(Restored {
            vertices: arrays::float_rows(py, &found.vertices)?.unbind(),
            labels: found.labels.into_pyarray(py).unbind(),
            surfaces: PyList::new(py, surfaces)?.unbind(),
            noise: found.noise,
            relations: found.relations,
            n_held: found.n_held,
            n_folded: found.n_folded,
            status: found.status.name(),
        })
    }
}
