//! The Hessian against an independent computation in space: the neighbor is rotated about the shared edge
//! into the plane of the face, gradients are least squares fits, centers are computed from positions.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{hessian, Dual};
use ridgeform_core::shapes::{self, Random, Shape};

type V = [f64; 3];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn axpy(a: V, s: f64, b: V) -> V {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}
fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// The gradient of the affine function with values `u` at `p`, within the plane of `p`: the least squares
/// solution of `(p_k − p_0) · g = u_k − u_0` by the normal equations of the two edges.
fn gradient(p: [V; 3], u: [f64; 3]) -> V {
    let (a, b) = (sub(p[1], p[0]), sub(p[2], p[0]));
    let (s, t) = (u[1] - u[0], u[2] - u[0]);
    let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
    let determinant = aa * bb - ab * ab;
    axpy(axpy([0.0; 3], (s * bb - t * ab) / determinant, a), (t * aa - s * ab) / determinant, b)
}

fn center(p: [V; 3], dual: Dual) -> V {
    match dual {
        Dual::Barycentric => [0, 1, 2].map(|k| (p[0][k] + p[1][k] + p[2][k]) / 3.0),
        Dual::Circumcentric | Dual::CircumcentricOrBarycentric => {
            let (a, b) = (sub(p[1], p[0]), sub(p[2], p[0]));
            let n = cross(a, b);
            let (u, v) = (cross(b, n), cross(n, a));
            axpy(axpy(p[0], dot(a, a) / (2.0 * dot(n, n)), u), dot(b, b) / (2.0 * dot(n, n)), v)
        }
    }
}

/// `q`, on the other side of the edge `a b`, turned about it into the plane of `a, b, p`.
fn unfold(q: V, a: V, b: V, p: V) -> V {
    let axis = unit(sub(b, a));
    let inward = unit(axpy(sub(p, a), -dot(sub(p, a), axis), axis));
    let along = dot(sub(q, a), axis);
    let away = axpy(sub(q, a), -along, axis);
    axpy(axpy(a, along, axis), -dot(away, away).sqrt(), inward)
}

/// `(A_f H_f, rounding scale)` of face `f`, entries `xx, xy, yx, yy`,
/// found from positions and the face list alone.
fn reference(shape: &Shape, u: &[f64], f: usize, dual: Dual) -> ([f64; 4], f64) {
    let at = |v: u32| shape.vertices[v as usize];
    let value = |v: u32| u[v as usize];
    let face = shape.faces[f];
    let p = face.map(at);
    let normal = cross(sub(p[1], p[0]), sub(p[2], p[0]));
    let area = 0.5 * dot(normal, normal).sqrt();
    let x = unit(sub(p[1], p[0]));
    let y = cross(unit(normal), x);
    let (mut h, mut scale) = ([0.0; 4], 0.0);
    for i in 0..3 {
        let (a, b) = (face[(i + 1) % 3], face[(i + 2) % 3]);
        let across = shape
            .faces
            .iter()
            .find_map(|g| (0..3).find(|&k| g[k] == b && g[(k + 1) % 3] == a).map(|k| g[(k + 2) % 3]));
        let Some(o) = across else { continue };
        let q = [at(b), at(a), unfold(at(o), at(a), at(b), at(face[i]))];
        let (g_face, g_neighbor) = (gradient(p, face.map(value)), gradient(q, [b, a, o].map(value)));
        let delta = sub(g_neighbor, g_face);
        let dual_edge = sub(center(q, dual), center(p, dual));
        let length = dot(dual_edge, dual_edge).sqrt();
        let t = unit(dual_edge);
        let frame = [dot(t, x), dot(t, y)];
        for (k, entry) in h.iter_mut().enumerate() {
            *entry += area * dot(delta, t) / length * frame[k / 2] * frame[k % 2];
        }
        scale += area * (dot(g_face, g_face).sqrt() + dot(g_neighbor, g_neighbor).sqrt()) / length;
    }
    (h, scale)
}

fn assert_matches(shape: &Shape, seed: u64, dual: Dual) {
    let mesh: Mesh = shape.mesh().unwrap();
    let mut random = Random::new(seed);
    let u: Vec<f64> = shape.vertices.iter().map(|_| random.symmetric()).collect();
    let h = hessian(&mesh, dual).unwrap();
    let product = &h * &sprs::CsVec::new(u.len(), (0..u.len()).collect(), u.clone());
    for f in 0..shape.faces.len() {
        let (expected, scale) = reference(shape, &u, f, dual);
        for (k, e) in expected.into_iter().enumerate() {
            let found = product.get(4 * f + k).copied().unwrap_or(0.0);
            assert!(
                (found - e).abs() <= 1e-12 * scale,
                "face {f}, entry {k}: {found} against {e}, scale {scale}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        ..ProptestConfig::default()
    })]

    #[test]
    fn noisy_shapes_match_the_computation_in_space(seed in any::<u64>(), amplitude in 0.0..0.2_f64) {
        let torus = shapes::torus(8, 6, 2.0, 0.8);
        for shape in [shapes::icosphere(1), shapes::cube(3), torus, shapes::grid(4, 5)] {
            // Circumcentric duals exist almost everywhere, once the shape is irregular.
            let noisy = shape.noisy(amplitude + 0.05, seed);
            assert_matches(&noisy, seed ^ 1, Dual::Barycentric);
            assert_matches(&shapes::tetrahedron().noisy(amplitude, seed), seed, Dual::Barycentric);
        }
        assert_matches(&shapes::icosphere(1).noisy(0.3 * amplitude, seed), seed, Dual::Circumcentric);
    }
}
