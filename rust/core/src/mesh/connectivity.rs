//! Halfedge connectivity of a triangle list, for any input:
//! what is not manifold gets no twin and is told apart.

use crate::buckets::Buckets;
use crate::error::{MeshError, SolveError};
use crate::{memory, Result};

/// No halfedge.
const NONE: u32 = u32::MAX;

/// How many kinds of edges are looked at together.
const SCAN: usize = 128;

/// What lies at a halfedge's edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EdgeKind {
    /// Two faces, consistently oriented: the halfedge has a twin.
    Interior,
    /// One face.
    Boundary,
    /// Two faces that run through the edge in the same direction.
    Inconsistent,
    /// Three or more faces.
    NonManifold,
    /// An edge of a face that names a vertex twice; such a face touches nothing.
    Degenerate,
}

/// The halfedges of a triangle list.
///
/// Halfedge `h = 3 f + i` is opposite corner `i` of face `f` and runs from corner `i + 1` to corner `i + 2`
/// (modulo 3). Twins are stored, not derived from vertex indices, so that intrinsic flips may glue two faces
/// along several edges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Connectivity {
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) n_vertices: usize,
    /// The halfedge on the edge's other side where the edge has exactly two faces, else [`NONE`].
    pub(crate) mates: Vec<u32>,
    pub(crate) kinds: Vec<EdgeKind>,
}

/// The halfedge after `h` in its face.
#[must_use]
pub const fn next(h: usize) -> usize {
    if h % 3 == 2 {
        h - 2
    } else {
        h + 1
    }
}

/// The halfedge before `h` in its face.
#[must_use]
pub const fn previous(h: usize) -> usize {
    if h.is_multiple_of(3) {
        h + 2
    } else {
        h - 1
    }
}

