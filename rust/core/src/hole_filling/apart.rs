//! No edge of a patch is one that the mesh or the patch has already.
//!
//! A triangulation is made of places along a rim, and a rim that touches itself passes a vertex at several of
//! them: edges between different places may be one edge between vertices, with four faces. No choice of
//! chords rules that out, as the other end may be any point of the patch.

use std::collections::HashSet;

use super::polygon::Polygon;
use super::rims::Rims;
use crate::memory;
use crate::mesh::vector::{between, Point};
use crate::remesh::editable::key;
use crate::Result;

/// Splits edges in their middle until every one is there once: all edges at a new point are new.
/// Faces are given as places in the polygon; places from its length on are those of the points in `extra`.
pub(super) fn keep_apart(
    polygon: &Polygon,
    rims: &Rims,
    extra: &mut Vec<Point>,
    faces: &mut Vec<[u32; 3]>,
) -> Result<()> {
    let n = polygon.len() as u32;
    loop {
        let again = made_again(polygon, rims, faces)?;
        if again.is_empty() {
            return Ok(());
        }
        for [a, b] in again {
            let place = |v: u32| match polygon.points.get(v as usize) {
                Some(&point) => point,
                None => extra[(v - n) as usize],
            };
            let (middle, new) = (between(place(a), place(b), 0.5), n + extra.len() as u32);
            memory::push(extra, middle)?;
            for f in 0..faces.len() {
                let face = faces[f];
                if face.contains(&a) && face.contains(&b) {
                    let with = |gone: u32| face.map(|v| if v == gone { new } else { v });
                    faces[f] = with(a);
                    memory::push(faces, with(b))?;
                }
            }
        }
    }
}

/// The edges inside the patch, smaller place first, that are one with its rim, with an edge of the mesh, or
/// with an edge of the patch before them; ascending.
fn made_again(polygon: &Polygon, rims: &Rims, faces: &[[u32; 3]]) -> Result<Vec<[u32; 2]>> {
    let n = polygon.len() as u32;
    let is_rim = |&[a, b]: &[u32; 2]| b < n && (a + 1 == b || a == 0 && b + 1 == n);
    // Vertices of the mesh come before the points that are new.
    let name = |v: u32| polygon.vertices.get(v as usize).map_or((1, v), |&vertex| (0, vertex));
    let mut edges = memory::room(3 * faces.len())?;
    edges.extend(faces.iter().flat_map(|&[a, b, c]| [key(a, b), key(b, c), key(c, a)]));
    edges.sort_unstable();
    edges.dedup();
    let mut named = HashSet::new();
    memory::extend_set(&mut named, edges.len())?;
    let mut is_made = |&[a, b]: &[u32; 2]| {
        let (x, y) = (name(a), name(b));
        let is_taken = x.0 == 0 && y.0 == 0 && rims.is_taken(x.1, y.1);
        x == y || is_taken || !named.insert((x.min(y), x.max(y)))
    };
    Ok(memory::sifted(edges.into_iter().filter(|edge| !is_rim(edge) && is_made(edge)))?)
}
