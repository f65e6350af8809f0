//! What the mesh is like around the loops.

use std::collections::{HashMap, HashSet};

use super::Patch;
use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{area_vector, unit, Point};
use crate::mesh::Mesh;
use crate::remesh::editable::key;
use crate::Result;

/// The faces at the loops and the edges between their vertices.
pub(super) struct Rims {
    is_rim: Vec<bool>,
    /// Edges between two vertices of loops.
    taken: HashSet<[u32; 2]>,
    /// The unit normal of the face at the halfedge, for the halfedges between two vertices of loops.
    normals: HashMap<[u32; 2], Point>,
    /// Faces with three vertices of loops, sorted.
    faces: HashSet<[u32; 3]>,
}

impl Rims {
    /// Reads the faces around `loops`, in one pass over the mesh.
    pub(super) fn new(mesh: &Mesh, loops: &[Vec<u32>]) -> Result<Self> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let mut rims = Self {
            is_rim: vec![false; positions.len()],
            taken: HashSet::new(),
            normals: HashMap::new(),
            faces: HashSet::new(),
        };
        for rim in loops {
            for &vertex in rim {
                let unknown = || MeshError::Unfillable { vertex, n_edges: rim.len(), reason: Refusal::NotALoop };
                *rims.is_rim.get_mut(vertex as usize).ok_or_else(unknown)? = true;
            }
        }
        for face in mesh.connectivity().faces() {
            let on_rim = face.map(|v| rims.is_rim[v as usize]);
            let count = on_rim.iter().filter(|&&on| on).count();
            if count < 2 {
                continue;
            }
            if count == 3 {
                let mut sorted = *face;
                sorted.sort_unstable();
                rims.faces.insert(sorted);
            }
            let normal = unit(area_vector(face.map(|v| positions[v as usize])));
            for i in (0..3).filter(|&i| on_rim[i] && on_rim[(i + 1) % 3]) {
                let (tail, head) = (face[i], face[(i + 1) % 3]);
                rims.taken.insert(key(tail, head));
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
        for [a, b] in patch.faces.iter().flat_map(|face| [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]]) {
            if ((a.max(b)) as usize) < self.is_rim.len() {
                self.taken.insert(key(a, b));
            }
        }
    }

    /// Whether two vertices of loops are joined by an edge.
    pub(super) fn is_taken(&self, a: u32, b: u32) -> bool {
        self.taken.contains(&key(a, b))
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
