//! Smooth or sharp: whether the curvature around a hole is spread or concentrated in ridges.

use super::region::Region;
use super::surface::Surface;
use crate::mesh::vector::distance;

/// Edges bent by more than this (radians) can be ridges: 25 degrees. Irregular meshes of a cylinder of 36 edges around reach 20.
const LEAST_ANGLE: f64 = 0.44;

/// A ridge is bent by so many times the root mean square of what remains without the ridges.
const CONTRAST: f64 = 3.0;

/// The least bend of the ridges that reach the hole, if any does: the bend of edges at its rim, not of the patch, that are bent by
/// more than 25 degrees and by far more than edges around the hole commonly are.
///
/// What is common is found by adding the edges of the surroundings from the least bent on, until one is [`CONTRAST`] times as bent
/// as the root mean square (by length) of those before.
pub(super) fn least_ridge(region: &Region) -> Option<f64> {
    let surface = Surface::of(region);
    let mesh = &region.mesh;
    let mut on_rim = vec![false; mesh.n_vertices()];
    region.patch_faces().for_each(|(_, face)| face.into_iter().for_each(|v| on_rim[v as usize] = true));
    let mut edges: Vec<(f64, f64, bool)> = mesh
        .edges()
        .into_iter()
        .filter_map(|[a, b]| {
            let wings = mesh.wings(a, b)?;
            let around = wings.faces.iter().all(|&f| !region.is_patch(f));
            let length = distance(mesh.position(a), mesh.position(b));
            around.then(|| (surface.dihedral(wings.faces), length, on_rim[a as usize] || on_rim[b as usize]))
        })
        .collect();
    edges.sort_by(|x, y| x.0.total_cmp(&y.0));
    let (mut squares, mut length) = (0.0, 0.0);
    for (i, &(angle, l, _)) in edges.iter().enumerate() {
        if length > 0.0 && angle > LEAST_ANGLE && angle > CONTRAST * f64::sqrt(squares / length) {
            return edges[i..].iter().find(|(_, _, at_rim)| *at_rim).map(|(angle, ..)| *angle);
        }
        squares += l * angle * angle;
        length += l;
    }
    None
}
