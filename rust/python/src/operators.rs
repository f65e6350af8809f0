//! The intrinsic operators, as functions of a mesh.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use ridgeform_core::memory::Tool;
use ridgeform_core::{intrinsic, mesh as core, operators};

use crate::arrays::index_array;
use crate::matrix::SparseMatrix;
use crate::mesh::Mesh;
use crate::{columns, doorway, options};

/// The surface Hessian H = M_F T C G, a SparseMatrix (4m,n): rows xx, xy, yx, yy per face,
/// times the face's area.
///
/// The face's frame has its x axis from corner 0 to corner 1. The entries have no unit: scaling the mesh
/// changes nothing. `dual`: "barycentric" dual edges, "circumcentric" ones, which raise MeshError where one
/// has no length, or "circumcentric_or_barycentric", which takes barycenters for such edges.
///
/// Source: Rowe et al. 2024, eq. (30).
#[pyfunction]
#[pyo3(signature = (mesh, *, dual="barycentric"))]
pub(crate) fn hessian(py: Python<'_>, mesh: &Mesh, dual: &str) -> PyResult<SparseMatrix> {
    let dual = options::dual(py, dual)?;
    let matrix = doorway::call_sized(py, mesh.inner().demand(Tool::Hessian), || {
        operators::hessian(mesh.inner(), dual)
    })?;
    SparseMatrix::new(py, matrix)
}

/// The Frobenius norm of every face's Hessian, not times its area, (m,) float64, of values (n,) or (n,k).
///
/// Several columns share one norm a face (joint), as with the three coordinates of a surface. The unit is
/// that of the values over a squared length. Raises ArgumentError for values of another shape, MeshError as
/// `hessian`.
///
/// Source: Rowe et al. 2024, section 5.
#[pyfunction]
#[pyo3(signature = (mesh, values, *, dual="barycentric"))]
pub(crate) fn hessian_norm<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    values: &Bound<'py, PyAny>,
    dual: &str,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let dual = options::dual(py, dual)?;
    let values = columns::read("values", values, mesh.n_vertices(), "vertex")?.columns;
    let demand = mesh.inner().demand(Tool::Energy).with_columns(values.n_columns, false);
    let norms =
        doorway::call_sized(py, demand, || operators::hessian_norm(mesh.inner(), &values.data, dual))?;
    Ok(norms.into_pyarray(py))
}

/// The energy of values u, (n,) or (n,k).
///
/// Several columns share one norm a face, edge or entry (joint); the quadratic energies of columns add up.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// values : (n,) or (n,k) array, one row for each vertex
/// kind : which energy:
///     "l1_hessian"            Σ_f A_f ‖H_f(u)‖, in the unit of the values: Rowe et al. 2024, eq. (18)
///     "l2_hessian"            ½ ∫ ‖H_u‖² in space, natural boundary conditions: Stein et al. 2018b
///     "l2_curved_hessian"     ½ ∫ ‖∇du‖² + κ |du|², intrinsic, natural boundary conditions:
///     Stein et al. 2020a
///     "l2_laplacian"          ½ ∫ |Δu|², zero Neumann boundary conditions
///     "l1_hessian_stein2018"  Σ |entries| of the Hessian in space, depends on the axes: Stein et al. 2018b
///     "l1_edge_laplacian"     Σ_e |D(e) u|, the area-based edge operator: He and Schaefer 2013
/// face_weights : (m,) array, 1 where None; energies on vertices and edges take the mean of the faces around
///     them
/// dual : dual edges of "l1_hessian": "barycentric", "circumcentric" or "circumcentric_or_barycentric"
///
/// Raises
/// ------
/// ArgumentError; MeshError as `hessian`, and for energies in space of a mesh without positions
#[pyfunction]
#[pyo3(signature = (mesh, values, *, kind="l1_hessian", face_weights=None, dual="barycentric"))]
pub(crate) fn energy(
    py: Python<'_>,
    mesh: &Mesh,
    values: &Bound<'_, PyAny>,
    kind: &str,
    face_weights: Option<&Bound<'_, PyAny>>,
    dual: &str,
) -> PyResult<f64> {
    let (energy, dual) = (options::energy(py, "kind", kind)?, options::dual(py, dual)?);
    let weights = options::weights("face_weights", face_weights, mesh.n_faces(), "face")?;
    let values = columns::read("values", values, mesh.n_vertices(), "vertex")?.columns;
    let demand = mesh.inner().demand(Tool::Energy).with_columns(values.n_columns, false);
    doorway::call_sized(py, demand, || {
        operators::energy(energy, mesh.inner(), &values.data, weights.as_deref(), dual)
    })
}

/// The mixed Voronoi area of every vertex, (n,) float64: the diagonal of the lumped mass matrix;
/// they sum to the total area.
///
/// Source: Meyer et al. 2003, section 3.3.
#[pyfunction]
pub(crate) fn voronoi_mass<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let mesh = mesh.inner();
    let mass = doorway::call_sized(py, mesh.demand(Tool::Report), || operators::mass_of(mesh))?;
    Ok(mass.into_pyarray(py))
}

/// The cotangent Laplacian, a SparseMatrix (n,n), symmetric and positive semidefinite, without unit;
/// its rows sum to 0.
///
/// Source: Pinkall and Polthier 1993.
#[pyfunction]
pub(crate) fn cotangent_laplacian(py: Python<'_>, mesh: &Mesh) -> PyResult<SparseMatrix> {
    let mesh = mesh.inner();
    let matrix = doorway::call_sized(py, mesh.demand(Tool::Laplacian), || {
        operators::cotangent_laplacian(mesh.connectivity(), mesh.measured(mesh.unit())?.edge_lengths())
    })?;
    SparseMatrix::new(py, matrix)
}

/// The intrinsic Delaunay triangulation: a Mesh with the same vertices, flipped faces,
/// edge lengths and no positions.
///
/// Source: Bobenko and Springborn 2007; Rowe et al. 2024, section 6.1.
#[pyfunction]
pub(crate) fn intrinsic_delaunay(py: Python<'_>, mesh: &Mesh) -> PyResult<Mesh> {
    let mesh = mesh.inner();
    let flipped = doorway::call_sized(py, mesh.demand(Tool::Delaunay), || {
        let (unit, connectivity) = (mesh.unit(), mesh.connectivity());
        let (connectivity, mut lengths, _) =
            intrinsic::delaunay_flips(connectivity, mesh.measured(unit)?.edge_lengths())?;
        unit.restore_all(lengths.iter_mut().flatten());
        core::Mesh::from_connectivity(connectivity, lengths)
    })?;
    Ok(Mesh::new(flipped))
}

/// The boundary loops, a list of (k,) int32 arrays of vertex indices in the direction of the faces'
/// halfedges.
#[pyfunction]
pub(crate) fn boundary_loops<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Vec<Bound<'py, PyArray1<i32>>>> {
    let demand = mesh.inner().demand(Tool::FindHoles);
    let loops = doorway::call_sized(py, demand, || core::boundary_loops(mesh.inner().connectivity()))?;
    loops.iter().map(|vertices| index_array(py, vertices)).collect()
}
