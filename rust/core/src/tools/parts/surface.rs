//! The faces of a mesh of any kind as patches with normals that agree, in units of the square root of the
//! area.

use std::collections::BTreeMap;

use super::constants::LEAST_AREA;
use crate::buckets::Buckets;
use crate::error::MeshError;
use crate::mesh::vector::{add, area_vector, between, centroid, distance, dot, norm, scale, Point};
use crate::mesh::{Connectivity, EdgeTable, Mesh};
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
    /// The faces named by `faces` with the painted `weight` of each halfedge; vertices at the same place
    /// count as one.
    ///
    /// # Errors
    /// [`MeshError::NoPositions`], and [`MeshError::NoFaces`] where no face has area.
    pub(super) fn new(mesh: &Mesh, faces: &[u32], weight: impl Fn(usize) -> f64) -> Result<Self> {
        let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
        let corners = memory::gathered(faces.iter().map(|&f| mesh.connectivity().faces()[f as usize]))?;
        let welded = Connectivity::new(welded(&corners, positions)?, positions.len())?;
        let raw = memory::gathered(corners.iter().map(|face| face.map(|v| positions[v as usize])))?;
        let total: f64 = raw.iter().map(|&t| norm(area_vector(t))).sum();
        if !(total > 0.0 && total.is_finite()) {
            return Err(MeshError::NoFaces.into());
        }
        let unit = 1.0 / total.sqrt();
        let triangles = memory::gathered(raw.iter().map(|t: &[Point; 3]| t.map(|p| scale(p, unit))))?;
        let centers = memory::gathered(triangles.iter().map(|&t| centroid(t)))?;
        let (mut joints, mut opposite, mut open) = (Vec::new(), Vec::new(), Vec::new());
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
                memory::push(&mut opposite, welded.tail(pair[0]) == welded.tail(pair[1]))?;
            }
        }
        let mut normals = memory::gathered(triangles.iter().map(|&t| area_vector(t)))?;
        orient(&mut normals, &centers, &joints, &opposite, open.is_empty())?;
        let areas = memory::gathered(normals.iter().map(|&n| norm(n).max(LEAST_AREA)))?;
        Ok(Self { triangles, areas, centers, normals, joints, open })
    }

    pub(super) fn n_faces(&self) -> usize {
        self.areas.len()
    }
}

/// The faces with each vertex named after the first one at its place.
fn welded(faces: &[[u32; 3]], positions: &[Point]) -> Result<Vec<[u32; 3]>> {
    let mut first: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    // Adding zero makes one of both zeros.
    let mut name = |v: u32| *first.entry(positions[v as usize].map(|x| (x + 0.0).to_bits())).or_insert(v);
    Ok(memory::gathered(faces.iter().map(|face| face.map(&mut name)))?)
}

/// Turns the normals of faces whose neighbors run the other way; every piece then points as most of its
/// area did, or, where the surface is closed, outwards.
fn orient(
    normals: &mut [Point],
    centers: &[Point],
    joints: &[Joint],
    opposite: &[bool],
    closed: bool,
) -> Result<()> {
    let around = Buckets::new(normals.len(), |visit| {
        for (joint, &turned) in joints.iter().zip(opposite) {
            let [f, g] = joint.faces;
            visit(f as usize, (g, turned));
            visit(g as usize, (f, turned));
        }
    })?;
    let mut sign = memory::repeated(0.0, normals.len())?;
    for start in 0..normals.len() {
        if sign[start] != 0.0 {
            continue;
        }
        sign[start] = 1.0;
        let mut piece = vec![start];
        let mut at = 0;
        while let Some(&f) = piece.get(at) {
            at += 1;
            for &(g, turned) in around.of(f) {
                if sign[g as usize] == 0.0 {
                    sign[g as usize] = if turned { -sign[f] } else { sign[f] };
                    memory::push(&mut piece, g as usize)?;
                }
            }
        }
        let measure = |f: usize| if closed { dot(centers[f], normals[f]) } else { norm(normals[f]) };
        if piece.iter().map(|&f| sign[f] * measure(f)).sum::<f64>() < 0.0 {
            piece.iter().for_each(|&f| sign[f] = -sign[f]);
        }
    }
    normals.iter_mut().zip(&sign).for_each(|(normal, sign)| *normal = add([0.0; 3], scale(*normal, *sign)));
    Ok(())
}
