//! `memory_available` and `memory_estimate`: what is free, and what a call would take.

use pyo3::prelude::*;
use ridgeform_core::memory::{self, Demand, Tool};
use ridgeform_core::tools;

use crate::doorway;
use crate::errors::argument;
use crate::mesh::Mesh;
use crate::numbers::{at_least, at_least_if};
use crate::options;

/// Bytes that this process may still take: what the machine has free, and on Linux what is left under the
/// limits of its control groups, of `ulimit -v` and of `ulimit -d`.
///
/// Without `memory_limit` a call takes at most 80 % of it.
#[pyfunction]
pub(crate) fn memory_available() -> usize {
    memory::available()
}

/// Bytes that a call would take at its peak, besides what is there already, about: within a quarter on meshes
/// that are about as wide as long.
///
/// Parameters
/// ----------
/// tool : the name of a function of this package, "mesh" or "report"; for quadratic energies
///     "denoise_quadratic", "interpolate_quadratic" and "vibration_modes_quadratic"
/// mesh : Mesh, or its numbers of vertices and faces; for "fill_holes" a Mesh,
///     since it is the longest hole that counts
/// columns : columns of the values, ≥ 1; for "vibration_modes" the number of modes
/// solver : as the tool takes it
/// longest : for "fill_holes", the edges of the longest hole that is filled, or None: of all of the Mesh
///
/// Raises
/// ------
/// ArgumentError
#[pyfunction]
#[pyo3(signature = (tool, mesh, *, columns=1, solver="auto", longest=None))]
pub(crate) fn memory_estimate(
    py: Python<'_>,
    tool: &str,
    mesh: &Bound<'_, PyAny>,
    columns: i64,
    solver: &str,
    longest: Option<i64>,
) -> PyResult<usize> {
    let tool = options::choice(py, "tool", tool, &Tool::ALL)?;
    let (n_vertices, n_faces) = match mesh.cast::<Mesh>() {
        Ok(mesh) => (mesh.get().n_vertices(), mesh.get().n_faces()),
        Err(_) => mesh
            .extract::<(usize, usize)>()
            .map_err(|_| argument(py, "mesh", "expected a Mesh or its numbers of vertices and faces"))?,
    };
    let n_columns = at_least(py, "columns", columns, 1)?;
    let solver = options::solver(py, solver)?;
    let longest = at_least_if(py, "longest", longest, 1)?;
    let demand = match mesh.cast::<Mesh>() {
        Ok(mesh) if tool == Tool::FillHoles => {
            let mesh = mesh.get().inner();
            doorway::call_briefly(py, || tools::filling_demand(mesh, longest))?
        }
        _ => Demand::new(tool, n_vertices, n_faces),
    };
    Ok(demand.with_columns(n_columns, solver.is_clarabel()).estimate())
}