impl Connectivity {
    /// The connectivity of `faces` (vertex triples), in linear time.
    ///
    /// # Errors
    /// [`MeshError::VertexOutOfRange`] if a face names a vertex `>= n_vertices`, [`MeshError::TooManyFaces`]
    /// if the halfedges cannot be counted in 32 bits, [`crate::Error::Solve`] where memory is missing.
    pub fn new(faces: Vec<[u32; 3]>, n_vertices: usize) -> Result<Self> {
        if faces.len() >= NONE as usize / 3 {
            return Err(MeshError::TooManyFaces { n_faces: faces.len() }.into());
        }
        if n_vertices > i32::MAX as usize {
            return Err(MeshError::TooManyVertices { n_vertices }.into());
        }
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= n_vertices) {
                let vertex = i64::from(vertex);
                return Err(MeshError::VertexOutOfRange { face, vertex, n_vertices }.into());
            }
        }
        let n_halfedges = 3 * faces.len();
        let mut connectivity = Self {
            faces,
            n_vertices,
            mates: memory::repeated(NONE, n_halfedges)?,
            kinds: memory::repeated(EdgeKind::Degenerate, n_halfedges)?,
        };
        connectivity.match_halfedges()?;
        Ok(connectivity)
    }

    /// Finds the halfedges of every edge: bucketed by the edge's smaller vertex,
    /// then sorted by its larger one.
    fn match_halfedges(&mut self) -> std::result::Result<(), SolveError> {
        let sound = |f: &[u32; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
        let mut at_smaller = Buckets::new(self.n_vertices, |visit| {
            for (f, corners) in (0_u32..).zip(&self.faces).filter(|(_, f)| sound(f)) {
                for i in 0..3 {
                    let (tail, head) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
                    visit(tail.min(head) as usize, (tail.max(head), 3 * f + i as u32));
                }
            }
        })?;
        for v in 0..self.n_vertices {
            let bucket = at_smaller.of_mut(v);
            bucket.sort_unstable();
            for group in bucket.chunk_by(|a, b| a.0 == b.0) {
                self.set_edge(group);
            }
        }
        Ok(())
    }

    /// A copy.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give that much.
    pub(crate) fn copied(&self) -> std::result::Result<Self, SolveError> {
        Ok(Self {
            faces: memory::twin(&self.faces)?,
            n_vertices: self.n_vertices,
            mates: memory::twin(&self.mates)?,
            kinds: memory::twin(&self.kinds)?,
        })
    }

    /// Records what the halfedges `(_, h)` of one edge are to each other.
    fn set_edge(&mut self, group: &[(u32, u32)]) {
        let kind = match *group {
            [_] => EdgeKind::Boundary,
            [(_, a), (_, b)] => {
                self.join([a as usize, b as usize]);
                if self.tail(a as usize) == self.tail(b as usize) {
                    EdgeKind::Inconsistent
                } else {
                    EdgeKind::Interior
                }
            }
            _ => EdgeKind::NonManifold,
        };
        for &(_, h) in group {
            self.kinds[h as usize] = kind;
        }
    }

    /// Makes two halfedges the sides of one interior edge.
    pub(crate) fn join(&mut self, [a, b]: [usize; 2]) {
        (self.mates[a], self.mates[b]) = (b as u32, a as u32);
        (self.kinds[a], self.kinds[b]) = (EdgeKind::Interior, EdgeKind::Interior);
    }

    /// The faces as vertex triples.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Number of vertices, unreferenced ones included.
    #[must_use]
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Number of faces.
    #[must_use]
    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// Number of halfedges, three a face.
    #[must_use]
    pub fn n_halfedges(&self) -> usize {
        self.mates.len()
    }

    /// The halfedge on the other side of the edge, if the edge is [`EdgeKind::Interior`].
    #[must_use]
    pub fn twin(&self, h: usize) -> Option<usize> {
        (self.kinds[h] == EdgeKind::Interior).then(|| self.mates[h] as usize)
    }

    /// The halfedge of the other face where the edge has exactly two faces,
    /// whether or not their orientations agree.
    #[must_use]
    pub fn mate(&self, h: usize) -> Option<usize> {
        (self.mates[h] != NONE).then(|| self.mates[h] as usize)
    }

    /// What lies at the edge of `h`.
    #[must_use]
    pub fn kind(&self, h: usize) -> EdgeKind {
        self.kinds[h]
    }

    /// The halfedges at [`EdgeKind::Boundary`] edges, ascending.
    pub fn boundary(&self) -> impl Iterator<Item = usize> + '_ {
        self.not_interior().filter(|&h| self.kinds[h] == EdgeKind::Boundary)
    }

    /// Whether an edge is of one of `kinds`, which are others than [`EdgeKind::Interior`].
    #[must_use]
    pub fn has_any(&self, kinds: &[EdgeKind]) -> bool {
        self.not_interior().any(|h| kinds.contains(&self.kinds[h]))
    }

    /// The halfedges at edges of all kinds but the common one, ascending.
    fn not_interior(&self) -> impl Iterator<Item = usize> + '_ {
        // Without an early exit the compiler compares whole registers of kinds: ten times as fast.
        let is_common =
            |kinds: &[EdgeKind]| kinds.iter().fold(true, |all, &kind| all & (kind == EdgeKind::Interior));
        let chunks =
            self.kinds.chunks(SCAN).zip((0..).step_by(SCAN)).filter(move |(kinds, _)| !is_common(kinds));
        let halfedges = chunks.flat_map(|(kinds, first)| first..first + kinds.len());
        halfedges.filter(|&h| self.kinds[h] != EdgeKind::Interior)
    }

    /// The vertex where `h` starts.
    #[must_use]
    pub fn tail(&self, h: usize) -> u32 {
        self.faces[h / 3][(h + 1) % 3]
    }

    /// The vertex where `h` ends.
    #[must_use]
    pub fn head(&self, h: usize) -> u32 {
        self.faces[h / 3][(h + 2) % 3]
    }

    /// The vertex opposite `h` in its face.
    #[must_use]
    pub fn opposite(&self, h: usize) -> u32 {
        self.faces[h / 3][h % 3]
    }

    /// One halfedge of every edge: all halfedges but the larger one of each pair of mates.
    pub fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.n_halfedges()).filter(|&h| self.mate(h).is_none_or(|mate| h < mate))
    }
}
