//! What the mesh is like around the loops.

use std::collections::{HashMap, HashSet};

use super::hole::Patch;
use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{area_vector, unit, Point};
use crate::mesh::Mesh;
use crate::Result;

/// The faces with a vertex on one of `loops`, ascending, in one pass over the faces:
/// the only one that filling makes.
///
/// # Errors
/// [`MeshError::Unfillable`] for a loop that names a vertex which does not exist.
pub fn faces_at(mesh: &Mesh, loops: &[Vec<u32>]) -> Result<Vec<u32>> {
    // Zeros that are never read cost nothing.
    let mut is_rim = vec![false; mesh.connectivity().n_vertices()];
    for rim in loops {
        for &vertex in rim {
            let unknown = || MeshError::Unfillable { vertex, n_edges: rim.len(), reason: Refusal::NotALoop };
            *is_rim.get_mut(vertex as usize).ok_or_else(unknown)? = true;
        }
    }
    let at_rim =
        |face: &[u32; 3]| is_rim[face[0] as usize] | is_rim[face[1] as usize] | is_rim[face[2] as usize];
    Ok((0..).zip(mesh.connectivity().faces()).filter(|(_, face)| at_rim(face)).map(|(f, _)| f).collect())
}

/// The faces at the loops and the edges between their vertices.
pub(super) struct Rims {
    n_vertices: u32,
    /// For every vertex of a loop, those to which an edge joins it.
    joined: HashMap<u32, Vec<u32>>,
    /// The unit normal of the face at the halfedge, for the halfedges between two vertices of loops.
    normals: HashMap<[u32; 2], Point>,
    /// Faces with three vertices of loops, sorted.
    faces: HashSet<[u32; 3]>,
}

impl Rims {
    /// Reads the faces `at` the loops ([`faces_at`]).
    pub(super) fn new(mesh: &Mesh, loops: &[Vec<u32>], at: &[u32]) -> Result<Self> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let mut rims = Self {
            n_vertices: positions.len() as u32,
            joined: HashMap::new(),
            normals: HashMap::new(),
            faces: HashSet::new(),
        };
        let vertices: HashSet<u32> = loops.iter().flatten().copied().collect();
        // A face that names a vertex twice has no edges.
        let is_face = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        for face in at.iter().map(|&f| mesh.connectivity().faces()[f as usize]).filter(is_face) {
            let on_rim = face.map(|v| vertices.contains(&v));
            let count = on_rim.iter().filter(|&&on| on).count();
            if count < 2 {
                continue;
            }
            if count == 3 {
                let mut sorted = face;
                sorted.sort_unstable();
                rims.faces.insert(sorted);
            }
            let normal = unit(area_vector(face.map(|v| positions[v as usize])));
            for i in (0..3).filter(|&i| on_rim[i] && on_rim[(i + 1) % 3]) {
                let (tail, head) = (face[i], face[(i + 1) % 3]);
                rims.join(tail, head);
                // A second face in the same direction leaves no side free.
                if rims.normals.insert([tail, head], normal).is_some() {
                    rims.normals.insert([head, tail], normal);
                }
            }
        }
        Ok(rims)
    }

    /// Takes the edges of a patch between old vertices.
    pub(super) fn add(&mut self, patch: &Patch) {
        for [a, b] in
            patch.faces.iter().flat_map(|face| [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]])
        {
            if a.max(b) < self.n_vertices {
                self.join(a, b);
            }
        }
    }

    /// Whether two vertices of loops are joined by an edge.
    pub(super) fn is_taken(&self, a: u32, b: u32) -> bool {
        self.joined.get(&a).is_some_and(|others| others.contains(&b))
    }

    /// The edges that exist among `vertices` and are not on the closed loop that these form,
    /// as places in it, ascending.
    pub(super) fn chords(&self, vertices: &[u32]) -> Vec<[u32; 2]> {
        let place: HashMap<u32, u32> = vertices.iter().copied().zip(0..).collect();
        let n = vertices.len() as u32;
        let is_chord = |&[i, j]: &[u32; 2]| i < j && i + 1 != j && !(i == 0 && j + 1 == n);
        let from = |v: u32| self.joined.get(&v).into_iter().flatten();
        let mut chords: Vec<[u32; 2]> = (0..)
            .zip(vertices)
            .flat_map(|(i, &v)| from(v).filter_map(|w| place.get(w)).map(move |&j| [i, j]))
            .filter(is_chord)
            .collect();
        chords.sort_unstable();
        chords
    }

    fn join(&mut self, a: u32, b: u32) {
        for (from, to) in [(a, b), (b, a)] {
            let others = self.joined.entry(from).or_default();
            if !others.contains(&to) {
                others.push(to);
            }
        }
    }

    /// Whether a face has these vertices, sorted.
    pub(super) fn has_face(&self, sorted: &[u32]) -> bool {
        <[u32; 3]>::try_from(sorted).is_ok_and(|face| self.faces.contains(&face))
    }

    /// The unit normal of the face in which `head` follows `tail`.
    pub(super) fn normal(&self, tail: u32, head: u32) -> Option<Point> {
        self.normals.get(&[tail, head]).copied()
    }
}
