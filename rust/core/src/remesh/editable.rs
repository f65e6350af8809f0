//! A triangle mesh whose edges can be flipped, split and collapsed.

use std::collections::{HashMap, HashSet};

use crate::error::MeshError;
use crate::memory;
use crate::mesh::vector::{area_vector, Point};
pub use crate::remesh::edge::{key, Edge, Wings};
use crate::Result;

/// The corners of a face that was removed.
pub(super) const GONE: [u32; 3] = [u32::MAX; 3];

/// More faces than this make a vertex a hub ([`EditableMesh::is_hub`]). Around one of 16,000 faces, an edge
/// that collapses into it takes a thousandth of the time that it took when the vertex moved, and meshes
/// without such vertices keep their bits.
pub(crate) const HUB: usize = 256;

/// Positions, faces, and for every vertex its number before ([`EditableMesh::into_parts`]).
pub type Parts = (Vec<Point>, Vec<[u32; 3]>, Vec<u32>);

/// A triangle mesh under edit: positions, faces, and the faces of every vertex.
///
/// Vertices and faces keep their numbers through every operation. A face that a collapse removes leaves its
/// number empty, and so does a vertex; [`EditableMesh::into_parts`] closes the gaps. An edge is named by its
/// two vertices, in any order.
///
/// The operations look after the connectivity alone: none ever makes an edge with three faces, a face that
/// names a vertex twice, or two faces on the same three vertices, and each does nothing where it would.
/// Whether the surface folds over is the business of [`super::guard`].
#[derive(Debug)]
pub struct EditableMesh {
    pub(super) positions: Vec<Point>,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) faces_of: Vec<Vec<u32>>,
    forbidden: HashSet<[u32; 2]>,
    beyond: HashMap<[u32; 2], Point>,
    is_strict: bool,
}

