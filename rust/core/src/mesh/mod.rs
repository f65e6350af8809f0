//! Triangle meshes: connectivity, edge lengths and, if known, positions.

mod boundary;
pub mod connectivity;
mod cut;
mod edge_table;
mod flip;
pub mod invariants;
mod measured;
pub(crate) mod orientation;
pub(crate) mod partition;
mod report;
mod t_junctions;
pub mod triangle;
pub mod vector;
mod welding;
mod working;

pub use boundary::{boundary_loops, boundary_walks, Walks};
pub(crate) use boundary::{cycle, loop_area_vector};
pub use connectivity::{Connectivity, EdgeKind};
pub use cut::CutMesh;
pub use edge_table::EdgeTable;
pub use flip::Flip;
pub use orientation::{flipped_faces, orient};
pub use report::{report, MeshReport};
pub use t_junctions::{SplitFaces, TJunctions};
pub use welding::Weld;
pub use working::Working;

use crate::error::{MeshError, SolveError};
use crate::memory::{self, Demand, Tool};
use crate::unit::Unit;
use crate::Result;

/// Two lengths of one edge may differ by this part of the longer one;
/// lengths that were stored in single precision do.
const LENGTH_TOLERANCE: f64 = 1e-6;

/// Coordinates in files of six digits are off by this part of the shape's extent; in single precision by
/// less, as long as the origin is near.
pub(crate) const FILE_ROUNDING: f64 = 1e-6;

/// A triangle mesh: connectivity and edge lengths, and vertex positions if it was made from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    connectivity: Connectivity,
    edge_lengths: Vec<[f64; 3]>,
    positions: Option<Vec<[f64; 3]>>,
}

/// The edge lengths of `faces`, one row a face, column `i` opposite corner `i`.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub fn edge_lengths(
    faces: &[[u32; 3]],
    positions: &[[f64; 3]],
) -> std::result::Result<Vec<[f64; 3]>, SolveError> {
    memory::gathered(rows_of_lengths(faces, positions))
}

/// The edge lengths of one triangle, entry `i` opposite corner `i`.
#[must_use]
pub(crate) fn lengths_of(corners: &[[f64; 3]; 3]) -> [f64; 3] {
    rows_of_lengths(&[[0, 1, 2]], corners).next().unwrap_or_default()
}

/// The rows of [`edge_lengths`], one after the other.
pub(crate) fn rows_of_lengths<'a>(
    faces: &'a [[u32; 3]],
    positions: &'a [[f64; 3]],
) -> impl ExactSizeIterator<Item = [f64; 3]> + 'a {
    // In the mesh's own unit: the square of a length is a number where the length is one.
    let unit = Unit::of(faces.iter().flatten().flat_map(|&v| positions[v as usize]));
    let distance = move |a: u32, b: u32| {
        let (mut p, mut q) = (positions[a as usize], positions[b as usize]);
        // Both faces of an edge must get the same bits.
        if a > b {
            std::mem::swap(&mut p, &mut q);
        }
        if !unit.is_one() {
            (p, q) = (p.map(|x| unit.measure(x)), q.map(|x| unit.measure(x)));
        }
        let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        unit.restore((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt())
    };
    faces.iter().map(move |&[a, b, c]| [distance(b, c), distance(c, a), distance(a, b)])
}

impl Mesh {
    /// A mesh from `vertices` (positions) and `faces` (vertex triples).
    ///
    /// Non-manifold edges, faces without area and unreferenced vertices are accepted.
    ///
    /// # Errors
    /// [`MeshError::NonFiniteVertex`], [`MeshError::VertexOutOfRange`], [`MeshError::TooLarge`] and the
    /// errors of [`Connectivity::new`].
    pub fn new(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Result<Self> {
        if let Some(vertex) = vertices.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(MeshError::NonFiniteVertex { vertex }.into());
        }
        let connectivity = Connectivity::new(faces, vertices.len())?;
        let edge_lengths = edge_lengths(connectivity.faces(), &vertices)?;
        if let Some(face) = edge_lengths.iter().position(|l| !l.iter().all(|x| x.is_finite())) {
            return Err(MeshError::TooLarge { face }.into());
        }
        Ok(Self { connectivity, edge_lengths, positions: Some(vertices) })
    }

    /// A mesh known by its edge lengths only: `lengths` has one row a face, column `i` opposite corner `i`.
    /// Without `n_vertices` the vertices are those up to the largest that a face names.
    ///
    /// # Errors
    /// [`MeshError::LengthRows`] if there is not one row a face, and the errors of
    /// [`Mesh::from_connectivity`] and [`Connectivity::new`].
    pub fn from_edge_lengths(
        faces: Vec<[u32; 3]>,
        lengths: Vec<[f64; 3]>,
        n_vertices: Option<usize>,
    ) -> Result<Self> {
        let named = faces.iter().flatten().map(|&v| v as usize + 1).max().unwrap_or(0);
        Self::from_connectivity(Connectivity::new(faces, n_vertices.unwrap_or(named))?, lengths)
    }

    /// What the call of a tool on this mesh takes, with one column of values and the default solver.
    #[must_use]
    pub fn demand(&self, tool: Tool) -> Demand {
        Demand::new(tool, self.connectivity.n_vertices(), self.connectivity.n_faces())
    }

    /// A mesh known by its edge lengths only, on a connectivity that exists already, say that of
    /// [`crate::intrinsic::delaunay_flips`].
    ///
    /// # Errors
    /// [`MeshError::LengthRows`], [`MeshError::BadEdgeLength`], [`MeshError::TriangleInequality`] (violated
    /// by more than rounding), [`MeshError::UnequalEdgeLengths`] (the two faces of an edge differ by more
    /// than 1e-6 of it).
    pub fn from_connectivity(connectivity: Connectivity, lengths: Vec<[f64; 3]>) -> Result<Self> {
        if lengths.len() != connectivity.n_faces() {
            let n_faces = connectivity.n_faces();
            return Err(MeshError::LengthRows { rows: lengths.len(), n_faces }.into());
        }
        for (face, &l) in lengths.iter().enumerate() {
            if !l.iter().all(|x| x.is_finite() && *x >= 0.0) {
                return Err(MeshError::BadEdgeLength { face }.into());
            }
            if triangle::slack(l) < -LENGTH_TOLERANCE * l[0].max(l[1]).max(l[2]) {
                return Err(MeshError::TriangleInequality { face }.into());
            }
        }
        for h in connectivity.edges() {
            if let Some(mate) = connectivity.mate(h) {
                let (a, b) = (lengths[h / 3][h % 3], lengths[mate / 3][mate % 3]);
                if (a - b).abs() > LENGTH_TOLERANCE * a.max(b) {
                    let (first, second) = (h / 3, mate / 3);
                    return Err(MeshError::UnequalEdgeLengths { first, second }.into());
                }
            }
        }
        Ok(Self { connectivity, edge_lengths: lengths, positions: None })
    }

    /// The halfedges.
    #[must_use]
    pub fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// The edge lengths, one row a face, column `i` opposite corner `i`.
    #[must_use]
    pub fn edge_lengths(&self) -> &[[f64; 3]] {
        &self.edge_lengths
    }

    /// The vertex positions, unless the mesh was made from edge lengths.
    #[must_use]
    pub fn positions(&self) -> Option<&[[f64; 3]]> {
        self.positions.as_deref()
    }
}
