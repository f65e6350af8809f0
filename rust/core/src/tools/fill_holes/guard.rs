//! Moves that fold nothing: the vertices of faces that would turn over or become slivers move less far.

use super::constants::{KEPT, MOVED_BEND};
use super::region::Region;
use crate::memory;
use crate::mesh::vector::{area_vector, between, cosine, distance, norm, quality, Point};
use crate::shape_guard::{farthest, is_thinned, is_turned, shorter};
use crate::Result;

/// Moves the free vertices toward `goal` as far as the faces around them stay in order,
/// and returns the longest move.
pub(super) fn move_guarded(region: &mut Region, goal: &[Point]) -> Result<f64> {
    let old = memory::twin(region.mesh.positions())?;
    let mut part =
        memory::sifted((0..old.len() as u32).map(|v| if region.is_anchor(v) { 0.0 } else { 1.0 }))?;
    let faces = memory::sifted(region.patch_faces())?;
    let corners = faces.iter().map(|&(_, face)| region.mesh.corners(face));
    let before = memory::gathered(corners.map(|c| (area_vector(c), quality(c))))?;
    loop {
        for v in region.free() {
            let i = v as usize;
            region.mesh.set_position(v, between(old[i], goal[i], part[i]));
        }
        let mut bad = memory::repeated(false, old.len())?;
        let mut any = false;
        for (&(f, face), &(area, shape)) in faces.iter().zip(&before) {
            let sound = is_sound(region.mesh.corners(face), area, shape);
            let was = |g: u32| {
                region.mesh.face(g).map_or([0.0; 3], |face| area_vector(face.map(|v| old[v as usize])))
            };
            if (!sound || folds(region, f, face, &was)) && face.iter().any(|&v| part[v as usize] > 0.0) {
                face.iter().for_each(|&v| bad[v as usize] = true);
                any = true;
            }
        }
        if !any {
            break;
        }
        part.iter_mut().zip(&bad).filter(|(_, bad)| **bad).for_each(|(part, _)| *part = shorter(*part));
    }
    let moved = |(&a, &b): (&Point, &Point)| distance(a, b);
    Ok(old.iter().zip(region.mesh.positions()).map(moved).fold(0.0, f64::max))
}

/// Moves one vertex to `goal`, or half or a quarter of the way, if the faces around it stay in order;
/// returns how far.
pub(super) fn move_one(region: &mut Region, v: u32, goal: Point) -> f64 {
    let start = region.mesh.position(v);
    let around: Vec<(u32, [u32; 3])> =
        region.mesh.faces_of(v).iter().filter_map(|&f| Some((f, region.mesh.face(f)?))).collect();
    let before: Vec<(Point, f64)> = around
        .iter()
        .map(|&(_, face)| region.mesh.corners(face))
        .map(|c| (area_vector(c), quality(c)))
        .collect();
    let reached = farthest(start, goal, |position| {
        region.mesh.set_position(v, position);
        let was = |g: u32| {
            let old = |w: u32| if w == v { start } else { region.mesh.position(w) };
            region.mesh.face(g).map_or([0.0; 3], |face| area_vector(face.map(old)))
        };
        around.iter().zip(&before).all(|(&(f, face), &(area, shape))| {
            is_sound(region.mesh.corners(face), area, shape) && !folds(region, f, face, &was)
        })
    });
    region.mesh.set_position(v, reached.unwrap_or(start));
    reached.map_or(0.0, |position| distance(start, position))
}

/// Whether a face that had this area vector and quality is still in order.
fn is_sound(corners: [Point; 3], area: Point, shape: f64) -> bool {
    let turned = norm(area) > 0.0 && is_turned(corners, area);
    !turned && !is_thinned(quality(corners), KEPT * shape)
}

/// Whether face `f` and a neighbor bend the surface too much, and more than before;
/// `was` gives the area vectors of then.
fn folds(region: &Region, f: u32, face: [u32; 3], was: &dyn Fn(u32) -> Point) -> bool {
    let mesh = &region.mesh;
    let here = mesh.area_vector(f);
    (0..3).any(|i| {
        let Some(wings) = mesh.wings(face[i], face[(i + 1) % 3]) else { return false };
        let other = if wings.faces[0] == f { wings.faces[1] } else { wings.faces[0] };
        let now = cosine(here, mesh.area_vector(other));
        now < MOVED_BEND && now < cosine(was(f), was(other))
    })
}
