//! Flipping edges toward regular valences.

use std::f64::consts::FRAC_PI_3;

use crate::memory;
use crate::mesh::lengths_of;
use crate::mesh::triangle;
use crate::mesh::vector::{dot, norm, quality};
use crate::remesh::curves::Role;
use crate::remesh::remesher::Remesher;
use crate::remesh::{guard, EditableMesh};
use crate::shape_guard::SLIVER;
use crate::{Progress, Result};

/// Edges whose faces turn by more than this (40 degrees) carry shape and are not flipped for better valences.
const CARRIES_SHAPE: f64 = 0.766;

/// By how much the worse of two faces must gain in quality for a flip that leaves the valences as good as
/// they were.
const WORTH: f64 = 1.1;

/// Flips edges where that brings the valences of the four vertices closer to regular: 6 inside, on a border
/// one more than the number of 60-degree triangles that fit there (4 on a straight one). Of two equal choices
/// the better triangles.
pub(crate) fn equalize_valences(remesher: &mut Remesher, progress: &Progress) -> Result<()> {
    let borders = borders(remesher)?;
    let targets = target_valences(remesher, &borders)?;
    for [a, b] in remesher.mesh.edges()? {
        if progress.is_stopping() {
            return Ok(());
        }
        if !remesher.is_free(a, b) {
            continue;
        }
        let Some(wings) = remesher.mesh.wings(a, b) else { continue };
        let [c, d] = wings.tips;
        let valence = |v: u32| remesher.mesh.faces_of(v).len() as i32 + i32::from(borders[v as usize]);
        let excess = |v: u32| valence(v) - targets[v as usize];
        let [a_excess, b_excess, c_excess, d_excess] = [a, b, c, d].map(excess);
        let squares = |values: [i32; 4]| values.iter().map(|x| x * x).sum::<i32>();
        let before = squares([a_excess, b_excess, c_excess, d_excess]);
        let after = squares([a_excess - 1, b_excess - 1, c_excess + 1, d_excess + 1]);
        let is_better = after < before || after == before && gain(&remesher.mesh, a, b) > WORTH;
        if is_better && keeps_shape(&remesher.mesh, a, b) && guard::may_flip(&remesher.mesh, a, b) {
            remesher.mesh.flip(a, b);
        }
    }
    Ok(())
}

/// The worse quality of the two faces after a flip over that before; 0 if the edge cannot be flipped.
pub(crate) fn gain(mesh: &EditableMesh, a: u32, b: u32) -> f64 {
    let (Some(new), Some(wings)) = (mesh.flipped(a, b), mesh.wings(a, b)) else { return 0.0 };
    let worst =
        |faces: [[u32; 3]; 2]| faces.map(|face| quality(mesh.corners(face))).into_iter().fold(1.0, f64::min);
    let old = wings.faces.map(|f| mesh.face(f).unwrap_or_default());
    worst(new) / worst(old).max(f64::MIN_POSITIVE)
}

/// Whether the edge lies flat enough to be flipped, or has a face so thin that its normal says nothing.
fn keeps_shape(mesh: &EditableMesh, a: u32, b: u32) -> bool {
    mesh.wings(a, b).is_some_and(|wings| {
        let [m, n] = wings.faces.map(|f| mesh.area_vector(f));
        let is_sliver = |f: u32| mesh.face(f).is_some_and(|face| quality(mesh.corners(face)) < SLIVER);
        dot(m, n) > CARRIES_SHAPE * norm(m) * norm(n) || wings.faces.into_iter().any(is_sliver)
    })
}

/// Whether each vertex is on the border, where it has an edge more than faces.
/// Flips change nothing about that.
fn borders(remesher: &Remesher) -> Result<Vec<bool>> {
    let is_border = |v: u32| remesher.roles[v as usize] != Role::Free && remesher.mesh.is_border(v);
    Ok(memory::sifted((0..remesher.mesh.n_vertices() as u32).map(is_border))?)
}

/// The regular valence of every vertex.
fn target_valences(remesher: &Remesher, borders: &[bool]) -> Result<Vec<i32>> {
    let mesh = &remesher.mesh;
    let mut targets = memory::repeated(6, mesh.n_vertices())?;
    for v in (0..mesh.n_vertices() as u32).filter(|&v| borders[v as usize]) {
        let angle: f64 = mesh
            .faces_of(v)
            .iter()
            .filter_map(|&f| mesh.face(f))
            .map(|face| {
                let corner = face.iter().position(|&w| w == v).unwrap_or(0);
                triangle::angles(lengths_of(&mesh.corners(face)))[corner]
            })
            .sum();
        #[allow(clippy::cast_possible_truncation)]
        let fitting = (angle / FRAC_PI_3).round().max(1.0) as i32;
        targets[v as usize] = fitting + 1;
    }
    Ok(targets)
}
