//! `diffusion_curves` and `redraw`: the few curves that rebuild a painted surface, and the way back.

use numpy::ndarray::ArrayD;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use ridgeform_core::tools::{self, ColoredCurves};
use ridgeform_core::Error;

use crate::arrays::{self, finite_floats, shape_text};
use crate::columns::{self, Values};
use crate::doorway;
use crate::errors::{self, argument};
use crate::mesh::Mesh;
use crate::numbers::{at_least, at_least_if};
use crate::progress::{handle, Progress};

/// What `diffusion_curves` returns: curves with a color on each side, and the colors that they rebuild.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct DiffusionCurves {
    /// The vertices of every edge of the curves, (k,2) int32,
    /// one curve after another and each in its direction.
    edges: Py<PyArray2<i32>>,
    /// Where each curve starts among the edges, and last their number, (q+1,) int32.
    starts: Py<PyArray1<i32>>,
    /// The colors at the start and the end of every edge on its left, (k,2,c) float64: on the side of the
    /// face that runs from start to end. The region there has the smaller label.
    left: Py<PyAny>,
    /// The same on the right; at a rim, where there is no face on the right, those on the left.
    right: Py<PyAny>,
    /// A vertex for every piece of surface that no curve reaches, (j,) int32.
    points: Py<PyArray1<i32>>,
    /// Its color: the mean of the piece, (j,c) float64.
    point_colors: Py<PyAny>,
    /// The rebuilt colors, (n,c) float64. A vertex on a curve has that of its side,
    /// or the mean of its sides; one without faces 0.
    colors: Py<PyAny>,
    /// The rebuilt colors at the corners of the faces, (m,3,c) float64: across a curve they jump.
    corners: Py<PyAny>,
    /// The face whose side a vertex takes, (n,) int32; -1 for vertices that blend their sides,
    /// and for those without faces.
    sides: Py<PyArray1<i32>>,
    /// The region of every face, (m,) int32.
    labels: Py<PyArray1<i32>>,
    /// The mean squared error of `colors` over the area of the surface and the channels.
    error: f64,
    /// The same as a peak signal-to-noise ratio in decibels, for colors between 0 and 1;
    /// infinite without error.
    psnr: f64,
    /// How many numbers the curves are: two for each of their vertices (which it is, and its side), the
    /// colors, one more for each knot where `color_error` thins them, vertex and color of each point.
    n_numbers: usize,
    /// How many numbers they stand for: the entries of the colors given.
    n_numbers_before: usize,
}

#[pymethods]
impl DiffusionCurves {
    /// The vertices along every curve, a list of (j,) int32 arrays;
    /// the first vertex of a closed curve comes last again.
    #[getter]
    fn polylines<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray1<i32>>>> {
        let (edges, starts) = (self.edges.bind(py).to_vec()?, self.starts.bind(py).to_vec()?);
        let curve = |bounds: &[i32]| {
            let edges = &edges[2 * bounds[0] as usize..2 * bounds[1] as usize];
            let points = edges.iter().step_by(2).chain(edges.last()).copied();
            points.collect::<Vec<i32>>().into_pyarray(py)
        };
        Ok(starts.windows(2).map(curve).collect())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let n_curves = self.starts.bind(py).len()? - 1;
        Ok(format!(
            "<ridgeform.DiffusionCurves: {n_curves} curves, {} numbers for {}, {:.1} dB>",
            self.n_numbers, self.n_numbers_before, self.psnr
        ))
    }
}

