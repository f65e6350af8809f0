//! Data-dependent flips: edges of the patch turn until they run along the ridge (Dyn, Levin and Rippa 1990).

use super::constants::{EVEN_ANGLE, SWEEPS};
use super::region::Region;
use super::surface::angle;
use crate::memory;
use crate::mesh::vector::{area_vector, distance, quality, Point};
use crate::remesh::editable::key;
use crate::remesh::EditableMesh;
use crate::shape_guard::is_thinned;
use crate::Result;

/// Flips edges of the patch while that lowers `Σ length · |dihedral angle|` over the edge and its four
/// neighbors, and makes no sliver where there was none ([`is_thinned`]). Returns the number of flips.
pub(super) fn flip_along_ridges(region: &mut Region) -> Result<usize> {
    let faces = (region.n_outer as u32..region.mesh.n_faces() as u32).filter_map(|f| region.mesh.face(f));
    let mut edges = memory::sifted(faces.flat_map(|[a, b, c]| [key(a, b), key(b, c), key(c, a)]))?;
    let mut total = 0;
    for _ in 0..SWEEPS {
        edges.sort_unstable();
        edges.dedup();
        let mut next = Vec::new();
        for &[a, b] in &edges {
            if !lowers(region, a, b) {
                continue;
            }
            let Some(wings) = region.mesh.wings(a, b) else { continue };
            if region.mesh.flip(a, b).is_some() {
                total += 1;
                let [c, d] = wings.tips;
                memory::extend(&mut next, 5)?;
                next.extend([key(a, c), key(c, b), key(b, d), key(d, a), key(c, d)]);
            }
        }
        if next.is_empty() {
            break;
        }
        edges = next;
    }
    Ok(total)
}

fn lowers(region: &Region, a: u32, b: u32) -> bool {
    let mesh = &region.mesh;
    let Some(wings) = mesh.wings(a, b) else { return false };
    if !wings.faces.iter().all(|&f| region.is_patch(f)) {
        return false;
    }
    let Some(new) = mesh.flipped(a, b) else { return false };
    let [c, d] = wings.tips;
    let at = |v: u32| mesh.position(v);
    let shape = |face: [u32; 3]| quality(mesh.corners(face));
    let old = [[a, b, c], [b, a, d]];
    let worst = |faces: [[u32; 3]; 2]| shape(faces[0]).min(shape(faces[1]));
    if is_thinned(worst(new), worst(old)) {
        return false;
    }
    let normal = |face: [u32; 3]| area_vector(mesh.corners(face));
    // `new` is [c, a, d] and [d, b, c].
    let (before, after) = (old.map(normal), new.map(normal));
    let (mut cost, mut cost_after) = (
        distance(at(a), at(b)) * angle(before[0], before[1]),
        distance(at(c), at(d)) * angle(after[0], after[1]),
    );
    for (tail, head, old_side, new_side) in [(b, c, 0, 1), (c, a, 0, 0), (a, d, 1, 0), (d, b, 1, 1)] {
        let Some(outside) = across(mesh, tail, head, wings.faces) else { continue };
        let length = distance(at(tail), at(head));
        cost += length * angle(before[old_side], outside);
        cost_after += length * angle(after[new_side], outside);
    }
    // Of two ways of the same cost, the one with the better triangles.
    let slack = EVEN_ANGLE * distance(at(a), at(b)).max(distance(at(c), at(d)));
    cost_after < cost - slack || cost_after < cost + slack && worst(new) > 1.05 * worst(old)
}

/// The area vector of the face beyond an edge of one of `inside`.
fn across(mesh: &EditableMesh, a: u32, b: u32, inside: [u32; 2]) -> Option<Point> {
    let faces = mesh.wings(a, b)?.faces;
    faces.into_iter().find(|f| !inside.contains(f)).map(|f| mesh.area_vector(f))
}
