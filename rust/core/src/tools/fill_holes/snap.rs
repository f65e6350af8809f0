//! Snapping: vertices near a ridge move onto the intersection of the planes around them.

use rayon::prelude::*;

use super::guard::move_one;
use super::region::Region;
use super::surface::FaceGeometry;
use crate::linear::small::Quadric;
use crate::memory;
use crate::mesh::vector::{add, distance, dot, norm, scale, sub, Point};
use crate::remesh::Rings;
use crate::Result;

/// What snapping is done with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Snapping {
    /// Edges bent by more than this (radians) call for snapping.
    pub threshold: f64,
    /// A vertex snaps if such an edge is on a face within so many rings.
    pub near: usize,
    /// Planes are those of the faces within so many rings.
    pub rings: usize,
    /// The width of the Gaussian that weighs them, in edge lengths.
    pub width: f64,
    /// The dihedral angle at which a face is no longer trusted.
    pub doubt: f64,
    /// How much more the faces around the patch count.
    pub trust: f64,
    /// Eigenvalues under this part of the largest are dropped.
    pub drop: f64,
    /// A vertex moves at most so many edge lengths.
    pub reach: f64,
    /// How far a vertex goes toward the middle of its neighbors, in the directions that no plane determines.
    pub relaxation: f64,
}

impl Snapping {
    /// Over five rings: faces that lie on their planes already pull in those that do not yet. The faces
    /// around the patch are known to be right: without their weight a cut corner, whose chamfer is a plane as
    /// well, would stay.
    pub(super) const DEFAULT: Self = Self {
        threshold: 0.1,
        near: 2,
        rings: 5,
        width: 2.5,
        doubt: 0.5,
        trust: 4.0,
        drop: 0.05,
        reach: 1.0,
        relaxation: 0.5,
    };
}

/// Moves every free vertex where the planes around it say where, and to the middle of its neighbors where
/// they do not; returns the longest move.
///
/// Where an edge nearby is bent by more than the threshold, the pseudo-inverse of the quadric (Garland and
/// Heckbert 1997) of the planes takes it onto a plane, onto the line of two, into the corner of three. In the
/// directions that the planes leave free, it goes to the centroid of its neighbors: ridges and plane parts
/// keep their triangles in shape.
pub(super) fn snap(region: &mut Region, how: &Snapping) -> Result<f64> {
    let surface = FaceGeometry::of(region)?;
    let bent = near_bends(region, &surface, how)?;
    let moves = region.free().into_par_iter().map_init(
        || Rings::new(&region.mesh),
        |rings, v| {
            let rings = rings.as_mut().map_err(|error| error.clone())?;
            let step = step(region, &surface, &bent, rings, v, how);
            Ok((norm(step), v, add(region.mesh.position(v), step)))
        },
    );
    let mut moves = memory::all(memory::joined(moves)?)?;
    // The nearest first: of several vertices that a corner attracts, only one finds room there.
    moves.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    Ok(moves.into_iter().fold(0.0, |longest: f64, (_, v, goal)| longest.max(move_one(region, v, goal))))
}

/// Which vertices have an edge bent by more than the threshold on a face within `near` rings.
fn near_bends(region: &Region, surface: &FaceGeometry, how: &Snapping) -> Result<Vec<bool>> {
    let mut bent = memory::repeated(false, region.mesh.n_vertices())?;
    let is_bent = |f: u32| surface.face_angles[f as usize] > how.threshold;
    for (_, face) in region.mesh.faces().filter(|&(f, _)| is_bent(f)) {
        face.iter().for_each(|&v| bent[v as usize] = true);
    }
    for _ in 1..how.near {
        let before = memory::twin(&bent)?;
        for (_, face) in region.mesh.faces().filter(|(_, face)| face.iter().any(|&v| before[v as usize])) {
            face.iter().for_each(|&v| bent[v as usize] = true);
        }
    }
    Ok(bent)
}

fn step(
    region: &Region,
    surface: &FaceGeometry,
    bent: &[bool],
    around: &mut Rings<'_>,
    v: u32,
    how: &Snapping,
) -> Point {
    let mesh = &region.mesh;
    let at = mesh.position(v);
    let neighbors = mesh.neighbors(v);
    let count = neighbors.len().max(1) as f64;
    let edge = neighbors.iter().map(|&w| distance(at, mesh.position(w))).sum::<f64>() / count;
    let mut quadric = Quadric::default();
    let near_ridge = bent[v as usize];
    let rings = if near_ridge { how.rings } else { 1 };
    for f in around.within(v, rings).iter().map(|&f| f as usize) {
        let Some(face) = mesh.face(f as u32) else { continue };
        let normal = surface.normals[f];
        let away = distance(surface.centers[f], at) / (how.width * edge);
        let confidence = 1.0 / (0.01 + (surface.face_angles[f] / how.doubt).powi(4));
        let trust = if region.is_patch(f as u32) { 1.0 } else { how.trust };
        let weight = trust * surface.areas[f] * (-0.5 * away * away).exp() * confidence;
        quadric.add(weight, normal, dot(normal, sub(mesh.position(face[0]), at)));
    }
    let mut step = [0.0; 3];
    let centroid = neighbors.iter().fold([0.0; 3], |sum, &w| add(sum, scale(mesh.position(w), 1.0 / count)));
    let mut slide = scale(sub(centroid, at), how.relaxation);
    for (vector, along) in quadric.determined(how.drop) {
        if near_ridge {
            step = add(step, scale(vector, along));
        }
        slide = sub(slide, scale(vector, dot(vector, slide)));
    }
    let length = norm(step);
    if length > how.reach * edge {
        step = scale(step, how.reach * edge / length);
    }
    add(step, slide)
}
