//! The part of a mesh that filling one hole needs: the patch and the rings around it.

use std::collections::{HashMap, HashSet};

use super::neighborhoods::Neighborhoods;
use crate::error::MeshError;
use crate::hole_filling::Patch;
use crate::mesh::vector::Point;
use crate::mesh::Mesh;
use crate::remesh::editable::key;
use crate::remesh::EditableMesh;

/// A patch and its surroundings as a small mesh of its own.
///
/// Vertices that stay (those of the mesh) come first, then those of the patch; faces around the patch come
/// first, then those of the patch. Only patch faces are ever changed.
#[derive(Debug, Clone)]
pub(super) struct Region {
    /// Positions and faces, as they are now.
    pub mesh: EditableMesh,
    /// How many faces lie around the patch.
    pub n_outer: usize,
    /// The number in the whole mesh of each vertex that stays.
    pub anchors: Vec<u32>,
    /// The number that the first vertex of the patch will have.
    pub first_new: u32,
    /// Edges that must not be made: others have or may make them.
    pub forbidden: Vec<[u32; 2]>,
}

impl Region {
    /// The patch, whose new vertices begin at the number `first_new`, and `rings` rings around it. No edge is
    /// made between two vertices of `shared`.
    pub(super) fn new(
        mesh: &Mesh,
        near: &Neighborhoods<'_>,
        patch: &Patch,
        first_new: u32,
        rings: usize,
        shared: &HashSet<u32>,
    ) -> Result<Self, MeshError> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let n = positions.len() as u32;
        let mut rim: Vec<u32> = patch.faces.iter().flatten().copied().filter(|&v| v < n).collect();
        rim.sort_unstable();
        rim.dedup();
        let outer: Vec<[u32; 3]> = near
            .within(&rim, rings)
            .into_iter()
            .map(|f| mesh.connectivity().faces()[f as usize])
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let mut anchors: Vec<u32> = outer.iter().flatten().chain(&rim).copied().collect();
        anchors.sort_unstable();
        anchors.dedup();
        let number: HashMap<u32, u32> = anchors.iter().copied().zip(0..).collect();
        let n_anchors = anchors.len() as u32;
        let local =
            |v: u32| number.get(&v).copied().unwrap_or_else(|| n_anchors + v.saturating_sub(first_new));
        let points =
            anchors.iter().map(|&v| positions[v as usize]).chain(patch.vertices.iter().copied()).collect();
        let n_outer = outer.len();
        let faces =
            outer.into_iter().chain(patch.faces.iter().copied()).map(|face| face.map(local)).collect();
        let shared: Vec<u32> =
            (0..).zip(&anchors).filter(|(_, v)| shared.contains(v)).map(|(v, _)| v).collect();
        let pairs =
            shared.iter().enumerate().flat_map(|(i, &a)| shared[i + 1..].iter().map(move |&b| key(a, b)));
        let mut region = Self {
            mesh: EditableMesh::new(points, faces)?,
            n_outer,
            anchors,
            first_new,
            forbidden: pairs.collect(),
        };
        region.forbid();
        Ok(region)
    }

    /// Tells the mesh what must not be made.
    fn forbid(&mut self) {
        for [a, b] in &self.forbidden {
            self.mesh.forbid_edge(*a, *b);
        }
    }

    /// Whether face `f` belongs to the patch.
    pub(super) fn is_patch(&self, f: u32) -> bool {
        f as usize >= self.n_outer
    }

    /// Whether vertex `v` stays where it is.
    pub(super) fn is_anchor(&self, v: u32) -> bool {
        (v as usize) < self.anchors.len()
    }

    /// The vertices that may move, ascending.
    pub(super) fn free(&self) -> std::ops::Range<u32> {
        self.anchors.len() as u32..self.mesh.n_vertices() as u32
    }

    /// Which vertices stay.
    pub(super) fn fixed(&self) -> Vec<bool> {
        (0..self.mesh.n_vertices() as u32).map(|v| self.is_anchor(v)).collect()
    }

    /// All faces; none is ever removed.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        self.mesh.faces().map(|(_, face)| face).collect()
    }

    /// The faces of the patch.
    pub(super) fn patch_faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        self.mesh.faces().skip(self.n_outer)
    }

    /// The surface as it is now.
    pub(super) fn to_mesh(&self) -> Result<Mesh, MeshError> {
        Mesh::new(self.mesh.positions().to_vec(), self.faces())
    }

    /// The number in the whole mesh of vertex `v`.
    pub(super) fn global(&self, v: u32) -> u32 {
        let n = self.anchors.len() as u32;
        self.anchors.get(v as usize).copied().unwrap_or_else(|| self.first_new + (v - n))
    }

    /// The patch alone: its vertices, those on the rim first, its faces,
    /// and the number here of each vertex on the rim.
    pub(super) fn patch(&self) -> (Vec<Point>, Vec<[u32; 3]>, Vec<u32>) {
        let mut rim: Vec<u32> =
            self.patch_faces().flat_map(|(_, face)| face).filter(|&v| self.is_anchor(v)).collect();
        rim.sort_unstable();
        rim.dedup();
        let number: HashMap<u32, u32> = rim.iter().copied().zip(0..).collect();
        let shift = self.anchors.len() as u32 - rim.len() as u32;
        let local = |v: u32| number.get(&v).copied().unwrap_or_else(|| v.saturating_sub(shift));
        let points = rim.iter().copied().chain(self.free()).map(|v| self.mesh.position(v)).collect();
        (points, self.patch_faces().map(|(_, face)| face.map(local)).collect(), rim)
    }

    /// Puts another patch in the place of the present one: like [`Region::patch`], with the same rim.
    pub(super) fn replace_patch(
        &mut self,
        points: &[Point],
        faces: &[[u32; 3]],
        rim: &[u32],
    ) -> Result<(), MeshError> {
        let n = self.anchors.len();
        let shift = n as u32 - rim.len() as u32;
        let number = |v: u32| rim.get(v as usize).copied().unwrap_or(v + shift);
        let all = self.mesh.positions()[..n].iter().chain(points.iter().skip(rim.len())).copied().collect();
        let outer = self.mesh.faces().take(self.n_outer).map(|(_, face)| face);
        let faces = outer.chain(faces.iter().map(|face| face.map(number))).collect();
        self.mesh = EditableMesh::new(all, faces)?;
        self.forbid();
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::hole_filling::{faces_at, fill_loop, find_holes, FillOptions};
    use crate::mesh::vector::{centroid, distance};
    use crate::shapes::Shape;
    use crate::Progress;

    /// The region of the hole that is left where the faces of a closed shape within `radius` of `place` are
    /// taken away.
    pub(crate) fn around_hole(shape: &Shape, place: Point, radius: f64) -> Region {
        let away = |f: usize| distance(centroid(shape.faces[f].map(|v| shape.vertices[v as usize])), place);
        let mesh = shape.clone().without_faces(|f| away(f) < radius).mesh().unwrap();
        let hole = find_holes(&mesh).unwrap().remove(0).vertices;
        let patch = fill_loop(&mesh, &hole, &FillOptions::default(), &Progress::new()).unwrap();
        let at = faces_at(&mesh, std::slice::from_ref(&hole)).unwrap();
        let near = Neighborhoods::new(mesh.connectivity(), &at);
        let n = mesh.connectivity().n_vertices() as u32;
        Region::new(&mesh, &near, &patch, n, super::super::constants::REGION_RINGS, &HashSet::new()).unwrap()
    }

    #[test]
    fn a_patch_replaced_by_itself_is_the_same() {
        let mut region = around_hole(&crate::shapes::icosphere(3), [0.0, 0.0, 1.0], 0.4);
        let before = (region.mesh.positions().to_vec(), region.faces());
        let (points, faces, rim) = region.patch();
        assert!(rim.iter().all(|&v| region.is_anchor(v)));
        region.replace_patch(&points, &faces, &rim).unwrap();
        assert_eq!((region.mesh.positions().to_vec(), region.faces()), before);
    }
}
