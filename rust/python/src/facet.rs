//! `facet`: a mesh as flat polygons with straight ridges.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::tools::{self, FacetMerges, FacetOptions, Symmetric};

use crate::mesh::Mesh;
use crate::numbers::at_least_if;
use crate::progress::{handle, Progress};
use crate::{arrays, doorway, options};

/// What `facet` returns: a mesh of flat polygons, and what of the other mesh each is.
#[pyclass(frozen, module = "ridgeform")]
pub struct Faceted {
    /// The corners of the facets, (v,3) float64, in the mesh's unit.
    #[pyo3(get)]
    vertices: Py<PyArray2<f64>>,
    /// The vertex of the mesh where each vertex comes from, (v,) int32.
    #[pyo3(get)]
    origins: Py<PyArray1<i32>>,
    /// The vertices of the polygons, one after the other, (l,) int32, counterclockwise seen from outside.
    #[pyo3(get)]
    polygon_vertices: Py<PyArray1<i32>>,
    /// Where each polygon starts among `polygon_vertices`, and at the end l, (p+1,) int32.
    #[pyo3(get)]
    polygon_starts: Py<PyArray1<i32>>,
    /// The facet of each polygon, (p,) int32; a facet with holes is several polygons.
    #[pyo3(get)]
    polygon_facets: Py<PyArray1<i32>>,
    /// The same surface as triangles, (t,3) int32.
    #[pyo3(get)]
    faces: Py<PyArray2<i32>>,
    /// The facet of each triangle, (t,) int32.
    #[pyo3(get)]
    face_facets: Py<PyArray1<i32>>,
    /// The facet nearest to each face of the mesh, (m,) int32; -1 for faces that name a vertex twice.
    #[pyo3(get)]
    labels: Py<PyArray1<i32>>,
    /// The plane of each facet, (k,4) float64: a unit normal that points outside,
    /// and the distance from the origin along it.
    #[pyo3(get)]
    planes: Py<PyArray2<f64>>,
    /// Number of facets that were made; `planes` has further ones for faces that were to stay.
    #[pyo3(get)]
    n_facets: usize,
    /// Root mean square distance from the mesh's faces to the facets.
    #[pyo3(get)]
    rms: f64,
    /// The largest distance from the middle of a face to the facets.
    #[pyo3(get)]
    largest: f64,
    /// Pairs of facets that pass through each other and do not on the mesh.
    #[pyo3(get)]
    n_crossings: usize,
    /// With `keep_triangles` the mesh's vertices on the facets, (n,3) float64; else None.
    #[pyo3(get)]
    kept_vertices: Option<Py<PyArray2<f64>>>,
    /// With `keep_triangles` the mesh's faces, (m,3) int32, by the corner of the mesh, `3 f + i`, that each
    /// of their corners was: `mesh.faces.ravel()[kept_corners]` names the vertices; else None.
    #[pyo3(get)]
    kept_corners: Option<Py<PyArray2<i32>>>,
    /// Edges of these faces that were flipped, since they would have folded.
    #[pyo3(get)]
    n_flipped: usize,
    /// Faces that are folded, no more than a line, or not on their facet, all the same.
    #[pyo3(get)]
    n_folded: usize,
    /// "solved", or "stopped" (`Progress.finish` was called).
    #[pyo3(get)]
    status: &'static str,
    mesh: Py<Mesh>,
    options: FacetOptions,
    merges: FacetMerges,
}

#[pymethods]
impl Faceted {
    /// The same mesh with another number of facets: fast, since the order in which faces merge is known.
    ///
    /// Parameters
    /// ----------
    /// facets, error, progress : as of `facet`
    ///
    /// Returns
    /// -------
    /// Faceted
    ///
    /// Raises
    /// ------
    /// ArgumentError, Cancelled
    #[pyo3(signature = (*, facets=None, error=None, progress=None))]
    fn at(
        &self,
        py: Python<'_>,
        facets: Option<i64>,
        error: Option<f64>,
        progress: Option<&Bound<'_, Progress>>,
    ) -> PyResult<Self> {
        let facets = at_least_if(py, "facets", facets, 1)?;
        let options = FacetOptions { facets, error, ..self.options.clone() };
        run(py, self.mesh.clone_ref(py), Some(&self.merges), options, progress)
    }

    fn __repr__(&self) -> String {
        let crossing =
            if self.n_crossings > 0 { format!(", {} crossing", self.n_crossings) } else { String::new() };
        format!(
            "<ridgeform.Faceted: {} facets, RMS distance {:.3e}{crossing}, {}>",
            self.n_facets, self.rms, self.status
        )
    }
}

const SYMMETRIC: [(&str, Symmetric); 4] = [
    ("x", Symmetric::Across(0)),
    ("y", Symmetric::Across(1)),
    ("z", Symmetric::Across(2)),
    ("auto", Symmetric::Found),
];

