//! Which edits keep the surface unfolded and its triangles in shape.

use crate::mesh::vector::{add, area_vector, dot, norm, quality, Point};
use crate::remesh::EditableMesh;

/// The least cosine between a face's normal and what it was before an edit: 60 degrees. A fold turns it by more than 90.
pub const LEAST_COSINE: f64 = 0.5;

/// Faces of less quality ([`quality`]) than this count as slivers: a triangle whose height is 0.09 of its longest edge.
/// An edit may make one only if that is better than the worst face before.
pub const SLIVER: f64 = 0.2;

/// Whether faces in shape `new` may replace what had the normal `normal` (of any length) and the least quality `worst`.
fn replaces(new: [Point; 3], normal: Point, worst: f64) -> bool {
    let area = area_vector(new);
    dot(area, normal) > LEAST_COSINE * norm(area) * norm(normal) && quality(new) >= SLIVER.min(worst)
}

/// Whether flipping the edge `a b` is possible ([`EditableMesh::flip`]) and folds nothing: both new faces look the way that
/// the two old ones do on average, to [`LEAST_COSINE`], and no sliver is made where there was none.
#[must_use]
pub fn may_flip(mesh: &EditableMesh, a: u32, b: u32) -> bool {
    let (Some(new), Some(wings)) = (mesh.flipped(a, b), mesh.wings(a, b)) else { return false };
    let old = wings.faces.map(|f| mesh.area_vector(f));
    let worst = worst_quality(mesh, &wings.faces);
    new.iter().all(|&face| replaces(mesh.corners(face), add(old[0], old[1]), worst))
}

/// Whether `v` may move to `position`: no face around it turns by more than [`LEAST_COSINE`], none becomes a sliver that
/// was none.
#[must_use]
pub fn may_move(mesh: &EditableMesh, v: u32, position: Point) -> bool {
    let worst = worst_quality(mesh, mesh.faces_of(v));
    mesh.faces_of(v).iter().all(|&f| moved_face(mesh, f, v, position, worst))
}

/// Whether the edge may collapse into its end `to` at `position`: the connectivity allows it
/// ([`EditableMesh::can_collapse`]), and the faces that stay are in order as for [`may_move`].
#[must_use]
pub fn may_collapse(mesh: &EditableMesh, from: u32, to: u32, position: Point) -> bool {
    let worst = worst_quality(mesh, mesh.faces_of(from)).min(worst_quality(mesh, mesh.faces_of(to)));
    let stays = |v: u32, other: u32| {
        mesh.faces_of(v)
            .iter()
            .all(|&f| mesh.face(f).is_none_or(|face| face.contains(&other)) || moved_face(mesh, f, v, position, worst))
    };
    stays(from, to) && stays(to, from) && mesh.can_collapse(from, to)
}

/// The least quality among `faces`.
fn worst_quality(mesh: &EditableMesh, faces: &[u32]) -> f64 {
    faces.iter().filter_map(|&f| mesh.face(f)).map(|face| quality(mesh.corners(face))).fold(1.0, f64::min)
}

/// Whether face `f` is still in order with its corner `v` at `position`.
fn moved_face(mesh: &EditableMesh, f: u32, v: u32, position: Point, worst: f64) -> bool {
    mesh.face(f).is_none_or(|face| {
        let new = face.map(|w| if w == v { position } else { mesh.position(w) });
        // A face without area has no side that it could turn away from.
        let old = mesh.area_vector(f);
        if norm(old) > 0.0 {
            replaces(new, old, worst)
        } else {
            quality(new) >= SLIVER.min(worst)
        }
    })
}
