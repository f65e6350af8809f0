//! `parts`: limbs, heads and handles.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::tools::{self, Hierarchy};

use crate::mesh::Mesh;
use crate::nested::nested_divisions;
use crate::numbers::at_least_if;
use crate::progress::{handle, Progress};
use crate::{arrays, doorway, options};

/// What `parts` returns: a label for every face, and finer and coarser divisions nested with it.
#[pyclass(frozen, module = "ridgeform")]
pub struct Parts {
    /// The part of each face, (m,) int32, from 0 in the order of their first faces; -1 for faces that took
    /// no part.
    #[pyo3(get)]
    labels: Py<PyArray1<i32>>,
    /// Number of parts.
    #[pyo3(get)]
    n_parts: usize,
    /// The vertices of the edges between parts, (k,2) int32.
    #[pyo3(get)]
    boundary_edges: Py<PyArray2<i32>>,
    /// "solved", or "stopped" (`Progress.finish` was called: then with fewer parts at most).
    #[pyo3(get)]
    status: &'static str,
    hierarchy: Hierarchy,
}

nested_divisions! { Parts, n_parts, "parts";
    /// What the cuts cost that make two parts of one, three of two, and so on, float64. They come in the
    /// order of how much they are worth, which grows with the areas that they part: not ascending.
    #[getter]
    fn costs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let costs: Vec<f64> =
            self.hierarchy.strengths().iter().rev().map(|strength| 1.0 / strength).collect();
        costs.into_pyarray(py)
    }
}

/// Divide the faces into the parts that people name: limbs, heads, handles.
///
/// People cut where a closed curve is short against what it cuts off, and runs through hollows (minima rule)
/// or where the thickness changes. A cut costs the length of its border, in hollows and at changes of
/// thickness down to a tenth of it, over the 0.7th power of the area of the smaller side, in units of the
/// whole area. The part with the cheapest cut is divided, over and over; where fewer parts are wanted, those
/// become one that lose least: the logarithm of how cheap their cut is, times the product of their areas. The
/// count found is the one with the fewest pairs of points that people are expected to see otherwise. Any mesh
/// will do: seams are joined, vertices at the very same place count as one, faces are turned to agree, pieces
/// that nothing joins are parts or belong to what lies nearest. For the faces of what is plane or evenly
/// curved use `segment`.
///
/// Parameters
/// ----------
/// mesh : Mesh with positions
/// n_parts : number of parts wanted, or None: as `coarseness` has it; fewer where the shape has no more
/// coarseness : float > 0, larger gives fewer parts: at a cost of 1.9 / coarseness a cut of the whole shape
///     is as likely as not; a cut of a small part must be cheaper, and so must any where hollows are
///     everywhere. Cuts of about the same cost, as of two arms, are made all or none
/// face_weights : (m,) array ≥ 0, what borders cost there: 1 is neutral, smaller attracts them
/// edge_weights : (m,3) array ≥ 0, the same for edges, column i opposite corner i;
///     the mean of both faces' entries counts
/// faces : faces to divide, (m,) booleans or (j,) indices; None for all
/// threads : int or None
/// progress : Progress or None
///
/// Returns
/// -------
/// Parts
///
/// Raises
/// ------
/// ArgumentError, MeshError (no positions, no face with area), SolveError, Cancelled
///
/// References
/// ----------
/// Minima rule: Hoffman and Richards, Parts of recognition, 1984. Thickness: Shapira, Shamir and Cohen-Or,
/// Consistent mesh partitioning and skeletonisation using the shape diameter function, 2008.
#[pyfunction]
#[pyo3(signature = (mesh, *, n_parts=None, coarseness=1.0, face_weights=None, edge_weights=None, faces=None,
    threads=None, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn parts(
    py: Python<'_>,
    mesh: &Mesh,
    n_parts: Option<i64>,
    coarseness: f64,
    face_weights: Option<&Bound<'_, PyAny>>,
    edge_weights: Option<&Bound<'_, PyAny>>,
    faces: Option<&Bound<'_, PyAny>>,
    threads: Option<i64>,
    progress: Option<&Bound<'_, Progress>>,
) -> PyResult<Parts> {
    let m = mesh.n_faces();
    let options = tools::PartsOptions {
        n_parts: at_least_if(py, "n_parts", n_parts, 1)?,
        coarseness,
        face_weights: options::weights("face_weights", face_weights, m, "face")?,
        edge_weights: options::edge_weights(py, edge_weights)?,
        faces: arrays::mask("faces", faces, m, "face")?,
        threads: at_least_if(py, "threads", threads, 1)?,
    };
    let progress = handle(progress);
    let found = doorway::call(py, &progress, || tools::parts(mesh.inner(), &options, &progress))?;
    Ok(Parts {
        labels: found.labels.into_pyarray(py).unbind(),
        n_parts: found.n_parts,
        boundary_edges: arrays::index_rows(py, &found.boundary_edges)?.unbind(),
        status: found.status.name(),
        hierarchy: found.hierarchy,
    })
}