fn run(
    py: Python<'_>,
    mesh: Py<Mesh>,
    merges: Option<&FacetMerges>,
    options: FacetOptions,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Faceted> {
    let progress = handle(progress);
    let inner = mesh.get().inner();
    let found = doorway::call(py, &progress, || tools::facet(inner, merges, &options, &progress))?;
    let kept = found.kept.as_ref();
    let mut starts = vec![0];
    found.polygons.iter().for_each(|polygon| starts.push(starts[starts.len() - 1] + polygon.len() as u32));
    Ok(Faceted {
        vertices: arrays::float_rows(py, &found.vertices)?.unbind(),
        origins: arrays::index_array(py, &found.origins)?.unbind(),
        polygon_vertices: arrays::index_array(py, &found.polygons.concat())?.unbind(),
        polygon_starts: arrays::index_array(py, &starts)?.unbind(),
        polygon_facets: arrays::index_array(py, &found.polygon_facets)?.unbind(),
        faces: arrays::index_rows(py, &found.faces)?.unbind(),
        face_facets: arrays::index_array(py, &found.face_facets)?.unbind(),
        labels: found.labels.into_pyarray(py).unbind(),
        planes: arrays::float_rows(py, &found.planes)?.unbind(),
        n_facets: found.n_facets,
        rms: found.rms,
        largest: found.largest,
        n_crossings: found.n_crossings,
        kept_vertices: kept
            .map(|kept| arrays::float_rows(py, &kept.vertices))
            .transpose()?
            .map(Bound::unbind),
        kept_corners: kept.map(|kept| arrays::index_rows(py, &kept.corners)).transpose()?.map(Bound::unbind),
        n_flipped: kept.map_or(0, |kept| kept.n_flipped),
        n_folded: kept.map_or(0, |kept| kept.n_folded),
        status: found.status.name(),
        mesh,
        options,
        merges: found.merges,
    })
}

/// Make a mesh of flat polygons with straight ridges, as a low-poly artist models.
///
/// Faces merge into regions, always those that lie best on one plane, as long as the regions can be the
/// facets of a polyhedron. Then planes and corners are found together, so that every corner lies on the
/// planes of all its facets, and faces and planes take turns until the planes are nearest. Facets that would
/// cross are repaired, divided, or not made; what is closed stays closed. `stylize` first where the mesh is
/// round: it decides where the ridges run.
///
/// Parameters
/// ----------
/// mesh : Mesh with positions
/// facets : number of facets wanted, or None: as `error` has it. It is met unless the shape has no fewer, or
///     so few would pass through each other: there are more then
/// error : root mean square distance from the mesh that is allowed, in its unit, or None: as many facets as
///     the faces give evidence for (Bayesian information criterion), at most as many as it takes for every
///     facet to be within 0.5 % of the diagonal of the bounding box
/// edge_weights : (m,3) array ≥ 0, what borders of facets cost along edges, column i opposite corner i: 1 is
///     neutral, smaller attracts them; the smaller entry of both faces counts
/// faces : faces to make facets of, (m,) booleans or (j,) indices; None for all. The others,
///     and all vertices of theirs, stay
/// keep_triangles : whether the mesh's own vertices and faces are wanted on the facets as well, every vertex
///     on its facet's plane, its ridge or its corner (`kept_vertices`, `kept_corners`). Facets are regions of
///     the mesh then, and `labels` says which face is in which
/// keep_volume : whether the facets are to enclose the volume that the mesh does, which must be closed:
///     planes move outward by the same distance
/// symmetric : "x", "y" or "z", the axis across which the mesh is symmetric, "auto" for the first that it is
///     symmetric across, or None: facets are found on one half, and mirrored. The plane goes through the
///     origin or the middle of the bounding box; not with `faces`, `keep_triangles` or `keep_volume`
/// coarse_to_fine : whether facets of a large mesh are found on a coarser one, many times as fast and about
///     as near: None for meshes of 18,000 vertices and more, True from 9000 on, False never. More vertices
///     are kept where more facets are wanted or found. A polyhedron with sharp edges is done on all of its
///     faces, as is all that has `faces`, `edge_weights`, `keep_triangles`, `keep_volume` or `symmetric`
/// threads : int or None
/// progress : Progress or None
///
/// Returns
/// -------
/// Faceted
///
/// Raises
/// ------
/// ArgumentError (`keep_volume` of a mesh that is open, too), MeshError (no positions, no face with area),
/// MemoryLimitError, Cancelled
///
/// References
/// ----------
/// Merging: Garland, Willmott and Heckbert, Hierarchical face clustering on polygonal surfaces, 2001. Faces
/// and planes in turns: Cohen-Steiner, Alliez and Desbrun, Variational shape approximation, 2004.
#[pyfunction]
#[pyo3(signature = (mesh, *, facets=None, error=None, edge_weights=None, faces=None,
    keep_triangles=false, keep_volume=false, symmetric=None, coarse_to_fine=None, threads=None,
    progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn facet(
    py: Python<'_>,
    mesh: &Bound<'_, Mesh>,
    facets: Option<i64>,
    error: Option<f64>,
    edge_weights: Option<&Bound<'_, PyAny>>,
    faces: Option<&Bound<'_, PyAny>>,
    keep_triangles: bool,
    keep_volume: bool,
    symmetric: Option<&str>,
    coarse_to_fine: Option<bool>,
    threads: Option<i64>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Faceted> {
    let m = mesh.get().n_faces();
    let options = FacetOptions {
        facets: at_least_if(py, "facets", facets, 1)?,
        error,
        edge_weights: options::edge_weights(py, edge_weights)?,
        faces: arrays::mask("faces", faces, m, "face")?,
        keep_triangles,
        keep_volume,
        symmetric: symmetric.map(|word| options::choice(py, "symmetric", word, &SYMMETRIC)).transpose()?,
        levels: options::levels(coarse_to_fine),
        threads: at_least_if(py, "threads", threads, 1)?,
    };
    run(py, mesh.clone().unbind(), None, options, progress)
}