/// The curves along the borders of regions, with a color on each side, that rebuild a painted surface.
///
/// The regions are those given, or else what `segment` finds with the colors as its signal and one norm for
/// all channels; their borders are then moved until no vertex beside them has the color of the other side.
/// On each piece of the surface cut open along the borders, min uᵀ L u + fidelity (u - colors)ᵀ M (u -
/// colors) is solved with the cotangent Laplacian L; its values at the borders are the colors of the curves,
/// and `redraw` rebuilds the surface from them. A vertex on a border counts for the side whose color is
/// nearest, and for none where it is nearer to their mean. All colors stay within the range of those given,
/// channel by channel.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// colors : (n,) or (n,c) array, a color a vertex, usually between 0 and 1
/// labels : (m,) array of whole numbers, the region of each face; None to find regions by their colors
/// n_regions, length_weight, min_faces : for finding regions: `n_segments`,
///     `length_weight` and `min_faces` of `segment`
/// face_groups : (m,) array of whole numbers ≥ 0 or None: faces with the same number, the triangles of a
///     polygon, are found in one region
/// fidelity : float > 0; colors are smoothed over a length of 1 / √fidelity times the square root of the
///     surface's area
/// rims : the rims of an open mesh are curves too, with the colors of their one side
/// refine : improve the colors of the curves by least squares until the rebuilt surface is closest to
///     `colors`
/// color_error : how much a color on a curve may change so that few of them have to be stored;
///     0 keeps one at every vertex
/// progress : Progress or None
///
/// Returns
/// -------
/// DiffusionCurves
///
/// Raises
/// ------
/// ArgumentError, MeshError (no face with area), SolveError (memory), Cancelled
///
/// References
/// ----------
/// Rowe et al. 2024, section 7.6, eqs. (26) and (27); Orzan et al. 2008.
#[pyfunction]
#[pyo3(signature = (mesh, colors, *, labels=None, n_regions=None, length_weight=0.5, min_faces=20,
    face_groups=None, fidelity=1e3, rims=false,
    refine=true, color_error=0.0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn diffusion_curves(
    py: Python<'_>,
    mesh: &Mesh,
    colors: &Bound<'_, PyAny>,
    labels: Option<&Bound<'_, PyAny>>,
    n_regions: Option<i64>,
    length_weight: f64,
    min_faces: i64,
    face_groups: Option<&Bound<'_, PyAny>>,
    fidelity: f64,
    rims: bool,
    refine: bool,
    color_error: f64,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<DiffusionCurves> {
    let colors = columns::read("colors", colors, mesh.n_vertices(), "vertex")?;
    let labels = labels.map(|given| read_labels(given, mesh.n_faces())).transpose()?;
    let groups = face_groups.map(|given| read_groups(given, mesh.n_faces())).transpose()?;
    let regions = tools::SegmentOptions {
        n_segments: at_least_if(py, "n_regions", n_regions, 1)?,
        length_weight,
        min_faces: Some(at_least(py, "min_faces", min_faces, 0)?),
        ..tools::SegmentOptions::default()
    };
    let options = tools::DiffusionCurvesOptions { fidelity, rims, refine, color_error };
    let progress = handle(progress);
    let (labels, found) = doorway::call(py, &progress, || {
        let labels = match labels {
            Some(labels) => labels,
            None => {
                let groups = groups.as_deref();
                tools::color_regions(mesh.inner(), &colors.columns, &regions, groups, fidelity, &progress)?
            }
        };
        let found = tools::diffusion_curves(mesh.inner(), &colors.columns, &labels, &options, &progress)?;
        Ok((labels, found))
    })?;
    let (single, k) = (colors.single, colors.columns.n_columns);
    let edges = found.curves.edges.len();
    let shaped = |data: Vec<f64>, rows: &[usize]| shaped(py, data, rows, k, single);
    Ok(DiffusionCurves {
        edges: arrays::index_rows(py, &found.curves.edges)?.unbind(),
        starts: found.starts.iter().map(|&s| s as i32).collect::<Vec<_>>().into_pyarray(py).unbind(),
        left: shaped(found.curves.left, &[edges, 2])?,
        right: shaped(found.curves.right, &[edges, 2])?,
        points: arrays::index_array(py, &found.curves.points)?.unbind(),
        point_colors: shaped(found.curves.point_colors, &[found.curves.points.len()])?,
        colors: columns::write(py, Values { columns: found.redrawn.colors, single }).unbind(),
        corners: shaped(found.redrawn.corners, &[mesh.n_faces(), 3])?,
        sides: write_sides(py, &found.sides),
        labels: labels.into_pyarray(py).unbind(),
        error: found.error,
        psnr: -10.0 * found.error.log10(),
        n_numbers: found.n_numbers,
        n_numbers_before: mesh.n_vertices() * k,
    })
}

/// What `redraw` returns: the colors of a surface between curves.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Redrawn {
    /// A color a vertex, (n,c) float64. A vertex on a curve has that of its side,
    /// else the mean of its sides; one without faces 0.
    colors: Py<PyAny>,
    /// The colors at the corners of the faces, (m,3,c) float64: across a curve they jump.
    corners: Py<PyAny>,
}

