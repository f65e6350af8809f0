//! The Hessian by mixed finite elements on the coordinates of space (Stein et al. 2018b):
//! at inner vertices, not intrinsic.
//!
//! Its entry `ij` at vertex `v` is `−∫ ∂_i φ_v ∂_j u / M_v`, with the hat function `φ_v` and gradients in
//! space. Leaving the vertices of the boundary out is what makes the natural boundary conditions.

use crate::block_rows::{BlockRows, BLOCK};
use crate::buckets::Buckets;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::operators::hinge::usable_areas;
use crate::operators::vertex_weights::is_boundary;
use crate::operators::voronoi_mass;
use crate::{memory, Result};

/// Per vertex of a one-ring, the 3 × 3 matrix `∫ ∇φ_v ⊗ ∇φ_w`.
type Ring = Vec<(u32, [[f64; 3]; 3])>;

/// The nine entries `∫ ∂_i φ_v ∂_j u` of the Hessian of Stein et al. 2018b times the mass, at every inner
/// vertex, each a block of its own with one row, since the L1 energy of Stein et al. 2018b, appendix C, sums
/// their absolute values; and the vertex of each block. Entries that are zero for every `u`, as those across
/// a plane of coordinates, have no block.
///
/// # Errors
/// [`MeshError::NoPositions`] for a mesh that is known by its edge lengths only.
pub fn mixed_hessian_rows(mesh: &Mesh) -> Result<(BlockRows, Vec<u32>)> {
    let rings = rings(mesh)?;
    let n_entries = rings.iter().map(|(_, ring)| ring.len()).sum::<usize>();
    let mut rows = BlockRows::with_room(mesh.connectivity().n_vertices(), 9 * rings.len(), 9 * n_entries)?;
    let mut vertices = memory::room(9 * rings.len())?;
    for (v, ring) in rings {
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            if ring.iter().any(|(_, entry)| entry[i][j] != 0.0) {
                rows.push_block(ring.iter().map(|&(w, entry)| (w, [entry[i][j], 0.0, 0.0])));
                vertices.push(v);
            }
        }
    }
    Ok((rows, vertices))
}

/// Rows whose squares sum to `∫ ‖H_u‖²` (Rowe et al. 2024, eq. (1), right, twice), discretized as in Stein et
/// al. 2018b: three blocks of three at every inner vertex, divided by the root of its [`voronoi_mass`]; and
/// the vertex of each block.
///
/// # Errors
/// [`MeshError::NoPositions`] for a mesh that is known by its edge lengths only.
pub fn mixed_hessian_squares(mesh: &Mesh) -> Result<(BlockRows, Vec<u32>)> {
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths())?;
    let rings = rings(mesh)?;
    let (n_blocks, n_entries) =
        (BLOCK * rings.len(), rings.iter().map(|(_, ring)| ring.len()).sum::<usize>());
    let mut rows = BlockRows::with_room(mesh.connectivity().n_vertices(), n_blocks, BLOCK * n_entries)?;
    let mut vertices = memory::room(n_blocks)?;
    for (v, ring) in rings.into_iter().filter(|(v, _)| mass[*v as usize] > 0.0) {
        let scale = 1.0 / mass[v as usize].sqrt();
        for i in 0..BLOCK {
            rows.push_block(ring.iter().map(|&(w, entry)| (w, entry[i].map(|x| scale * x))));
            vertices.push(v);
        }
    }
    Ok((rows, vertices))
}

/// The one-rings of the inner vertices.
fn rings(mesh: &Mesh) -> Result<Vec<(u32, Ring)>> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    let areas = usable_areas(mesh.edge_lengths());
    let boundary = is_boundary(connectivity, &areas);
    let corners = Buckets::new(connectivity.n_vertices(), |visit| {
        for (f, face) in connectivity.faces().iter().enumerate() {
            face.iter().enumerate().for_each(|(c, &v)| visit(v as usize, (f, c)));
        }
    })?;
    let gradient = |(face, area): (&[u32; 3], &f64)| {
        if *area > 0.0 {
            hat_gradients(face.map(|v| positions[v as usize]))
        } else {
            [[0.0; 3]; 3]
        }
    };
    let gradients: Vec<[[f64; 3]; 3]> =
        memory::gathered(connectivity.faces().iter().zip(&areas).map(gradient))?;
    let mut place = memory::repeated(u32::MAX, connectivity.n_vertices())?;
    let mut ring = |v: usize| -> Ring {
        let mut ring: Ring = Vec::new();
        for &(f, c) in corners.of(v) {
            for (&w, gradient) in connectivity.faces()[f].iter().zip(&gradients[f]) {
                let entry = gradients[f][c].map(|x| gradient.map(|y| areas[f] * x * y));
                match ring.get_mut(place[w as usize] as usize).filter(|(other, _)| *other == w) {
                    Some((_, sum)) => {
                        sum.iter_mut().flatten().zip(entry.iter().flatten()).for_each(|(s, e)| *s += e);
                    }
                    None => {
                        place[w as usize] = ring.len() as u32;
                        ring.push((w, entry));
                    }
                }
            }
        }
        ring
    };
    let inner = |v: &usize| !boundary[*v] && corners.of(*v).iter().any(|&(f, _)| areas[f] > 0.0);
    let mut rings = memory::room((0..connectivity.n_vertices()).filter(inner).count())?;
    rings.extend((0..connectivity.n_vertices()).filter(inner).map(|v| (v as u32, ring(v))));
    Ok(rings)
}

/// The gradients in space of the three hat functions of a triangle with an area.
fn hat_gradients(p: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    [0, 1, 2].map(|i| {
        let edge = minus(p[(i + 2) % 3], p[(i + 1) % 3]);
        let up = minus(p[i], p[(i + 1) % 3]);
        // The part of `up` across the edge is the height; the gradient is that over its squared length.
        let along = dot(up, edge) / dot(edge, edge);
        let height = [0, 1, 2].map(|k| up[k] - along * edge[k]);
        let squared = dot(height, height);
        if squared > 0.0 {
            height.map(|x| x / squared)
        } else {
            [0.0; 3]
        }
    })
}
