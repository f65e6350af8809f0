//! `trace_curves`: lines drawn over a surface, as paths along its edges.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use ridgeform_core::tools;

use crate::arrays;
use crate::doorway;
use crate::errors::argument;
use crate::mesh::Mesh;

/// The vertices of all paths, where each path starts among them, and the places.
type Traced<'py> = (Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<f64>>);

/// Paths along the edges of a mesh that follow lines drawn on or near it.
///
/// Every point goes to the nearest corner of the nearest face; between them runs the shortest path that keeps
/// to the line. Steps forth and back over one edge are left out.
///
/// Parameters
/// ----------
/// mesh : Mesh with positions
/// points : (p,3) array, the points of all lines, one line after another
/// starts : (q+1,) array, where each line starts among the points, and last their number; None for one line
/// closed : (q,) array of booleans, lines that return to their first point; None for none
///
/// Returns
/// -------
/// (vertices, starts, places) : the vertices along the paths (k,) int32,
/// where each path starts among them (q+1,) int32, and where
///     on its line each vertex lies (k,) float64: i + t between point i of the line and the next. The first
///     vertex of a closed path does not come last again
///
/// Raises
/// ------
/// ArgumentError (also for two points in a row on parts that no edges join), MeshError
///
/// References
/// ----------
/// Dijkstra 1959.
#[pyfunction]
#[pyo3(signature = (mesh, points, *, starts=None, closed=None))]
pub(crate) fn trace_curves<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    points: &Bound<'py, PyAny>,
    starts: Option<&Bound<'py, PyAny>>,
    closed: Option<&Bound<'py, PyAny>>,
) -> PyResult<Traced<'py>> {
    let points = arrays::floats("points", points)?.rows::<3>(py, "points")?;
    let starts = match starts {
        None => vec![0, points.len()],
        Some(given) => arrays::indices("starts", given, points.len() + 1, "point")?,
    };
    if starts.first() != Some(&0)
        || starts.last() != Some(&points.len())
        || starts.windows(2).any(|s| s[0] > s[1])
    {
        let problem = format!("must ascend from 0 to the number of points, {}", points.len());
        return Err(argument(py, "starts", problem));
    }
    let n = starts.len() - 1;
    let closed = arrays::mask("closed", closed, n, "line")?.unwrap_or_else(|| vec![false; n]);
    let lines: Vec<_> =
        starts.windows(2).zip(closed).map(|(s, closed)| (points[s[0]..s[1]].to_vec(), closed)).collect();
    let traced = doorway::call_briefly(py, || tools::trace_curves(mesh.inner(), &lines))?;
    let mut ends = vec![0];
    for curve in &traced {
        ends.push(ends.last().copied().unwrap_or_default() + curve.vertices.len() as u32);
    }
    let vertices: Vec<u32> = traced.iter().flat_map(|curve| curve.vertices.iter().copied()).collect();
    let places: Vec<f64> = traced.iter().flat_map(|curve| curve.places.iter().copied()).collect();
    Ok((arrays::index_array(py, &vertices)?, arrays::index_array(py, &ends)?, places.into_pyarray(py)))
}
