//! Smooth or sharp: whether the curvature around a hole is spread or concentrated in ridges.

use super::region::Region;
use super::surface::Surface;
use crate::mesh::vector::distance;

/// Edges bent by more than this (radians) can be ridges: 20 degrees. Fewer than 18 segments a turn look angular anyway.
const LEAST_ANGLE: f64 = 0.35;

/// A ridge is bent by so many times the root mean square of what remains without the ridges.
const CONTRAST: f64 = 3.0;

/// Whether an edge around the hole is a ridge: bent by more than 20 degrees, and by far more than the others are.
///
/// The other edges are told from ridges by removing the most bent edges one by one, as long as each is [`CONTRAST`] times as
/// bent as the root mean square (by length) of the less bent ones.
pub(super) fn is_sharp(region: &Region) -> bool {
    let surface = Surface::of(region);
    let mesh = &region.mesh;
    let mut edges: Vec<(f64, f64)> = mesh
        .edges()
        .into_iter()
        .filter_map(|[a, b]| {
            let wings = mesh.wings(a, b)?;
            let around = wings.faces.iter().all(|&f| !region.is_patch(f));
            around.then(|| (surface.dihedral(wings.faces), distance(mesh.position(a), mesh.position(b))))
        })
        .collect();
    edges.sort_by(|x, y| x.0.total_cmp(&y.0));
    let (mut squares, mut length) = (0.0, 0.0);
    for (angle, l) in edges {
        if length > 0.0 && angle > LEAST_ANGLE && angle > CONTRAST * f64::sqrt(squares / length) {
            return true;
        }
        squares += l * angle * angle;
        length += l;
    }
    false
}
