//! Where the parts around a hole meet in its patch, and whether its faces lie there in order.

use super::assign::parts_at;
use super::constants::{ARRIVED_SLIVER, DROPPED_EIGENVALUES, NEWTON_STEPS};
use super::parts::SmoothParts;
use super::region::Region;
use crate::linear::small::Quadric;
use crate::mesh::vector::{add, area_vector, centroid, dot, quality, unit, Point};
use crate::shape_guard::{is_turned, TURNED};

/// How good the worst face at `v` is: its quality, or how much it looks along its part,
/// less what is allowed, if that is not enough.
pub(super) fn order(region: &Region, parts: &SmoothParts, labels: &[u32], v: u32) -> f64 {
    let faces = region.mesh.faces_of(v).iter();
    let order = |&f: &u32| {
        let corners = region.mesh.face(f).map(|face| region.mesh.corners(face))?;
        let model = parts.models.get(*labels.get((f as usize).checked_sub(region.n_outer)?)? as usize)?;
        let cosine = dot(unit(area_vector(corners)), model.at(centroid(corners)).1);
        Some(if cosine < TURNED { cosine - TURNED } else { quality(corners) })
    };
    faces.filter_map(order).fold(1.0, f64::min)
}

/// The faces of the patch that are turned away from their part.
pub(super) fn turned(region: &Region, parts: &SmoothParts, labels: &[u32]) -> Vec<u32> {
    let is_turned = |(f, face): (u32, [u32; 3])| {
        let model = parts.models.get(*labels.get((f as usize).checked_sub(region.n_outer)?)? as usize)?;
        let corners = region.mesh.corners(face);
        is_turned(corners, model.at(centroid(corners)).1).then_some(f)
    };
    region.patch_faces().filter_map(is_turned).collect()
}

/// Where the surfaces of the parts that meet at free vertex `v` meet.
pub(super) fn meeting_point(region: &Region, parts: &SmoothParts, labels: &[u32], v: u32) -> Point {
    let own = parts_at(region, parts, labels, v);
    (0..NEWTON_STEPS).fold(region.mesh.position(v), |p, _| add(p, step(parts, &own, p)))
}

/// The shortest step from `p` onto the tangent planes of some parts.
fn step(parts: &SmoothParts, own: &[u32], p: Point) -> Point {
    let mut quadric = Quadric::default();
    for &part in own {
        let (off, normal) = parts.models[part as usize].at(p);
        quadric.add(1.0, normal, -off);
    }
    quadric.nearest(DROPPED_EIGENVALUES)
}

/// Whether all faces lie on their part, and are in order. Noise on the rim turns faces with two vertices
/// there; folds are refused where a patch is taken ([`super::cycles`]).
pub(super) fn has_arrived(region: &Region, parts: &SmoothParts, labels: &[u32], edge: f64) -> bool {
    region.patch_faces().zip(labels).all(|((_, face), &part)| {
        let Some(model) = parts.models.get(part as usize) else { return false };
        let corners = region.mesh.corners(face);
        let is_imposed = face.iter().filter(|&&v| region.is_anchor(v)).count() > 1;
        corners.into_iter().all(|p| parts.has(part, p, edge))
            && (is_imposed || !is_turned(corners, model.at(centroid(corners)).1))
            && quality(corners) > ARRIVED_SLIVER
    })
}
