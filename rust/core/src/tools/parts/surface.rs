//! The faces of a mesh of any kind as patches with normals that agree, in units of the square root of the
//! area.

use std::collections::BTreeMap;

use super::constants::LEAST_AREA;
use super::graph::NONE;
use crate::error::MeshError;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{area_vector, between, centroid, distance, dot, norm, place, scale, Point};
use crate::mesh::{flipped_faces, Connectivity, EdgeTable, Mesh, Weld};
use crate::{memory, Result};

/// Two faces with a common edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Joint {
    pub faces: [u32; 2],
    pub length: f64,
    /// From one centroid over the middle of the edge to the other.
    pub distance: f64,
    /// What a border there costs per length, by painted weights.
    pub weight: f64,
}

/// The faces of a shape whose area is 1.
pub(super) struct Surface {
    pub triangles: Vec<[Point; 3]>,
    pub areas: Vec<f64>,
    pub centers: Vec<Point>,
    /// Area vectors, turned so that neighbors agree where that is possible.
    pub normals: Vec<Point>,
    pub joints: Vec<Joint>,
    /// The halfedges of edges with one face.
    pub open: Vec<usize>,
}

impl Surface {
    /// The faces named by `faces` with the painted `weight` of each halfedge.
    ///
    /// # Errors
    /// [`MeshError::NoPositions`], and [`MeshError::NoFaces`] where no face has area.
    pub(super) fn new(mesh: &Mesh, faces: &[u32], weight: impl Fn(usize) -> f64) -> Result<Self> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let corners = faces.iter().map(|&f| mesh.connectivity().faces()[f as usize]);
        let raw = memory::gathered(corners.map(|face| face.map(|v| positions[v as usize])))?;
        let welded = joined(mesh, faces, positions)?;
        let total: f64 = raw.iter().map(|&t| norm(area_vector(t))).sum();
        if !(total > 0.0 && total.is_finite()) {
            return Err(MeshError::NoFaces.into());
        }
        let unit = 1.0 / total.sqrt();
        let triangles = memory::gathered(raw.iter().map(|t: &[Point; 3]| t.map(|p| scale(p, unit))))?;
        let centers = memory::gathered(triangles.iter().map(|&t| centroid(t)))?;
        let (mut joints, mut open) = (Vec::new(), Vec::new());
        let table = EdgeTable::new(&welded)?;
        for halfedges in table.edges() {
            let halfedges: Vec<usize> = halfedges.collect();
            if let [single] = halfedges[..] {
                memory::push(&mut open, single)?;
            }
            // Where three or more faces meet, each is joined to the next.
            for pair in halfedges.windows(2) {
                let [f, g] = [pair[0], pair[1]].map(|h| h / 3);
                if f == g {
                    continue;
                }
                let [p, q] = [1, 2].map(|i| triangles[f][(pair[0] + i) % 3]);
                let middle = between(p, q, 0.5);
                let given = [pair[0], pair[1]].map(|h| weight(3 * faces[h / 3] as usize + h % 3));
                let joint = Joint {
                    faces: [f as u32, g as u32],
                    length: distance(p, q),
                    distance: distance(centers[f], middle) + distance(middle, centers[g]),
                    weight: 0.5 * (given[0] + given[1]),
                };
                memory::push(&mut joints, joint)?;
            }
        }
        let mut normals = memory::gathered(triangles.iter().map(|&t| area_vector(t)))?;
        orient(&mut normals, &centers, &welded)?;
        let areas = memory::gathered(normals.iter().map(|&n| norm(n).max(LEAST_AREA)))?;
        Ok(Self { triangles, areas, centers, normals, joints, open })
    }

    /// For each face the piece that it is of, by a face of that, where the piece is closed; else [`NONE`].
    pub(super) fn closed_pieces(&self) -> Result<Vec<u32>> {
        let mut pieces = Partition::new(self.n_faces())?;
        self.joints.iter().for_each(|joint| pieces.unite(joint.faces[0], joint.faces[1]));
        let mut closed = memory::repeated(true, self.n_faces())?;
        self.open.iter().for_each(|h| closed[pieces.root((h / 3) as u32) as usize] = false);
        Ok(memory::sifted((0..self.n_faces() as u32).map(|f| {
            let piece = pieces.root(f);
            if closed[piece as usize] {
                piece
            } else {
                NONE
            }
        }))?)
    }

    pub(super) fn n_faces(&self) -> usize {
        self.areas.len()
    }
}

/// The faces with the sides of seams joined ([`Weld::of_seams`]), as every tool has them, and with each
/// vertex named after the first one at its very place: sheets on each other are one here.
fn joined(mesh: &Mesh, faces: &[u32], positions: &[Point]) -> Result<Connectivity> {
    let weld = Weld::of_seams(mesh.connectivity(), positions, None)?;
    let mut first: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut name = |v: u32| {
        let v = weld.as_ref().map_or(v, |weld| weld.first[weld.vertex[v as usize] as usize]);
        *first.entry(place(positions[v as usize])).or_insert(v)
    };
    let corners = faces.iter().map(|&f| mesh.connectivity().faces()[f as usize].map(&mut name));
    Connectivity::new(memory::gathered(corners)?, positions.len())
}

/// Turns the normals of faces whose neighbors run the other way ([`flipped_faces`]); every piece then points
/// as most of its area did, or, where it is closed, outwards.
fn orient(normals: &mut [Point], centers: &[Point], connectivity: &Connectivity) -> Result<()> {
    let turn = |normal: &mut Point| *normal = scale(*normal, -1.0);
    let flipped = flipped_faces(connectivity)?;
    normals.iter_mut().zip(&flipped).filter(|(_, &flip)| flip).for_each(|(normal, _)| turn(normal));
    let mut pieces = Partition::new(normals.len())?;
    for h in 0..3 * normals.len() {
        if let Some(mate) = connectivity.mate(h) {
            pieces.unite((h / 3) as u32, (mate / 3) as u32);
        }
    }
    let piece = memory::gathered((0..normals.len() as u32).map(|f| pieces.root(f) as usize))?;
    let mut closed = memory::repeated(true, normals.len())?;
    (0..3 * normals.len()).for_each(|h| closed[piece[h / 3]] &= connectivity.mate(h).is_some());
    let mut outward = memory::repeated(0.0, normals.len())?;
    for (f, normal) in normals.iter().enumerate() {
        let as_given = if flipped[f] { -norm(*normal) } else { norm(*normal) };
        outward[piece[f]] += if closed[piece[f]] { dot(centers[f], *normal) } else { as_given };
    }
    normals.iter_mut().zip(&piece).filter(|(_, &p)| outward[p] < 0.0).for_each(|(normal, _)| turn(normal));
    Ok(())
}