impl EditableMesh {
    /// A mesh from positions and vertex triples. Face numbers are kept;
    /// a face that names a vertex twice becomes empty.
    ///
    /// # Errors
    /// [`MeshError::VertexOutOfRange`]; [`crate::error::SolveError::Memory`].
    pub fn new(positions: Vec<Point>, faces: Vec<[u32; 3]>) -> Result<Self> {
        let mut mesh = Self {
            faces_of: memory::repeated(Vec::new(), positions.len())?,
            positions,
            faces,
            forbidden: HashSet::new(),
            beyond: HashMap::new(),
            is_strict: false,
        };
        for (f, corners) in mesh.faces.iter_mut().enumerate() {
            let n_vertices = mesh.positions.len();
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= n_vertices) {
                let vertex = i64::from(vertex);
                return Err(MeshError::VertexOutOfRange { face: f, vertex, n_vertices }.into());
            }
            let [a, b, c] = *corners;
            if a == b || b == c || c == a {
                *corners = GONE;
            } else {
                corners.iter().for_each(|&v| mesh.faces_of[v as usize].push(f as u32));
            }
        }
        Ok(mesh)
    }

    /// A copy.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn twin(&self) -> Result<Self> {
        let mut faces_of = memory::room(self.faces_of.len())?;
        faces_of.extend(self.faces_of.iter().cloned());
        Ok(Self {
            positions: memory::twin(&self.positions)?,
            faces: memory::twin(&self.faces)?,
            faces_of,
            forbidden: self.forbidden.clone(),
            beyond: self.beyond.clone(),
            is_strict: self.is_strict,
        })
    }

    /// Asks for every bend to be looked at, also where an edit turns faces by little: many such add up.
    pub fn look_at_every_bend(&mut self) {
        self.is_strict = true;
    }

    /// Whether that was asked for.
    #[must_use]
    pub fn looks_at_every_bend(&self) -> bool {
        self.is_strict
    }

    /// Forbids an edge: no operation will make it. For edges that exist in a larger mesh of which this is a
    /// part.
    pub fn forbid_edge(&mut self, a: u32, b: u32) {
        self.forbidden.insert(key(a, b));
    }

    /// Says along which normal (of any length) a face lies beyond a border edge,
    /// in a larger mesh of which this is a part.
    pub fn set_beyond(&mut self, a: u32, b: u32, normal: Point) {
        self.beyond.insert(key(a, b), normal);
    }

    /// The area vector, or any other normal, of the face across the edge `a b` of a face in which `b` follows
    /// `a`; nothing if there is none or it is not known.
    #[must_use]
    pub fn normal_across(&self, a: u32, b: u32) -> Option<Point> {
        match self.edge(a, b) {
            Edge::Interior(wings) => Some(self.area_vector(wings.faces[1])),
            Edge::Border(..) => self.beyond.get(&key(a, b)).copied(),
            Edge::None | Edge::NonManifold => None,
        }
    }

    /// The positions by vertex number, those of removed vertices included.
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// The position of `v`.
    #[must_use]
    pub fn position(&self, v: u32) -> Point {
        self.positions[v as usize]
    }

    /// Moves `v`.
    pub fn set_position(&mut self, v: u32, position: Point) {
        self.positions[v as usize] = position;
    }

    /// How many vertex numbers are in use or were.
    #[must_use]
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// How many face numbers are in use or were.
    #[must_use]
    pub fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// The vertices of face `f`, unless it was removed.
    #[must_use]
    pub fn face(&self, f: u32) -> Option<[u32; 3]> {
        Some(self.faces[f as usize]).filter(|&corners| corners != GONE)
    }

    /// All faces with their numbers.
    pub fn faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        (0..).zip(&self.faces).filter(|(_, &corners)| corners != GONE).map(|(f, &corners)| (f, corners))
    }

    /// The faces of `v`, in no particular but a reproducible order.
    #[must_use]
    pub fn faces_of(&self, v: u32) -> &[u32] {
        &self.faces_of[v as usize]
    }

    /// Whether `v` has so many faces that it stays where it is when edges collapse into it: each would turn
    /// all of them, so that looking at them takes the square of their number. Poles of spheres have up to
    /// some hundred.
    #[must_use]
    pub fn is_hub(&self, v: u32) -> bool {
        self.faces_of(v).len() > HUB
    }

    /// The positions of three vertices.
    #[must_use]
    pub fn corners(&self, face: [u32; 3]) -> [Point; 3] {
        face.map(|v| self.position(v))
    }

    /// The area vector of face `f`; zero if it was removed.
    #[must_use]
    pub fn area_vector(&self, f: u32) -> Point {
        self.face(f).map_or([0.0; 3], |face| area_vector(self.corners(face)))
    }

    /// The vertices joined to `v` by an edge, ascending.
    #[must_use]
    pub fn neighbors(&self, v: u32) -> Vec<u32> {
        let mut found = Vec::with_capacity(2 * self.faces_of(v).len());
        found.extend(self.faces_of(v).iter().flat_map(|&f| self.faces[f as usize]).filter(|&w| w != v));
        found.sort_unstable();
        found.dedup();
        found
    }

    /// All edges, smaller vertex first, ascending.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn edges(&self) -> Result<Vec<[u32; 2]>> {
        let mut edges = memory::room(self.faces.len() * 3 / 2)?;
        let mut larger = Vec::new();
        for v in 0..self.positions.len() as u32 {
            larger.clear();
            larger.extend(self.faces_of(v).iter().flat_map(|&f| self.faces[f as usize]).filter(|&w| w > v));
            larger.sort_unstable();
            larger.dedup();
            memory::extend(&mut edges, larger.len())?;
            edges.extend(larger.iter().map(|&w| [v, w]));
        }
        Ok(edges)
    }

    /// What lies at the vertices `a` and `b`.
    #[must_use]
    pub fn edge(&self, a: u32, b: u32) -> Edge {
        // Of a hub with ten thousand faces and its neighbor, the neighbor's few are looked at.
        if self.faces_of(b).len() < self.faces_of(a).len() {
            return match self.edge_from(b, a) {
                Edge::Interior(Wings { faces: [f, g], tips: [left, right] }) => {
                    Edge::Interior(Wings { faces: [g, f], tips: [right, left] })
                }
                other => other,
            };
        }
        self.edge_from(a, b)
    }

    /// [`EditableMesh::edge`], by the faces of `a`.
    fn edge_from(&self, a: u32, b: u32) -> Edge {
        // For every face of the edge: its number, its tip, and whether `b` follows `a` in it.
        let mut found = [(0, 0, false); 2];
        let mut count = 0;
        for &f in self.faces_of(a) {
            let face = self.faces[f as usize];
            let Some(i) = (0..3).find(|&i| face[i] == b) else { continue };
            if count == 2 {
                return Edge::NonManifold;
            }
            let forward = face[(i + 2) % 3] == a;
            found[count] = (f, if forward { face[(i + 1) % 3] } else { face[(i + 2) % 3] }, forward);
            count += 1;
        }
        match (count, found) {
            (0, _) => Edge::None,
            (1, [(f, tip, _), _]) => Edge::Border(f, tip),
            (_, [(f, left, true), (g, right, false)] | [(g, right, false), (f, left, true)]) => {
                Edge::Interior(Wings { faces: [f, g], tips: [left, right] })
            }
            _ => Edge::NonManifold,
        }
    }

    /// The faces of an interior edge; nothing at any other pair of vertices.
    #[must_use]
    pub fn wings(&self, a: u32, b: u32) -> Option<Wings> {
        match self.edge(a, b) {
            Edge::Interior(wings) => Some(wings),
            _ => None,
        }
    }

    /// Whether a face has both vertices, or the edge is forbidden.
    #[must_use]
    pub fn is_taken(&self, a: u32, b: u32) -> bool {
        let (few, other) = if self.faces_of(b).len() < self.faces_of(a).len() { (b, a) } else { (a, b) };
        self.faces_of(few).iter().any(|&f| self.faces[f as usize].contains(&other))
            || (!self.forbidden.is_empty() && self.forbidden.contains(&key(a, b)))
    }

    /// Whether an edge at `v` has one face only.
    #[must_use]
    pub fn is_border(&self, v: u32) -> bool {
        let mut around: Vec<u32> =
            self.faces_of(v).iter().flat_map(|&f| self.faces[f as usize]).filter(|&w| w != v).collect();
        around.sort_unstable();
        around.chunk_by(|a, b| a == b).any(|same| same.len() == 1)
    }

    /// Whether the faces of `v` form one fan across interior edges; a vertex without faces has none.
    #[must_use]
    pub fn is_manifold(&self, v: u32) -> bool {
        let faces = self.faces_of(v);
        let Some(&first) = faces.first() else { return false };
        // In a fan every face is met from the one before: a walk both ways from the first sees each once.
        let mut count = 1;
        for w in self.faces[first as usize].into_iter().filter(|&w| w != v) {
            let (mut f, mut across) = (first, w);
            loop {
                match self.edge(v, across) {
                    Edge::NonManifold => return false,
                    Edge::Border(..) | Edge::None => break,
                    Edge::Interior(wings) => {
                        f = if wings.faces[0] == f { wings.faces[1] } else { wings.faces[0] };
                        if f == first {
                            return count == faces.len();
                        }
                        count += 1;
                        let Some(next) = self.faces[f as usize].into_iter().find(|&x| x != v && x != across)
                        else {
                            return false;
                        };
                        across = next;
                    }
                }
            }
        }
        count == faces.len()
    }

    /// The positions and faces without gaps, and for every vertex kept its number before. `keep(v)` says
    /// which vertices without faces to keep; order is kept.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn into_parts(self, keep: impl Fn(u32) -> bool) -> Result<Parts> {
        let is_kept = |&v: &u32| !self.faces_of(v).is_empty() || keep(v);
        let kept = memory::sifted((0..self.positions.len() as u32).filter(is_kept))?;
        let mut number = memory::repeated(u32::MAX, self.positions.len())?;
        kept.iter().zip(0..).for_each(|(&v, new)| number[v as usize] = new);
        let faces = memory::sifted(self.faces().map(|(_, face)| face.map(|v| number[v as usize])))?;
        Ok((memory::gathered(kept.iter().map(|&v| self.position(v)))?, faces, kept))
    }
}
