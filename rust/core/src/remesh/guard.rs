//! Which edits keep the surface unfolded and its triangles in shape.

use crate::mesh::vector::{add, area_vector, cosine, norm, quality, Point};
use crate::remesh::{Edge, EditableMesh};
use crate::shape_guard::{is_thinned, is_turned};

/// Faces that remeshing makes bend by no more than a right angle, or than what was there: it follows a
/// surface, and ridges of it are curves. With the limit of moves, the ridge of a cylinder's rim came back 8 %
/// farther off (holes of the benchmark), and the thinnest face at a cube's corner had a quality of 0.64
/// instead of 0.68.
const BENT: f64 = 0.0;

/// An edit that turns no face by more than this (11 degrees) bends hardly anything, and is not looked at for
/// bends unless that is asked for: it would take a quarter more time.
const HARDLY_TURNED: f64 = 0.98;

/// Whether faces in shape `new` may replace what had the normal `normal` (of any length) and the least
/// quality `worst`.
fn replaces(new: [Point; 3], normal: Point, worst: f64) -> bool {
    !is_turned(new, normal) && !is_thinned(quality(new), worst)
}

/// Whether flipping the edge `a b` is possible ([`EditableMesh::flip`]) and folds nothing: both new faces
/// look the way that the two old ones do on average ([`is_turned`]), no edge around them bends by more than a
/// right angle that did not bend so before, and no sliver is made where there was none.
#[must_use]
pub fn may_flip(mesh: &EditableMesh, a: u32, b: u32) -> bool {
    let (Some(new), Some(wings)) = (mesh.flipped(a, b), mesh.wings(a, b)) else { return false };
    let old = wings.faces.map(|f| mesh.area_vector(f));
    let worst = worst_quality(mesh, &wings.faces);
    if !new.iter().all(|&face| replaces(mesh.corners(face), add(old[0], old[1]), worst)) {
        return false;
    }
    // The outer edges in the direction of the quadrilateral, with the face on each before and after.
    let [left, right] = wings.tips;
    let outer = [(b, left, 0, 1), (left, a, 0, 0), (a, right, 1, 0), (right, b, 1, 1)];
    let after = new.map(|face| area_vector(mesh.corners(face)));
    let (mut before, mut bend) = (cosine(old[0], old[1]), cosine(after[0], after[1]));
    for (tail, head, was, is) in outer {
        if let Some(across) = mesh.normal_across(tail, head) {
            before = before.min(cosine(across, old[was]));
            bend = bend.min(cosine(across, after[is]));
        }
    }
    bend >= before.min(BENT)
}

/// Whether `v` may move to `position`: no face around it turns away ([`is_turned`]), none becomes a sliver
/// that was none, and none comes to lie at more than a right angle to a neighbor if none did before.
#[must_use]
pub fn may_move(mesh: &EditableMesh, v: u32, position: Point) -> bool {
    keeps_shape(mesh, &[v], &[v], position)
}

/// Whether the edge may collapse into its end `to` at `position`: the connectivity allows it
/// ([`EditableMesh::can_collapse`]), and the faces that stay are in order as for [`may_move`]. Into a hub,
/// edges collapse to where it is, so that its other faces need not be looked at.
#[must_use]
pub fn may_collapse(mesh: &EditableMesh, from: u32, to: u32, position: Point) -> bool {
    let is_kept = mesh.is_hub(to) && position == mesh.position(to);
    let ends = [from, to];
    keeps_shape(mesh, &ends[..2 - usize::from(is_kept)], &ends, position) && mesh.can_collapse(from, to)
}

/// Whether the faces around the `moved` of `vertices` are in order once these are all at `position`; faces
/// with two of them are gone then.
fn keeps_shape(mesh: &EditableMesh, moved: &[u32], vertices: &[u32], position: Point) -> bool {
    let faces =
        || moved.iter().flat_map(|&v| mesh.faces_of(v)).filter_map(|&f| mesh.face(f).map(|face| (f, face)));
    let worst = faces().map(|(_, face)| quality(mesh.corners(face))).fold(1.0, f64::min);
    let mut least = 1.0_f64;
    for (f, face) in faces() {
        if face.iter().filter(|v| vertices.contains(v)).count() > 1 {
            continue;
        }
        let new = face.map(|v| if vertices.contains(&v) { position } else { mesh.position(v) });
        let old = mesh.area_vector(f);
        // A face without area has no side that it could turn away from.
        if norm(old) > 0.0 && is_turned(new, old) || is_thinned(quality(new), worst) {
            return false;
        }
        least = least.min(cosine(area_vector(new), old));
    }
    least > HARDLY_TURNED && !mesh.looks_at_every_bend()
        || bend_after(mesh, moved, vertices, position) >= bend_before(mesh, moved).min(BENT)
}

/// The least cosine between the normals of neighbors anywhere, those beyond borders included.
#[must_use]
pub fn worst_bend(mesh: &EditableMesh) -> f64 {
    least_cosine(mesh, 0..mesh.n_faces() as u32)
}

/// The least cosine between these faces and their neighbors.
pub fn worst_bend_of(mesh: &EditableMesh, faces: impl Iterator<Item = u32>) -> f64 {
    least_cosine(mesh, faces)
}

/// The least cosine between neighbors among the faces around `vertices` and those next to them.
fn bend_before(mesh: &EditableMesh, vertices: &[u32]) -> f64 {
    least_cosine(mesh, vertices.iter().flat_map(|&v| mesh.faces_of(v)).copied())
}