#[pymethods]
impl Redrawn {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<ridgeform.Redrawn: {} vertices>", self.colors.bind(py).len()?))
    }
}

/// Diffuse the colors of curves over a surface: Laplace's equation between them.
///
/// The mesh is cut open along the curves, and each side of a curve keeps its own colors. Curves may end
/// anywhere, and where they meet the colors that they give to the same side are averaged. No color leaves the
/// range of those given, channel by channel.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// edges : (k,2) array, vertices that an edge of the mesh joins
/// left : (k,2) or (k,2,c) array, the colors at the start and the end of each edge on its left: on the side
///     of the face that runs from start to end; not used where there is none
/// right : array of the same shape, the same on the right
/// points : (j,) array of vertices with a color of their own, away from the curves, or None
/// point_colors : (j,) or (j,c) array, or None
/// sides : (n,) array, the face whose side each vertex takes in `Redrawn.colors` (`DiffusionCurves.sides`),
///     -1 or None for the mean of its sides
/// progress : Progress or None
///
/// Returns
/// -------
/// Redrawn
///
/// Raises
/// ------
/// ArgumentError (also for a piece of surface that neither a curve nor a point reaches),
/// SolveError (memory), Cancelled
///
/// References
/// ----------
/// Rowe et al. 2024, eq. (26); Orzan et al. 2008.
#[pyfunction]
#[pyo3(signature = (mesh, edges, left, right, *, points=None, point_colors=None, sides=None, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn redraw(
    py: Python<'_>,
    mesh: &Mesh,
    edges: &Bound<'_, PyAny>,
    left: &Bound<'_, PyAny>,
    right: &Bound<'_, PyAny>,
    points: Option<&Bound<'_, PyAny>>,
    point_colors: Option<&Bound<'_, PyAny>>,
    sides: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Redrawn> {
    let edges = read_edges(edges, mesh.n_vertices())?;
    let (left, channels) = read_colors("left", left, &[edges.len(), 2])?;
    let (right, same) = read_colors("right", right, &[edges.len(), 2])?;
    if same != channels {
        return Err(argument(py, "right", "needs the shape of left"));
    }
    let points =
        points.map(|given| arrays::indices("points", given, mesh.n_vertices(), "vertex")).transpose()?;
    let points: Vec<u32> = points.unwrap_or_default().into_iter().map(|v| v as u32).collect();
    let point_colors = match point_colors {
        None => Vec::new(),
        Some(given) => {
            let (data, same) = read_colors("point_colors", given, &[points.len()])?;
            if same != channels {
                return Err(argument(py, "point_colors", "needs as many channels as left"));
            }
            data
        }
    };
    let sides = sides.map(|given| read_sides(given, mesh)).transpose()?;
    let (single, n_channels) = (channels.is_none(), channels.unwrap_or(1));
    let curves = ColoredCurves { edges, n_channels, left, right, points, point_colors };
    let progress = handle(progress);
    let redrawn =
        doorway::call(py, &progress, || tools::redraw(mesh.inner(), &curves, sides.as_deref(), &progress))?;
    Ok(Redrawn {
        colors: columns::write(py, Values { columns: redrawn.colors, single }).unbind(),
        corners: shaped(py, redrawn.corners, &[mesh.n_faces(), 3], n_channels, single)?,
    })
}

/// Places for curves on a surface that are smooth lines, to be looked at.
///
/// Curves run along edges of the mesh, with saw teeth where the mesh is irregular. Each place is at most 0.6
/// mean edges of its curves away from its vertex, on the surface. Ends of curves and vertices on the rim of
/// the mesh stay.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// edges : (k,2) array, the edges of curves (`DiffusionCurves.edges`)
///
/// Returns
/// -------
/// (k,2,3) array, places of the start and the end of every edge; those of one vertex are the same
///
/// Raises
/// ------
/// ArgumentError, MeshError (no positions)
///
/// References
/// ----------
/// Taubin 1995 (Laplacian smoothing), with bounded steps.
#[pyfunction]
pub(crate) fn smooth_curves(py: Python<'_>, mesh: &Mesh, edges: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    let edges = read_edges(edges, mesh.n_vertices())?;
    let places = doorway::call_briefly(py, || tools::smooth_curves(mesh.inner(), &edges))?;
    let data = places.into_iter().flatten().flatten().collect();
    shaped(py, data, &[edges.len(), 2], 3, false)
}

