//! Shapes of flat sides under little noise: sides of a few rows of faces, as the reveals of windows, which the Hessian cannot see and which
//! hold parallel sides apart.
//!
//! Where the noise is a small part of an edge, the normals of faces tell sides that meet in clear ridges. That the shape is made of such
//! sides is a hypothesis, and is tested: every side must be a plane within the noise, and all borders must be ridges.

use super::constants::{
    ALIKE_NORMALS, CLEAR_RIDGE, FLAT_NOISE, LEAST_MEAN_FACES, NORMAL_ROUNDS, ONE_SIDE, PLANAR, TURNED_SPECK,
    UNCLEAR_SHARE,
};
use super::exact::Planes;
use super::patches::Plane;
use super::surface::{contiguous, members, Surface};
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, distance, norm, scale, unit, Point};

/// The sides of a shape whose noise has this standard deviation, if it is made of flat ones.
pub(super) fn flat_sides(surface: &Surface<'_>, noise: f64) -> Option<Planes> {
    if !(FLAT_NOISE[0]..FLAT_NOISE[1]).contains(&(noise / surface.mean_edge)) {
        return None;
    }
    let normals = averaged(surface);
    let mut partition = Partition::new(surface.n_faces());
    for f in 0..surface.n_faces() {
        for (_, g) in surface.around(f).filter(|&(_, g)| g > f && distance(normals[f], normals[g]) < ONE_SIDE) {
            partition.unite(f as u32, g as u32);
        }
    }
    let roots: Vec<u32> = (0..surface.n_faces() as u32).map(|f| partition.root(f)).collect();
    let mut labels = contiguous(&roots).0;
    give_away_specks(surface, &mut labels, noise);
    let sides = members(&mut labels);
    if surface.n_faces() < LEAST_MEAN_FACES * sides.len() {
        return None;
    }
    let planes: Vec<Plane> = sides.iter().map(|faces| Plane::through(surface, faces)).collect::<Option<_>>()?;
    if planes.iter().any(|plane| plane.spread > PLANAR * noise) {
        return None;
    }
    let (mut unclear, mut total) = (0.0, 0.0);
    for f in 0..surface.n_faces() {
        for (h, g) in surface.around(f).filter(|&(_, g)| labels[g] != labels[f]) {
            let length = surface.lengths[f][h % 3];
            let bend = distance(planes[labels[f] as usize].normal(), planes[labels[g] as usize].normal());
            total += length;
            unclear += if bend < CLEAR_RIDGE { length } else { 0.0 };
        }
    }
    if total <= 0.0 || unclear > UNCLEAR_SHARE * total {
        return None;
    }
    let normals = labels.iter().map(|&label| planes[label as usize].normal()).collect();
    Some(Planes { labels, normals })
}

/// Unit normals averaged over neighbors, by areas and by how alike they are: bilateral filtering (Zheng et al. 2011).
fn averaged(surface: &Surface<'_>) -> Vec<Point> {
    let mut normals: Vec<Point> = (0..surface.n_faces()).map(|f| unit(surface.vector_area(f))).collect();
    for _ in 0..NORMAL_ROUNDS {
        let mean = |f: usize| {
            let near = surface.around(f).map(|(_, g)| {
                let apart = distance(normals[f], normals[g]) / ALIKE_NORMALS;
                scale(normals[g], surface.areas[g] * (-apart * apart).exp())
            });
            let sum = near.fold(scale(normals[f], surface.areas[f]), add);
            if norm(sum) > 0.0 {
                unit(sum)
            } else {
                normals[f]
            }
        };
        normals = (0..surface.n_faces()).map(mean).collect();
    }
    normals
}

/// Gives sides of a face or two to the larger neighbor on whose plane they lie.
fn give_away_specks(surface: &Surface<'_>, labels: &mut Vec<u32>, noise: f64) {
    let sides = members(labels);
    let planes: Vec<Option<Plane>> = sides
        .iter()
        .map(|faces| (faces.len() >= TURNED_SPECK).then(|| Plane::through(surface, faces)).flatten())
        .collect();
    let before = labels.clone();
    for faces in sides.iter().filter(|faces| faces.len() < TURNED_SPECK) {
        let corners = faces.iter().flat_map(|&f| surface.connectivity.faces()[f as usize]);
        let points: Vec<Point> = corners.map(|v| surface.positions[v as usize]).collect();
        let off = |plane: &Plane| points.iter().fold(0.0_f64, |most, &p| most.max(plane.distance(p).abs()));
        let around = faces.iter().flat_map(|&f| surface.around(f as usize)).map(|(_, g)| before[g]);
        let home = around
            .filter_map(|label| Some((off(planes[label as usize].as_ref()?), label)))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some((_, label)) = home.filter(|(off, _)| *off < 2.0 * PLANAR * noise) {
            faces.iter().for_each(|&f| labels[f as usize] = label);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::Mesh;
    use crate::shapes;

    fn sides(mesh: &Mesh, noise: f64) -> Option<usize> {
        let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
        let surface = Surface::new(connectivity, positions, 1.0, vec![[1.0; 3]; connectivity.n_faces()]);
        flat_sides(&surface, noise * surface.mean_edge).map(|planes| contiguous(&planes.labels).1)
    }

    #[test]
    fn a_noisy_cube_has_six() {
        for n in [6, 16] {
            // Uniform noise of that amplitude has 0.58 of it as its standard deviation.
            let cube = shapes::cube(n).noisy(0.08 * 2.0 / n as f64, 3);
            assert_eq!(sides(&cube.mesh().unwrap(), 0.045), Some(6), "{n}");
        }
    }

    #[test]
    fn curved_shapes_have_none() {
        assert_eq!(sides(&shapes::icosphere(3).mesh().unwrap(), 0.02), None);
        assert_eq!(sides(&shapes::icosphere(1).mesh().unwrap(), 0.05), None);
        assert_eq!(sides(&shapes::cylinder(12, 12, 1.0, 3.0).mesh().unwrap(), 0.02), None);
    }
}
