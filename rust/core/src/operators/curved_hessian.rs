//! The curved Hessian energy (Stein et al. 2020a): intrinsic,
//! with natural boundary conditions, `∫ ‖∇du‖² + κ |du|²`.
//!
//! The gradient becomes a Crouzeix-Raviart field `V`: a vector `V_e` at the midpoint of every edge, the mean
//! of the gradients on its two faces by area, unfolded about the edge. Seen from face `f` that is the face's
//! own gradient plus a correction, `V_e = ∇u_f + c_e`, `c_e = A_g / (A_f + A_g) · jump_e · n_e`, with the
//! [`Hinge::jump`] across the edge; so everything is computed face by face, in its frame, without a frame for
//! edges.

use crate::block_rows::{BlockRows, BLOCK};
use crate::mesh::{triangle, Mesh};
use crate::operators::hinge::{directions, usable_areas, Hinge};
use crate::operators::vertex_weights::is_boundary;

/// A linear function of the values at the face's corners 0, 1,
/// 2 and the vertices opposite its halfedges 0, 1, 2.
type Row = [f64; 6];

/// Rows and signed weights with `∫ ‖∇du‖² + κ |du|² = Σ_b weight_b ‖(rows u)_b‖²` (Stein et al. 2020a, eq.
/// (1), twice its energy): five blocks a face. The weights of the last three are the parts of the corners'
/// angle defects that belong to the face, negative where the surface is saddle-shaped; defects at the
/// boundary count as zero.
///
/// The face weights, 1 where none are given, scale all blocks of their face.
#[must_use]
pub fn curved_hessian_squares(mesh: &Mesh, face_weights: Option<&[f64]>) -> (BlockRows, Vec<f64>) {
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let areas = usable_areas(lengths);
    let densities = defect_per_angle(mesh, &areas);
    let mut rows = BlockRows::empty(connectivity.n_vertices());
    let mut weights = Vec::new();
    for (f, corners) in connectivity.faces().iter().enumerate().filter(|(f, _)| areas[*f] > 0.0) {
        let mut vertices = [corners[0], corners[1], corners[2], corners[0], corners[0], corners[0]];
        let hats = hat_gradients(lengths[f]);
        let gradient: [Row; 2] = [0, 1].map(|k| [hats[0][k], hats[1][k], hats[2][k], 0.0, 0.0, 0.0]);
        // Of each component, the rows of the three edges.
        let mut corrections: [[Row; 3]; 2] = [[[0.0; 6]; 3]; 2];
        for (i, direction) in directions(lengths[f], areas[f]).into_iter().enumerate() {
            let Some(twin) = connectivity.twin(3 * f + i).filter(|twin| areas[twin / 3] > 0.0) else {
                continue;
            };
            vertices[3 + i] = connectivity.opposite(twin);
            let share = areas[twin / 3] / (areas[f] + areas[twin / 3]);
            let normal = [-direction[1], direction[0]];
            let jump = Hinge::new(lengths, &areas, 3 * f + i, twin).jump();
            for (place, coefficient) in [(i + 1) % 3, (i + 2) % 3, i, i + 3].into_iter().zip(jump) {
                for (component, n) in corrections.iter_mut().zip(normal) {
                    component[i][place] += share * coefficient * n;
                }
            }
        }
        let mut push = |block: [Row; BLOCK], weight: f64| {
            rows.push_block((0..6).map(|place| (vertices[place], block.map(|row| row[place]))));
            weights.push(face_weights.map_or(1.0, |w| w[f]) * weight);
        };
        // The shape functions are 1 − 2λ_e, so that ∇V = −2 Σ_e c_e ⊗ ∇λ_e;
        // the face's own gradient drops out.
        for component in &corrections {
            let along = |k: usize| sum([0, 1, 2].map(|e| (-2.0 * hats[e][k], component[e])));
            push([along(0), along(1), [0.0; 6]], areas[f]);
        }
        for (i, angle) in triangle::angles(lengths[f]).into_iter().enumerate() {
            let at_corner = |k: usize| -> Row {
                let [a, b, c] = [(i + 1) % 3, (i + 2) % 3, i].map(|e| corrections[k][e]);
                std::array::from_fn(|place| gradient[k][place] + a[place] + b[place] - c[place])
            };
            let block = [at_corner(0), at_corner(1), [0.0; 6]];
            push(block, densities[corners[i] as usize] * angle);
        }
    }
    (rows, weights)
}

fn sum(terms: [(f64, Row); 3]) -> Row {
    std::array::from_fn(|place| terms.iter().map(|(factor, row)| factor * row[place]).sum())
}

/// The gradients of the hat functions in the frame of [`triangle::layout`].
fn hat_gradients(l: [f64; 3]) -> [[f64; 2]; 3] {
    let p = triangle::layout(l);
    let twice_area = p[1][0] * p[2][1];
    [0, 1, 2].map(|i| {
        let (a, b) = (p[(i + 1) % 3], p[(i + 2) % 3]);
        [(a[1] - b[1]) / twice_area, (b[0] - a[0]) / twice_area]
    })
}

/// The angle defect of every vertex over the sum of its angles; 0 at the boundary.
fn defect_per_angle(mesh: &Mesh, areas: &[f64]) -> Vec<f64> {
    let connectivity = mesh.connectivity();
    let mut angle_sums = vec![0.0; connectivity.n_vertices()];
    for (f, corners) in connectivity.faces().iter().enumerate().filter(|(f, _)| areas[*f] > 0.0) {
        for (&corner, angle) in corners.iter().zip(triangle::angles(mesh.edge_lengths()[f])) {
            angle_sums[corner as usize] += angle;
        }
    }
    let boundary = is_boundary(connectivity, areas);
    let defect = |(sum, at_boundary): (f64, bool)| {
        if at_boundary || sum == 0.0 {
            0.0
        } else {
            (std::f64::consts::TAU - sum) / sum
        }
    };
    angle_sums.into_iter().zip(boundary).map(defect).collect()
}
