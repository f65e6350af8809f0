//! The part of a mesh that filling one hole needs: the patch and the rings around it.

use std::collections::{HashMap, HashSet};

use crate::error::MeshError;
use crate::mesh::vector::Point;
use crate::mesh::{Connectivity, Mesh};
use crate::remesh::EditableMesh;

/// A patch and its surroundings as a small mesh of its own.
#[derive(Debug, Clone)]
pub(super) struct Region {
    /// The faces around the patch come first, then those of the patch; only the latter are ever flipped.
    pub mesh: EditableMesh,
    /// How many faces lie around the patch.
    pub n_outer: usize,
    /// Which vertices stay: those of the faces around the patch, and any on its border.
    pub fixed: Vec<bool>,
    /// The number of each vertex in the whole mesh.
    pub vertices: Vec<u32>,
}

/// The faces of every vertex of a mesh, for finding what is near in time that depends on what is near alone.
pub(super) struct Neighbourhoods<'a> {
    connectivity: &'a Connectivity,
    starts: Vec<u32>,
    faces: Vec<u32>,
}

impl<'a> Neighbourhoods<'a> {
    pub(super) fn new(connectivity: &'a Connectivity) -> Self {
        let mut starts = vec![0_u32; connectivity.n_vertices() + 1];
        for &v in connectivity.faces().iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..connectivity.n_vertices() {
            starts[v + 1] += starts[v];
        }
        let mut fill = starts.clone();
        let mut faces = vec![0; 3 * connectivity.n_faces()];
        for (f, face) in (0..).zip(connectivity.faces()) {
            for &v in face {
                faces[fill[v as usize] as usize] = f;
                fill[v as usize] += 1;
            }
        }
        Self { connectivity, starts, faces }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.faces[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The faces with a vertex at most `rings - 1` edges away from one of `seeds`, ascending.
    pub(super) fn within(&self, seeds: &[u32], rings: usize) -> Vec<u32> {
        let (mut faces, mut front) = (Vec::new(), seeds.to_vec());
        for _ in 0..rings {
            faces = front.iter().flat_map(|&v| self.of(v)).copied().collect();
            faces.sort_unstable();
            faces.dedup();
            front = faces.iter().flat_map(|&f| self.connectivity.faces()[f as usize]).collect();
            front.sort_unstable();
            front.dedup();
        }
        faces
    }
}

impl Region {
    /// The patch with `faces` (numbered as in the filled mesh: vertices beyond the mesh's are `new`, the first of which has the
    /// number `first_new`) and `rings` rings around it.
    pub(super) fn new(
        mesh: &Mesh,
        near: &Neighbourhoods<'_>,
        new: &[Point],
        first_new: u32,
        faces: &[[u32; 3]],
        rings: usize,
    ) -> Result<Self, MeshError> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let n = positions.len() as u32;
        let mut rim: Vec<u32> = faces.iter().flatten().copied().filter(|&v| v < n).collect();
        rim.sort_unstable();
        rim.dedup();
        let outer = near.within(&rim, rings);
        let around = outer.iter().map(|&f| mesh.connectivity().faces()[f as usize]);
        let around = around.filter(|[a, b, c]| a != b && b != c && c != a);
        let all: Vec<[u32; 3]> = around.chain(faces.iter().copied()).collect();
        let mut vertices: Vec<u32> = all.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let number: HashMap<u32, u32> = vertices.iter().copied().zip(0..).collect();
        let local = all.iter().map(|face| face.map(|v| number.get(&v).copied().unwrap_or(0))).collect();
        let place = |&v: &u32| if v < n { positions[v as usize] } else { new[(v - first_new) as usize] };
        let fixed = vertices.iter().map(|&v| v < n).collect();
        let mesh = EditableMesh::new(vertices.iter().map(place).collect(), local)?;
        Ok(Self { mesh, n_outer: all.len() - faces.len(), fixed, vertices })
    }

    /// Whether face `f` belongs to the patch.
    pub(super) fn is_patch(&self, f: u32) -> bool {
        f as usize >= self.n_outer
    }

    /// Whether face `f` has a vertex that may move.
    pub(super) fn touches_patch(&self, f: u32) -> bool {
        self.mesh.face(f).is_some_and(|face| face.iter().any(|&v| !self.fixed[v as usize]))
    }

    /// The vertices that may move, ascending.
    pub(super) fn free(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.fixed).filter(|(_, fixed)| !**fixed).map(|(v, _)| v)
    }

    /// All faces; none is ever removed.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        self.mesh.faces().map(|(_, face)| face).collect()
    }

    /// The surface as it is now.
    pub(super) fn to_mesh(&self) -> Result<Mesh, MeshError> {
        Mesh::new(self.mesh.positions().to_vec(), self.faces())
    }

    /// Moves the free vertices to where `points` has them.
    pub(super) fn move_to(&mut self, points: &[Point]) {
        for (v, (&point, &fixed)) in (0..).zip(points.iter().zip(&self.fixed)) {
            if !fixed {
                self.mesh.set_position(v, point);
            }
        }
    }

    /// Keeps flips from making an edge between two of `vertices` (of the whole mesh).
    pub(super) fn forbid_edges_among(&mut self, vertices: &HashSet<u32>) {
        let here: Vec<u32> = (0..).zip(&self.vertices).filter(|(_, v)| vertices.contains(v)).map(|(v, _)| v).collect();
        for (i, &a) in here.iter().enumerate() {
            here[i + 1..].iter().for_each(|&b| self.mesh.forbid_edge(a, b));
        }
    }

    /// The patch alone as it is now: its vertices, those on the rim included, and its faces.
    pub(super) fn patch(&self) -> (Vec<Point>, Vec<[u32; 3]>) {
        let mut number = vec![u32::MAX; self.fixed.len()];
        let mut points = Vec::new();
        let patch = self.mesh.faces().filter(|&(f, _)| self.is_patch(f));
        let faces = patch
            .map(|(_, face)| {
                face.map(|v| {
                    let number = &mut number[v as usize];
                    if *number == u32::MAX {
                        *number = points.len() as u32;
                        points.push(self.mesh.position(v));
                    }
                    *number
                })
            })
            .collect();
        (points, faces)
    }
}
