//! The part of a mesh that filling one hole needs: the patch and the rings around it.

use std::collections::{HashMap, HashSet};

use super::neighborhoods::Neighborhoods;
use crate::error::MeshError;
use crate::hole_filling::Patch;
use crate::memory;
use crate::mesh::vector::Point;
use crate::mesh::Mesh;
use crate::remesh::editable::key;
use crate::remesh::EditableMesh;
use crate::Result;

/// A patch alone: its vertices, those on the rim first, its faces, and the number in the region of each
/// vertex on the rim.
pub(super) type PatchAlone = (Vec<Point>, Vec<[u32; 3]>, Vec<u32>);

/// A patch and its surroundings as a small mesh of its own.
///
/// Vertices that stay (those of the mesh) come first, then those of the patch; faces around the patch come
/// first, then those of the patch. Only patch faces are ever changed.
#[derive(Debug)]
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
    ) -> Result<Self> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let n = positions.len() as u32;
        let mut rim = memory::sifted(patch.faces.iter().flatten().copied().filter(|&v| v < n))?;
        rim.sort_unstable();
        rim.dedup();
        let around = near.within(&rim, rings)?.into_iter().map(|f| mesh.connectivity().faces()[f as usize]);
        let outer = memory::sifted(around.filter(|[a, b, c]| a != b && b != c && c != a))?;
        let mut anchors = memory::sifted(outer.iter().flatten().chain(&rim).copied())?;
        anchors.sort_unstable();
        anchors.dedup();
        let number = numbered(&anchors)?;
        let n_anchors = anchors.len() as u32;
        let local =
            |v: u32| number.get(&v).copied().unwrap_or_else(|| n_anchors + v.saturating_sub(first_new));
        let stay = anchors.iter().map(|&v| positions[v as usize]);
        let points = memory::sifted(stay.chain(patch.vertices.iter().copied()))?;
        let n_outer = outer.len();
        let faces = outer.into_iter().chain(patch.faces.iter().copied());
        let faces = memory::sifted(faces.map(|face| face.map(local)))?;
        let shared = memory::sifted((0..).zip(&anchors).filter(|(_, v)| shared.contains(v)).map(|(v, _)| v))?;
        let pairs =
            shared.iter().enumerate().flat_map(|(i, &a)| shared[i + 1..].iter().map(move |&b| key(a, b)));
        let mut region = Self {
            mesh: EditableMesh::new(points, faces)?,
            n_outer,
            anchors,
            first_new,
            forbidden: memory::sifted(pairs)?,
        };
        region.forbid();
        Ok(region)
    }

    /// A copy.
    pub(super) fn twin(&self) -> Result<Self> {
        Ok(Self {
            mesh: self.mesh.twin()?,
            n_outer: self.n_outer,
            anchors: memory::twin(&self.anchors)?,
            first_new: self.first_new,
            forbidden: memory::twin(&self.forbidden)?,
        })
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
    pub(super) fn fixed(&self) -> Result<Vec<bool>> {
        Ok(memory::sifted((0..self.mesh.n_vertices() as u32).map(|v| self.is_anchor(v)))?)
    }

    /// All faces; none is ever removed.
    pub(super) fn faces(&self) -> Result<Vec<[u32; 3]>> {
        Ok(memory::sifted(self.mesh.faces().map(|(_, face)| face))?)
    }

    /// The faces of the patch.
    pub(super) fn patch_faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        self.mesh.faces().skip(self.n_outer)
    }

    /// The surface as it is now.
    pub(super) fn to_mesh(&self) -> Result<Mesh> {
        Mesh::new(memory::twin(self.mesh.positions())?, self.faces()?)
    }

    /// The number in the whole mesh of vertex `v`.
    pub(super) fn global(&self, v: u32) -> u32 {
        let n = self.anchors.len() as u32;
        self.anchors.get(v as usize).copied().unwrap_or_else(|| self.first_new + (v - n))
    }

    /// The patch alone.
    pub(super) fn patch(&self) -> Result<PatchAlone> {
        let corners = self.patch_faces().flat_map(|(_, face)| face);
        let mut rim = memory::sifted(corners.filter(|&v| self.is_anchor(v)))?;
        rim.sort_unstable();
        rim.dedup();
        let number = numbered(&rim)?;
        let shift = self.anchors.len() as u32 - rim.len() as u32;
        let local = |v: u32| number.get(&v).copied().unwrap_or_else(|| v.saturating_sub(shift));
        let points = memory::sifted(rim.iter().copied().chain(self.free()).map(|v| self.mesh.position(v)))?;
        let faces = memory::sifted(self.patch_faces().map(|(_, face)| face.map(local)))?;
        Ok((points, faces, rim))
    }

    /// Puts another patch in the place of the present one: like [`Region::patch`], with the same rim.
    pub(super) fn replace_patch(&mut self, points: &[Point], faces: &[[u32; 3]], rim: &[u32]) -> Result<()> {
        let n = self.anchors.len();
        let shift = n as u32 - rim.len() as u32;
        let number = |v: u32| rim.get(v as usize).copied().unwrap_or(v + shift);
        let all =
            memory::sifted(self.mesh.positions()[..n].iter().chain(points.iter().skip(rim.len())).copied())?;
        let outer = self.mesh.faces().take(self.n_outer).map(|(_, face)| face);
        let faces = memory::sifted(outer.chain(faces.iter().map(|face| face.map(number))))?;
        self.mesh = EditableMesh::new(all, faces)?;
        self.forbid();
        Ok(())
    }
}

/// The place of each of `vertices`.
fn numbered(vertices: &[u32]) -> Result<HashMap<u32, u32>> {
    let mut number = HashMap::new();
    memory::extend_map(&mut number, vertices.len())?;
    number.extend(vertices.iter().copied().zip(0..));
    Ok(number)
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::hole_filling::{faces_at, fill_loops, find_holes, FillOptions};
    use crate::mesh::vector::{centroid, distance};
    use crate::shapes::Shape;
    use crate::Progress;

    /// The region of the hole that is left where the faces of a closed shape within `radius` of `place` are
    /// taken away.
    pub(crate) fn around_hole(shape: &Shape, place: Point, radius: f64) -> Region {
        let away = |f: usize| distance(centroid(shape.faces[f].map(|v| shape.vertices[v as usize])), place);
        let mesh = shape.clone().without_faces(|f| away(f) < radius).mesh().unwrap();
        let hole = find_holes(&mesh).unwrap().remove(0).vertices;
        let at = faces_at(&mesh, std::slice::from_ref(&hole)).unwrap();
        let (options, progress) = (FillOptions::default(), Progress::new());
        let patch = fill_loops(&mesh, &[hole], &at, &options, &progress).unwrap().remove(0).unwrap();
        let near = Neighborhoods::new(mesh.connectivity(), &at).unwrap();
        let n = mesh.connectivity().n_vertices() as u32;
        Region::new(&mesh, &near, &patch, n, super::super::constants::REGION_RINGS, &HashSet::new()).unwrap()
    }

    #[test]
    fn a_patch_replaced_by_itself_is_the_same() {
        let mut region = around_hole(&crate::shapes::icosphere(3), [0.0, 0.0, 1.0], 0.4);
        let before = (region.mesh.positions().to_vec(), region.faces().unwrap());
        let (points, faces, rim) = region.patch().unwrap();
        assert!(rim.iter().all(|&v| region.is_anchor(v)));
        region.replace_patch(&points, &faces, &rim).unwrap();
        assert_eq!((region.mesh.positions().to_vec(), region.faces().unwrap()), before);
    }
}
