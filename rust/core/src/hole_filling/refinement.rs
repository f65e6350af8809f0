//! Refining a coarse patch until its edges are as long as wanted [Liepa 2003, section 4].

use std::f64::consts::{PI, SQRT_2};

use crate::memory;
use crate::mesh::vector::{centroid, distance, dot, norm, quality};
use crate::mesh::{lengths_of, triangle};
use crate::remesh::guard;
use crate::remesh::{budget, EditableMesh};
use crate::shape_guard::{SLIVER, TURNED};
use crate::{Progress, Result};

/// A face is split if its center is this much farther from each corner than the lengths wanted there:
/// Liepa's density factor.
const DENSITY: f64 = SQRT_2;

/// A face that is split leaves three whose longest edges are two thirds as long, or are flipped: so many
/// rounds make any length that double precision holds of any other.
const ROUNDS: usize = 100;

/// Flips past this many an edge are rounding, not progress.
const FLIPS_PER_EDGE: usize = 20;

/// Two angles opposite an edge must exceed π by this for a flip,
/// so that four points on a circle do not flip forever.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Inserts vertices at the centers of faces that are too large and flips edges to be Delaunay,
/// in turns, until no face is.
///
/// `sizes` is the length wanted at every vertex; `size_between` gives that at a new one from those at the
/// corners of its face and its distances from them. The mesh is to have about `most` faces at most; where
/// lengths are wanted that coordinates cannot tell apart, or that no patch of so many faces has, it ends with
/// longer ones.
pub(super) fn refine(
    mesh: &mut EditableMesh,
    sizes: &mut Vec<f64>,
    size_between: impl Fn([f64; 3], [f64; 3]) -> f64,
    most: usize,
    progress: &Progress,
) -> Result<()> {
    flip_to_delaunay(mesh)?;
    let wanted = |(_, face): (u32, [u32; 3])| {
        (mesh.corners(face), face.map(|v| sizes[v as usize]).iter().sum::<f64>() / 3.0)
    };
    let limit = mesh.n_faces() + budget::faces_to_add(mesh.faces().map(wanted), most);
    for _ in 0..ROUNDS {
        progress.check()?;
        let mut split_any = false;
        for f in 0..mesh.n_faces() as u32 {
            let Some(face) = mesh.face(f) else { continue };
            let corners = mesh.corners(face);
            let center = centroid(corners);
            let far = corners.map(|corner| distance(corner, center));
            let size = size_between(face.map(|v| sizes[v as usize]), far);
            let is_far = |i: usize| DENSITY * far[i] > size && DENSITY * far[i] > sizes[face[i] as usize];
            if mesh.n_faces() < limit && (0..3).all(is_far) && mesh.split_face(f, center)?.is_some() {
                memory::push(sizes, size)?;
                split_any = true;
            }
        }
        if !split_any {
            return Ok(());
        }
        flip_to_delaunay(mesh)?;
    }
    Ok(())
}

/// Flips edges whose opposite angles sum to more than π,
/// unless that folds the surface or makes its faces worse.
fn flip_to_delaunay(mesh: &mut EditableMesh) -> Result<()> {
    let mut stack = mesh.edges()?;
    let mut left = FLIPS_PER_EDGE * stack.len();
    while let Some([a, b]) = stack.pop() {
        let Some(wings) = mesh.wings(a, b) else { continue };
        if left > 0
            && excess(mesh, a, b) > ANGLE_TOLERANCE
            && is_flat(mesh, wings.faces)
            && guard::may_flip(mesh, a, b)
        {
            left -= 1;
            mesh.flip(a, b);
            memory::extend(&mut stack, 4)?;
            stack.extend([a, b].into_iter().flat_map(|v| wings.tips.map(|tip| [v, tip])));
        }
    }
    Ok(())
}

/// By how much the angles opposite the edge exceed π.
fn excess(mesh: &EditableMesh, a: u32, b: u32) -> f64 {
    let angle = |tip: u32| {
        let lengths = lengths_of(&mesh.corners([tip, a, b]));
        triangle::angles(lengths)[0]
    };
    mesh.wings(a, b).map_or(-1.0, |wings| wings.tips.into_iter().map(angle).sum::<f64>() - PI)
}

/// Whether the two faces turn by no more than [`TURNED`], so that their edge is the patch's mesh, not its
/// shape, or one of them is so thin that its normal says nothing.
fn is_flat(mesh: &EditableMesh, faces: [u32; 2]) -> bool {
    let [m, n] = faces.map(|f| mesh.area_vector(f));
    let thin = |f: u32| mesh.face(f).is_some_and(|face| quality(mesh.corners(face)) < SLIVER);
    dot(m, n) > TURNED * norm(m) * norm(n) || faces.into_iter().any(thin)
}
