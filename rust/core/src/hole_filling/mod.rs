//! Filling holes: which boundary loops are holes, and a triangulated patch for each,
//! at the resolution of its rim.
//!
//! 1. [`find_holes`] lists the boundary loops, says which is the outer border of an open sheet and which
//!    cannot be filled and why ([`Refusal`]).
//! 2. [`fill_loops`] makes the patches: a triangulation of minimum weight [Liepa
//!    2003], his refinement, and isotropic remeshing of the patch alone [Botsch and Kobbelt 2004].
//!
//! ```text
//! find_holes(mesh: &Mesh) -> Result<Vec<Hole>>
//! faces_at(mesh: &Mesh, loops: &[Vec<u32>]) -> Result<Vec<u32>>
//! fill_loops(mesh: &Mesh, loops: &[Vec<u32>], at: &[u32], options: &FillOptions, progress: &Progress)
//!     -> Result<Vec<Result<Patch, MeshError>>>
//! ```
//!
//! The mesh with its patches is its vertices, then those of each patch; its faces, then those of each patch.
//! Vertices on the rim are the mesh's own and do not move. No patch makes an edge that the mesh or another
//! patch has.

mod apart;
mod components;
mod hole;
mod islands;
mod lids;
mod long_loops;
mod loops;
mod options;
mod patch;
mod places;
mod polygon;
mod refinement;
mod rims;
mod triangulation;

pub use hole::{Hole, Patch};
pub use loops::find_holes;
pub(crate) use loops::holes_of;
pub use options::{FillOptions, Lids};
pub use rims::faces_at;

use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{area_vector, distance, norm, Point};
use crate::mesh::Mesh;
use crate::{Error, Progress, Result};
use polygon::Polygon;
use rims::Rims;

/// A rim encloses nothing if its triangulation has less than this part of its squared length in area:
/// rounding alone.
const NO_EXTENT: f64 = 1e-13;

/// Fills holes, each given as the vertices around it in either direction, without repeats ([`find_holes`]),
/// with the faces at them ([`faces_at`]) or at more than those. For each a patch, or
/// [`MeshError::Unfillable`] with the reason.
///
/// # Errors
/// [`MeshError::NoPositions`]; [`crate::Error::Cancelled`].
pub fn fill_loops(
    mesh: &Mesh,
    loops: &[Vec<u32>],
    at: &[u32],
    options: &FillOptions,
    progress: &Progress,
) -> Result<Vec<std::result::Result<Patch, MeshError>>> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let mut rims = Rims::new(mesh, loops, at)?;
    let mut n_vertices = positions.len() as u32;
    let mut patches = Vec::with_capacity(loops.len());
    for rim in loops {
        patches.push(match fill_one(positions, rim, &rims, options, n_vertices, progress) {
            Ok(patch) => {
                rims.add(&patch);
                n_vertices += patch.vertices.len() as u32;
                Ok(patch)
            }
            Err(Error::Mesh(refused)) => Err(refused),
            Err(error) => return Err(error),
        });
    }
    Ok(patches)
}

/// One patch, its new vertices numbered from `first_new` on.
fn fill_one(
    positions: &[Point],
    rim: &[u32],
    rims: &Rims,
    options: &FillOptions,
    first_new: u32,
    progress: &Progress,
) -> Result<Patch> {
    let vertex = rim.first().copied().unwrap_or(0);
    let refused = |reason: Refusal| MeshError::Unfillable { vertex, n_edges: rim.len(), reason };
    progress.check()?;
    let polygon = Polygon::new(positions, rim, rims).map_err(refused)?;
    let n = polygon.len();
    let number = |local: u32| {
        polygon.vertices.get(local as usize).copied().unwrap_or_else(|| first_new + local - n as u32)
    };
    let patch = |mut vertices, mut faces: Vec<[u32; 3]>, is_flat, lid_normal| {
        apart::keep_apart(&polygon, rims, &mut vertices, &mut faces)?;
        faces.iter_mut().for_each(|face| *face = face.map(number));
        Ok(Patch { vertices, faces, is_flat, lid_normal })
    };
    let lid_normal = lids::normal(&polygon);
    if options.lids == Lids::Always || options.lids == Lids::Planar && lid_normal.is_some() {
        let lid = lids::lid(&polygon, rims, options, options.lids == Lids::Always, progress)?;
        if let Some((vertices, faces)) = lid {
            return patch(vertices, faces, true, lid_normal);
        }
    }
    let flat = long_loops::triangulate(&polygon, rims, progress)?;
    progress.check()?;
    let points: Vec<Point> = polygon.points.iter().chain(&flat.extra).copied().collect();
    let area: f64 = flat.faces.iter().map(|face| norm(area_vector(face.map(|v| points[v as usize])))).sum();
    let length: f64 = (0..n).map(|i| distance(points[i], points[(i + 1) % n])).sum();
    if area <= NO_EXTENT * length * length {
        return Err(refused(Refusal::NoExtent).into());
    }
    let (vertices, faces) = if options.refine {
        patch::refined(&polygon, &flat, rims, options, progress)?
    } else {
        (flat.extra, flat.faces)
    };
    patch(vertices, faces, false, lid_normal)
}
