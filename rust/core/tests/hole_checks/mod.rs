//! Holes cut at random, and what must hold for every filled mesh.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::HashSet;

use ridgeform_core::hole_filling::{faces_at, fill_loops, FillOptions, Patch};
use ridgeform_core::mesh::vector::{area_vector, dot, quality, unit, Point};
use ridgeform_core::mesh::{invariants, report, Connectivity, Mesh, MeshReport};
use ridgeform_core::shapes::{Random, Shape};
use ridgeform_core::{Error, Progress};

/// A patch for each of the loops, or why the first that has none has none.
pub(crate) fn patches_of(
    mesh: &Mesh,
    loops: &[Vec<u32>],
    options: &FillOptions,
) -> Result<Vec<Patch>, Error> {
    let patches = fill_loops(mesh, loops, &faces_at(mesh, loops)?, options, &Progress::new())?;
    Ok(patches.into_iter().collect::<Result<_, _>>()?)
}

/// The mesh with its patches; the connectivity is sound, and nothing is non-manifold,
/// degenerate or double that was not.
pub(crate) fn patched(mesh: &Mesh, patches: &[Patch]) -> Result<Mesh, String> {
    let mut vertices = mesh.positions().unwrap().to_vec();
    let mut faces = mesh.connectivity().faces().to_vec();
    for patch in patches {
        vertices.extend(&patch.vertices);
        faces.extend(&patch.faces);
    }
    let filled = Mesh::new(vertices, faces).unwrap();
    invariants::check(filled.connectivity())?;
    let (before, after) = (report(mesh).unwrap(), report(&filled).unwrap());
    let expected = MeshReport {
        n_components: after.n_components,
        n_boundary_loops: after.n_boundary_loops,
        nonmanifold_vertices: after.nonmanifold_vertices.clone(),
        ..before.clone()
    };
    if after != expected
        || !after.nonmanifold_vertices.iter().all(|v| before.nonmanifold_vertices.contains(v))
    {
        return Err(format!("before {before:?}\nafter {after:?}"));
    }
    Ok(filled)
}

/// How good the faces of patches are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shapeliness {
    /// The least quality of a face.
    pub quality: f64,
    /// The least cosine between the normals of neighbors inside the patches and across their rims.
    pub cosine: f64,
    /// Number of faces.
    pub n_faces: usize,
}

/// The shape of the faces that `filled` has beyond the first `n_old`.
pub(crate) fn shapeliness(filled: &Mesh, n_old: usize) -> Shapeliness {
    let (positions, connectivity) = (filled.positions().unwrap(), filled.connectivity());
    let corners = |f: usize| connectivity.faces()[f].map(|v| positions[v as usize]);
    let normal = |f: usize| unit(area_vector(corners(f)));
    let mut found = Shapeliness { quality: 1.0, cosine: 1.0, n_faces: connectivity.n_faces() - n_old };
    for f in n_old..connectivity.n_faces() {
        found.quality = found.quality.min(quality(corners(f)));
        for h in 3 * f..3 * f + 3 {
            if let Some(twin) = connectivity.twin(h) {
                found.cosine = found.cosine.min(dot(normal(f), normal(twin / 3)));
            }
        }
    }
    found
}

/// A connected set of up to `size` faces around `seed`: a round one where `ragged` is 0,
/// a branching one where it is 1.
pub(crate) fn region(
    connectivity: &Connectivity,
    seed: usize,
    size: usize,
    ragged: f64,
    random: &mut Random,
) -> HashSet<usize> {
    let (mut region, mut front) = (HashSet::from([seed]), vec![seed]);
    while region.len() < size && !front.is_empty() {
        // The oldest of the front keeps the region round, a random one makes it ragged.
        let pick = if random.uniform() < ragged { (random.bits() % front.len() as u64) as usize } else { 0 };
        let f = front.remove(pick);
        for h in 3 * f..3 * f + 3 {
            if let Some(twin) = connectivity.twin(h) {
                if region.len() < size && random.uniform() > 0.3 * ragged && region.insert(twin / 3) {
                    front.push(twin / 3);
                }
            }
        }
    }
    region
}

/// The shape without up to `n_holes` random regions, of up to a tenth of its faces each.
pub(crate) fn with_random_holes(shape: &Shape, n_holes: usize, random: &mut Random) -> Shape {
    let mesh = shape.mesh().unwrap();
    let n_faces = shape.faces.len();
    let mut removed = HashSet::new();
    for _ in 0..n_holes {
        let seed = (random.bits() % n_faces as u64) as usize;
        // From a single face to many, in equal shares by magnitude.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let size = (0.1 * n_faces as f64).powf(random.uniform()) as usize;
        let ragged = random.uniform();
        removed.extend(region(mesh.connectivity(), seed, size.max(1), ragged, random));
    }
    shape.clone().without_faces(|f| removed.contains(&f))
}

/// The positions of a patch's corners.
pub(crate) fn patch_corners<'a>(filled: &'a Mesh, patch: &'a Patch) -> impl Iterator<Item = [Point; 3]> + 'a {
    patch.faces.iter().map(|face| face.map(|v| filled.positions().unwrap()[v as usize]))
}