fn read_labels(object: &Bound<'_, PyAny>, n_faces: usize) -> PyResult<Vec<i32>> {
    of_faces(object, n_faces, "labels", "too large for 32 bits")
}

fn read_groups(object: &Bound<'_, PyAny>, n_faces: usize) -> PyResult<Vec<u32>> {
    of_faces(object, n_faces, "face_groups", "not from 0 to 2^32 - 1")
}

/// A number for each face; one that does not fit is named and said to be `what`.
fn of_faces<T>(object: &Bound<'_, PyAny>, n_faces: usize, name: &'static str, what: &str) -> PyResult<Vec<T>>
where
    T: TryFrom<i64>,
{
    let py = object.py();
    let numbers = arrays::integers(name, object)?.exactly(py, name, n_faces, "face")?;
    let narrow =
        |&number: &i64| T::try_from(number).map_err(|_| argument(py, name, format!("{number} is {what}")));
    numbers.iter().map(narrow).collect()
}

fn read_edges(object: &Bound<'_, PyAny>, n_vertices: usize) -> PyResult<Vec<[u32; 2]>> {
    let py = object.py();
    let rows = arrays::integers("edges", object)?.rows::<2>(py, "edges")?;
    let vertex = |row: usize, v: i64| {
        u32::try_from(v).ok().filter(|&v| (v as usize) < n_vertices).ok_or_else(|| {
            let problem = format!("row {row}: vertex {v} does not exist: there are {n_vertices}");
            errors::exception(py, &Error::argument("edges", problem))
        })
    };
    rows.iter().enumerate().map(|(row, &[a, b])| Ok([vertex(row, a)?, vertex(row, b)?])).collect()
}

/// Colors of shape `rows` (no channels: none) or `rows` and channels.
fn read_colors(
    name: &'static str,
    object: &Bound<'_, PyAny>,
    rows: &[usize],
) -> PyResult<(Vec<f64>, Option<usize>)> {
    let numbers = finite_floats(name, object)?;
    let shape = &numbers.shape;
    if shape == rows {
        return Ok((numbers.data, None));
    }
    if shape.len() == rows.len() + 1 && shape[..rows.len()] == *rows && shape[rows.len()] > 0 {
        return Ok((numbers.data, Some(shape[rows.len()])));
    }
    let expected = rows.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let problem = format!("expected shape ({expected}, c), got {}", shape_text(shape));
    Err(argument(object.py(), name, problem))
}

fn read_sides(object: &Bound<'_, PyAny>, mesh: &Mesh) -> PyResult<Vec<Option<u32>>> {
    let py = object.py();
    let faces = arrays::integers("sides", object)?.exactly(py, "sides", mesh.n_vertices(), "vertex")?;
    let face = |&f: &i64| match u32::try_from(f) {
        Ok(f) => Ok(Some(f)),
        Err(_) if f == -1 => Ok(None),
        Err(_) => Err(argument(py, "sides", format!("{f} is no face; use -1 for none"))),
    };
    faces.iter().map(face).collect()
}

fn write_sides(py: Python<'_>, sides: &[Option<u32>]) -> Py<PyArray1<i32>> {
    let faces: Vec<i32> = sides.iter().map(|side| side.map_or(-1, u32::cast_signed)).collect();
    faces.into_pyarray(py).unbind()
}

/// A fresh C-contiguous array of shape `rows` and `k` channels,
/// or of shape `rows` where colors are single numbers.
fn shaped(py: Python<'_>, data: Vec<f64>, rows: &[usize], k: usize, single: bool) -> PyResult<Py<PyAny>> {
    let mut shape = rows.to_vec();
    if !single {
        shape.push(k);
    }
    let array =
        ArrayD::from_shape_vec(shape, data).map_err(|error| errors::internal(py, &error.to_string()))?;
    Ok(array.into_pyarray(py).into_any().unbind())
}