fn least_cosine(mesh: &EditableMesh, faces: impl Iterator<Item = u32>) -> f64 {
    let mut least = 1.0_f64;
    for f in faces {
        let Some([a, b, c]) = mesh.face(f) else { continue };
        for (tail, head) in [(a, b), (b, c), (c, a)] {
            if let Some(across) = mesh.normal_across(tail, head) {
                least = least.min(cosine(across, mesh.area_vector(f)));
            }
        }
    }
    least
}

/// The same around the `moved` of `vertices` once these are all at `position`.
fn bend_after(mesh: &EditableMesh, moved: &[u32], vertices: &[u32], position: Point) -> f64 {
    let merged = |v: u32| if vertices.contains(&v) { vertices[0] } else { v };
    // The faces that stay, as they are named now and then, with their area vectors then.
    let stay: Vec<([u32; 3], [u32; 3], Point)> = moved
        .iter()
        .flat_map(|&v| mesh.faces_of(v))
        .filter_map(|&f| mesh.face(f))
        .filter(|face| face.iter().filter(|v| vertices.contains(v)).count() == 1)
        .map(|face| {
            let corners = face.map(|v| if vertices.contains(&v) { position } else { mesh.position(v) });
            (face, face.map(merged), area_vector(corners))
        })
        .collect();
    // Where a face between two of the vertices goes, what lay beyond its border is next to the face that
    // comes to that border.
    let beyond = |tail: u32, head: u32| {
        let names = |v: u32| if vertices.contains(&v) { vertices.to_vec() } else { vec![v] };
        let borders = names(tail).into_iter().flat_map(|t| names(head).into_iter().map(move |h| (t, h)));
        let is_outer =
            |&(t, h): &(u32, u32)| (t, h) == (tail, head) && !vertices.contains(&t) && !vertices.contains(&h);
        borders
            .filter(|pair| is_outer(pair) || matches!(mesh.edge(pair.0, pair.1), Edge::Border(..)))
            .find_map(|(t, h)| mesh.normal_across(t, h))
    };
    // Across the edges of the vertices that do not move lie faces that stay as they are.
    let unmoved = |tail: u32, head: u32| {
        let other = match vertices[0] {
            name if name == tail => head,
            name if name == head => tail,
            _ => return None,
        };
        vertices.iter().filter(|v| !moved.contains(v)).find_map(|&v| {
            let stays = |&f: &u32| mesh.face(f).is_some_and(|face| !face.iter().any(|w| moved.contains(w)));
            mesh.wings(v, other)?.faces.into_iter().find(stays).map(|f| mesh.area_vector(f))
        })
    };
    // Found by their directed edges, also around a hub with ten thousand faces.
    let mut by_edge: Vec<([u32; 2], u32)> = (0..)
        .zip(&stay)
        .flat_map(|(s, (_, then, _))| (0..3).map(move |k| ([then[k], then[(k + 1) % 3]], s)))
        .collect();
    by_edge.sort_unstable();
    let area_at = |edge: [u32; 2]| {
        let first = by_edge.partition_point(|&(other, _)| other < edge);
        by_edge.get(first).filter(|(other, _)| *other == edge).map(|&(_, s)| stay[s as usize].2)
    };
    let mut least = 1.0_f64;
    for (face, then, area) in &stay {
        for i in 0..3 {
            let (tail, head) = (then[i], then[(i + 1) % 3]);
            let across = area_at([head, tail])
                .or_else(|| unmoved(tail, head))
                .or_else(|| beyond(face[i], face[(i + 1) % 3]));
            if let Some(across) = across {
                least = least.min(cosine(across, *area));
            }
        }
    }
    least
}

/// The least quality among `faces`.
fn worst_quality(mesh: &EditableMesh, faces: &[u32]) -> f64 {
    faces.iter().filter_map(|&f| mesh.face(f)).map(|face| quality(mesh.corners(face))).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::f64::consts::TAU;

    use super::*;

    /// A vertex with `n` faces, and a ring of squares around them, all bumpy.
    fn hub(n: u32) -> EditableMesh {
        let at = |i: u32, radius: f64| {
            let angle = TAU * f64::from(i) / f64::from(n);
            [radius * angle.cos(), radius * angle.sin(), 0.05 * (37.0 * angle).sin() - 0.2 * radius]
        };
        let rings = (0..n).map(|i| at(i, 1.0)).chain((0..n).map(|i| at(i, 2.0)));
        let vertices = std::iter::once([0.0; 3]).chain(rings).collect();
        let faces = (0..n).flat_map(|i| {
            let (here, next) = (1 + i, 1 + (i + 1) % n);
            [[0, here, next], [here, n + here, n + next], [here, n + next, next]]
        });
        EditableMesh::new(vertices, faces.collect()).unwrap()
    }

    #[test]
    fn what_bends_at_a_hub_is_told_by_the_faces_that_come_to_it() {
        let mesh = hub(300);
        assert!(mesh.is_hub(0) && !mesh.is_hub(1) && !hub(200).is_hub(0));
        let mut count = 0;
        for from in 1..=300 {
            let mut after = mesh.twin().unwrap();
            if !after.collapse(from, 0, mesh.position(0)) {
                continue;
            }
            count += 1;
            let stay = mesh.faces_of(from).iter().copied().filter(|&f| after.face(f).is_some());
            let found = bend_after(&mesh, &[from], &[from, 0], mesh.position(0));
            assert_eq!(found.to_bits(), worst_bend_of(&after, stay).to_bits());
        }
        assert_eq!(count, 300);
    }
}
