//! Moves that fold nothing: the vertices of faces that would turn over or become slivers move less far.

use super::region::Region;
use super::surface::angle;
use crate::mesh::vector::{area_vector, between, distance, dot, norm, quality, Point};
use crate::shape_guard::{FOLD_ANGLE, KEPT, MOVED_SLIVER, PARTS_OF_A_MOVE, TURNED};

/// How often the steps at a bad face are halved before they are taken back.
const HALVINGS: usize = 4;

/// Moves the free vertices toward `goal` as far as the faces around them stay in order, and returns the longest move.
pub(super) fn move_guarded(region: &mut Region, goal: &[Point]) -> f64 {
    let old = region.mesh.positions().to_vec();
    let mut part: Vec<f64> = (0..old.len() as u32).map(|v| if region.is_anchor(v) { 0.0 } else { 1.0 }).collect();
    let faces: Vec<(u32, [u32; 3])> = region.patch_faces().collect();
    let before: Vec<(Point, f64)> =
        faces.iter().map(|&(_, face)| region.mesh.corners(face)).map(|c| (area_vector(c), quality(c))).collect();
    for round in 0.. {
        for v in region.free() {
            let i = v as usize;
            region.mesh.set_position(v, between(old[i], goal[i], part[i]));
        }
        let mut bad = vec![false; old.len()];
        let mut any = false;
        for (&(f, face), &(area, shape)) in faces.iter().zip(&before) {
            let sound = is_sound(region.mesh.corners(face), area, shape);
            let was = |g: u32| region.mesh.face(g).map_or([0.0; 3], |face| area_vector(face.map(|v| old[v as usize])));
            if (!sound || folds(region, f, face, &was)) && face.iter().any(|&v| part[v as usize] > 0.0) {
                face.iter().for_each(|&v| bad[v as usize] = true);
                any = true;
            }
        }
        if !any {
            break;
        }
        for (part, _) in part.iter_mut().zip(&bad).filter(|(_, bad)| **bad) {
            *part = if round < HALVINGS { 0.5 * *part } else { 0.0 };
        }
    }
    let moved = |(&a, &b): (&Point, &Point)| distance(a, b);
    old.iter().zip(region.mesh.positions()).map(moved).fold(0.0, f64::max)
}

/// Moves one vertex to `goal`, or half or a quarter of the way, if the faces around it stay in order; returns how far.
pub(super) fn move_one(region: &mut Region, v: u32, goal: Point) -> f64 {
    let start = region.mesh.position(v);
    let around: Vec<(u32, [u32; 3])> =
        region.mesh.faces_of(v).iter().filter_map(|&f| Some((f, region.mesh.face(f)?))).collect();
    let before: Vec<(Point, f64)> =
        around.iter().map(|&(_, face)| region.mesh.corners(face)).map(|c| (area_vector(c), quality(c))).collect();
    for part in PARTS_OF_A_MOVE {
        let position = between(start, goal, part);
        region.mesh.set_position(v, position);
        let was = |g: u32| {
            let old = |w: u32| if w == v { start } else { region.mesh.position(w) };
            region.mesh.face(g).map_or([0.0; 3], |face| area_vector(face.map(old)))
        };
        let sound = around.iter().zip(&before).all(|(&(f, face), &(area, shape))| {
            is_sound(region.mesh.corners(face), area, shape) && !folds(region, f, face, &was)
        });
        if sound {
            return distance(start, position);
        }
    }
    region.mesh.set_position(v, start);
    0.0
}

/// Whether a face that had this area vector and quality is still in order.
fn is_sound(corners: [Point; 3], area: Point, shape: f64) -> bool {
    let new = area_vector(corners);
    let turned = norm(area) > 0.0 && dot(new, area) < TURNED * norm(new) * norm(area);
    !turned && quality(corners) >= MOVED_SLIVER.min(KEPT * shape)
}

/// Whether a dihedral angle at face `f` is too large and was smaller before; `was` gives the area vectors of then.
fn folds(region: &Region, f: u32, face: [u32; 3], was: &dyn Fn(u32) -> Point) -> bool {
    let mesh = &region.mesh;
    let here = mesh.area_vector(f);
    (0..3).any(|i| {
        let Some(wings) = mesh.wings(face[i], face[(i + 1) % 3]) else { return false };
        let other = if wings.faces[0] == f { wings.faces[1] } else { wings.faces[0] };
        let now = angle(here, mesh.area_vector(other));
        now > FOLD_ANGLE && now > angle(was(f), was(other))
    })
}
