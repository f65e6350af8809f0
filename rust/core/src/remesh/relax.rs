//! Moving vertices along the surface toward their neighbors' center, and back onto the surface.

use rayon::prelude::*;

use crate::memory;
use crate::mesh::vector::{add, between, dot, norm, scale, sub, unit, Point};
use crate::remesh::curves::Role;
use crate::remesh::guard;
use crate::remesh::remesher::Remesher;
use crate::shape_guard::farthest;
use crate::{Progress, Result};

/// Moves every free vertex in its tangent plane to the center of its neighbors, weighted by the area around
/// them over that wanted (Botsch and Kobbelt 2004, with their weights for a graded mesh), then to the closest
/// point of the surface; a vertex on a curve to the middle between its neighbors on it, and to the closest
/// point of the curve.
pub(crate) fn relax_and_project(remesher: &mut Remesher, progress: &Progress) -> Result<()> {
    let n = remesher.mesh.n_vertices() as u32;
    let weights = memory::joined((0..n).into_par_iter().map(|v| {
        let area: f64 = remesher.mesh.faces_of(v).iter().map(|&f| norm(remesher.mesh.area_vector(f))).sum();
        area / remesher.sizing.at(v).powi(2)
    }))?;
    let target_of = |v| if progress.is_stopping() { None } else { target(remesher, &weights, v) };
    let targets = memory::joined((0..n).into_par_iter().map(target_of))?;
    for (v, target) in (0..n).zip(targets) {
        if progress.is_stopping() {
            break;
        }
        let Some((target, near)) = target else { continue };
        let start = remesher.mesh.position(v);
        if let Some(position) = farthest(start, target, |p| guard::may_move(&remesher.mesh, v, p)) {
            remesher.mesh.set_position(v, position);
            remesher.near[v as usize] = near;
        }
    }
    Ok(())
}

/// Where `v` should go, and the triangle of the surface there.
fn target(remesher: &Remesher, weights: &[f64], v: u32) -> Option<(Point, u32)> {
    let mesh = &remesher.mesh;
    if mesh.faces_of(v).is_empty() {
        return None;
    }
    let (p, near) = (mesh.position(v), remesher.near[v as usize]);
    match remesher.roles[v as usize] {
        Role::Fixed | Role::Pinched => None,
        Role::Curve(curve) => {
            let ends: Vec<u32> =
                mesh.neighbors(v).into_iter().filter(|&w| remesher.curves.curve(v, w).is_some()).collect();
            let &[a, b] = ends.as_slice() else { return None };
            Some((remesher.curves.project(curve, between(mesh.position(a), mesh.position(b), 0.5)), near))
        }
        Role::Free => {
            let normal =
                unit(mesh.faces_of(v).iter().fold([0.0; 3], |sum, &f| add(sum, mesh.area_vector(f))));
            let (mut sum, mut total) = ([0.0; 3], 0.0);
            for w in mesh.neighbors(v) {
                let weight = weights[w as usize];
                sum = add(sum, scale(sub(mesh.position(w), p), weight));
                total += weight;
            }
            if total <= 0.0 {
                return None;
            }
            let step = scale(sum, 1.0 / total);
            let tangential = sub(step, scale(normal, dot(step, normal)));
            Some(remesher.surface.project(add(p, tangential), normal, near))
        }
    }
}
