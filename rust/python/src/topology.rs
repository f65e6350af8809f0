//! `weld` and `orient`: a mesh made one surface whose faces agree, as the tools do inside.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::mesh::{orient as orient_faces, Connectivity, Weld};
use ridgeform_core::unit::Unit;

use crate::arrays::{finite_floats, float_rows, index_array, index_rows};
use crate::doorway;
use crate::errors::argument;
use crate::mesh::read_faces;

/// Join the sides of split seams: vertices on open borders (edges with one face) that lie in one place.
///
/// Parameters
/// ----------
/// vertices : (n,3), any length unit
/// faces : (m,3) vertex indices
/// tolerance : float ≥ 0, by how much each coordinate may differ; None for the rounding of the coordinates: a
///     hundred-thousandth of the size of the borders, as files of six digits have it, or four units in the
///     last place (of float32 where all coordinates fit in it), but a tenth of the shortest border edge there
///     at most
///
/// Returns
/// -------
/// vertices : (k,3) float64, the first of those that are one, in the order of the input and with its bits
/// faces : (m,3) int32, as many and in the order of the input;
///     one whose corners became one names a vertex twice
/// index : (n,) int32, the welded vertex of every vertex: `faces` is `index[input faces]`
///
/// Raises
/// ------
/// ArgumentError, MeshError (faces that name missing vertices).
#[pyfunction]
#[pyo3(signature = (vertices, faces, *, tolerance=None))]
#[allow(clippy::type_complexity)]
pub(crate) fn weld<'py>(
    py: Python<'py>,
    vertices: &Bound<'py, PyAny>,
    faces: &Bound<'py, PyAny>,
    tolerance: Option<f64>,
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i32>>, Bound<'py, PyArray1<i32>>)> {
    if let Some(tolerance) = tolerance.filter(|t| !(*t >= 0.0 && t.is_finite())) {
        return Err(argument(
            py,
            "tolerance",
            format!("is {tolerance}; it must be at least 0, or None for rounding"),
        ));
    }
    let vertices = finite_floats("vertices", vertices)?.rows::<3>(py, "vertices")?;
    let faces = read_faces(faces, Some(vertices.len()))?;
    let (vertices, faces, index) = doorway::call_briefly(py, || {
        let connectivity = Connectivity::new(faces, vertices.len())?;
        let unit = Unit::of(vertices.iter().flatten().copied());
        let measured = unit.measure_all(vertices.as_flattened());
        let tolerance = tolerance.map(|tolerance| unit.measure(tolerance));
        Ok(match Weld::of_seams(&connectivity, measured.as_chunks().0, tolerance)? {
            Some(weld) => (weld.firsts(&vertices)?, weld.faces(connectivity.faces())?, weld.vertex),
            None => {
                let index = (0..vertices.len() as u32).collect();
                (vertices, connectivity.faces().to_vec(), index)
            }
        })
    })?;
    Ok((float_rows(py, &vertices)?, index_rows(py, &faces)?, index_array(py, &index)?))
}

/// Turn faces over so that neighbors agree on which side is outside.
///
/// In each part of the surface connected across edges the smaller number of faces is turned, of two equal
/// numbers those that do not agree with its first face. Across edges with three faces or more nothing is
/// compared; a surface with one side only, as a Möbius strip, keeps a line along which faces disagree.
///
/// Parameters
/// ----------
/// faces : (m,3) vertex indices
///
/// Returns
/// -------
/// faces : (m,3) int32, in the order of the input; turned ones have their last two corners swapped
/// flipped : (m,) bool, which were turned
///
/// Raises
/// ------
/// ArgumentError.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub(crate) fn orient<'py>(
    py: Python<'py>,
    faces: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyArray2<i32>>, Bound<'py, PyArray1<bool>>)> {
    let faces = read_faces(faces, None)?;
    let n_vertices = faces.iter().flatten().map(|&v| v as usize + 1).max().unwrap_or(0);
    let (faces, flipped) = doorway::call_briefly(py, || orient_faces(faces, n_vertices))?;
    Ok((index_rows(py, &faces)?, flipped.into_pyarray(py)))
}
