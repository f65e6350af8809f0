//! What the surface Hessian must satisfy exactly.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use ridgeform_core::error::MeshError;
use ridgeform_core::mesh::{edge_lengths, triangle, Mesh};
use ridgeform_core::operators::{hessian, hessian_norm, Dual, Energy, EnergyForm};
use ridgeform_core::shapes::{self, Random, Shape};

/// `H u` of a scalar function given at the vertices.
fn hessian_of(mesh: &Mesh, u: &[f64], dual: Dual) -> Vec<[f64; 4]> {
    let h = hessian(mesh, dual).unwrap();
    let entries: Vec<f64> =
        h.outer_iterator().map(|row| row.iter().map(|(c, v)| v * u[c]).sum::<f64>()).collect();
    entries.chunks_exact(4).map(|e| [e[0], e[1], e[2], e[3]]).collect()
}

/// The sum of the absolute values that cancel in each entry of `H u`: the scale of its rounding error.
fn magnitude(mesh: &Mesh, u: &[f64], dual: Dual) -> f64 {
    let h = hessian(mesh, dual).unwrap();
    h.outer_iterator().map(|row| row.iter().map(|(c, v)| (v * u[c]).abs()).sum::<f64>()).fold(0.0, f64::max)
}

fn largest(entries: &[[f64; 4]]) -> f64 {
    entries.iter().flatten().fold(0.0, |a, x| a.max(x.abs()))
}

fn at_vertices(shape: &Shape, u: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    shape.vertices.iter().map(|&p| u(p)).collect()
}

/// A flat grid with irregular triangles.
fn irregular_sheet(n: usize, seed: u64) -> Shape {
    shapes::grid(n, n).noisy(0.3, seed).map(|[x, y, _]| [x, y, 0.0])
}

#[test]
fn affine_functions_on_a_flat_mesh_have_no_hessian() {
    for dual in [Dual::Barycentric, Dual::Circumcentric] {
        let shape = irregular_sheet(12, 1);
        let u = at_vertices(&shape, |[x, y, _]| 3.0 * x - 2.0 * y + 5.0);
        let mesh = shape.rotated([1.0, 2.0, 3.0], 0.7).mesh().unwrap();
        assert!(largest(&hessian_of(&mesh, &u, dual)) <= 4e-15 * magnitude(&mesh, &u, dual));
    }
}

#[test]
fn constants_have_no_hessian_on_any_mesh() {
    for shape in [
        shapes::icosphere(2).noisy(0.05, 2),
        shapes::cube(4),
        shapes::torus(9, 7, 2.0, 0.7),
        shapes::tetrahedron(),
    ] {
        let mesh = shape.mesh().unwrap();
        let u = vec![1.0; shape.vertices.len()];
        let scale = magnitude(&mesh, &u, Dual::Barycentric);
        assert!(scale > 0.1);
        assert!(largest(&hessian_of(&mesh, &u, Dual::Barycentric)) <= 1e-15 * scale);
    }
}

#[test]
fn quadratics_on_the_equilateral_lattice_give_one_and_a_half_times_their_hessian() {
    let shape = shapes::lattice(9, 8);
    let mesh = shape.mesh().unwrap();
    let area = 0.75_f64.sqrt() / 2.0;
    for dual in [Dual::Barycentric, Dual::Circumcentric] {
        for (a, b, c) in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.3, -0.8, 1.7)] {
            let u = at_vertices(&shape, |[x, y, _]| a * x * x + b * x * y + c * y * y);
            let inner: f64 = (2.0 * a).hypot(2.0 * c).hypot(b * 2.0_f64.sqrt());
            let mut n_inner = 0;
            for (f, h) in hessian_of(&mesh, &u, dual).iter().enumerate() {
                if (0..3).all(|i| mesh.connectivity().twin(3 * f + i).is_some()) {
                    n_inner += 1;
                    let norm = h.iter().map(|x| x * x).sum::<f64>().sqrt() / area;
                    assert!((norm - 1.5 * inner).abs() < 1e-12, "{norm} {inner}");
                    // The trace does not depend on the face's frame.
                    assert!(((h[0] + h[3]) / area - 1.5 * (2.0 * a + 2.0 * c)).abs() < 1e-12);
                }
            }
            assert!(n_inner > 80);
        }
    }
}

#[test]
fn degenerate_faces_have_zero_rows_and_nothing_is_nan() {
    let mut shape = shapes::icosphere(1);
    let n = shape.vertices.len() as u32;
    shape.faces.extend([[0, 0, 5], [1, 1, 1], [2, n, n + 1]]);
    shape.vertices.extend([shape.vertices[2], shape.vertices[3]]);
    let mesh = shape.mesh().unwrap();
    let h = hessian(&mesh, Dual::Barycentric).unwrap();
    assert!(h.data().iter().all(|x| x.is_finite()));
    let x = at_vertices(&shape, |p| p[0]);
    let norms = hessian_norm(&mesh, &x, Dual::Barycentric).unwrap();
    assert!(norms.iter().take(80).all(|&norm| norm > 0.0));
    assert_eq!(norms[80..], [0.0; 3]);
    let expected: f64 =
        norms.iter().zip(mesh.edge_lengths()).map(|(norm, &l)| norm * triangle::area(l)).sum();
    assert!(
        (EnergyForm::new(Energy::L1Hessian, &mesh, None, Dual::Barycentric).unwrap().evaluate(&x).unwrap()
            / expected
            - 1.0)
            .abs()
            < 1e-14
    );
}

/// Asserts that two matrices with the same pattern agree to 1e-12 of the largest entry.
fn assert_close(a: &sprs::CsMat<f64>, b: &sprs::CsMat<f64>) {
    assert_eq!(
        (a.shape(), a.indptr().raw_storage(), a.indices()),
        (b.shape(), b.indptr().raw_storage(), b.indices())
    );
    let scale = b.data().iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    assert!(scale > 0.0);
    for (x, y) in a.data().iter().zip(b.data()) {
        assert!((x - y).abs() <= 1e-12 * scale, "{x} {y}");
    }
}

#[test]
fn bending_a_strip_along_its_edges_changes_nothing() {
    let flat = irregular_sheet(6, 3).map(|[x, y, _]| [x, (y + 0.5).floor(), 0.0]);
    // The strips between the straight lines y = const are turned about them, each by another angle.
    let bend = |y: f64| {
        let (mut at, mut angle, mut p) = (0.0, 0.0_f64, [0.0, 0.0]);
        while at < y {
            let step = (y - at).min(1.0);
            p = [p[0] + step * angle.cos(), p[1] + step * angle.sin()];
            at += step;
            angle += 0.4;
        }
        p
    };
    let bent = flat.clone().map(|[x, y, _]| [x, bend(y)[0], bend(y)[1]]);
    assert!(bent.vertices.iter().any(|p| p[2] > 1.0));
    let of = |shape: &Shape| hessian(&shape.mesh().unwrap(), Dual::Barycentric).unwrap();
    assert_close(&of(&bent), &of(&flat));
}

#[test]
fn edge_lengths_rigid_motions_and_scalings_give_the_same_hessian() {
    let shape = shapes::icosphere(2).noisy(0.05, 4);
    let expected = hessian(&shape.mesh().unwrap(), Dual::Barycentric).unwrap();
    let lengths = edge_lengths(&shape.faces, &shape.vertices).unwrap();
    let by_lengths = Mesh::from_edge_lengths(shape.faces.clone(), lengths, None).unwrap();
    assert!(by_lengths.positions().is_none());
    assert_eq!(hessian(&by_lengths, Dual::Barycentric).unwrap(), expected);
    let moved = shape.rotated([1.0, -2.0, 0.5], 2.0).map(|p| p.map(|x| 1e3 * (x + 3.0)));
    assert_close(&hessian(&moved.mesh().unwrap(), Dual::Barycentric).unwrap(), &expected);
}

#[test]
fn renumbering_permutes_and_turning_a_face_keeps_its_norm() {
    let shape = shapes::torus(8, 7, 2.0, 0.9).noisy(0.05, 5);
    let mut random = Random::new(6);
    let vertices = random.permutation(shape.vertices.len());
    let faces = random.permutation(shape.faces.len());
    let mut renumbered = shape.clone();
    for (old, &new) in vertices.iter().enumerate() {
        renumbered.vertices[new] = shape.vertices[old];
    }
    for (old, &new) in faces.iter().enumerate() {
        renumbered.faces[new] = shape.faces[old].map(|v| vertices[v as usize] as u32);
        renumbered.faces[new].rotate_left(old % 3);
    }
    let norms = |shape: &Shape| {
        let u = at_vertices(shape, |[x, y, z]| (x * y + z * z).sin());
        hessian_norm(&shape.mesh().unwrap(), &u, Dual::Barycentric).unwrap()
    };
    let (expected, found) = (norms(&shape), norms(&renumbered));
    for (old, &new) in faces.iter().enumerate() {
        assert!(
            (found[new] - expected[old]).abs() <= 1e-12 * expected[old],
            "{} {}",
            found[new],
            expected[old]
        );
    }
}

#[test]
fn several_columns_share_one_norm() {
    let shape = shapes::icosphere(1).noisy(0.1, 7);
    let mesh = shape.mesh().unwrap();
    let columns: Vec<Vec<f64>> = (0..3).map(|k| at_vertices(&shape, |p| p[k])).collect();
    let joint = hessian_norm(&mesh, &columns.concat(), Dual::Barycentric).unwrap();
    let separate: Vec<Vec<f64>> =
        columns.iter().map(|u| hessian_norm(&mesh, u, Dual::Barycentric).unwrap()).collect();
    for (f, norm) in joint.iter().enumerate() {
        let expected = separate.iter().map(|norms| norms[f] * norms[f]).sum::<f64>().sqrt();
        assert!((norm - expected).abs() <= 1e-14 * expected);
    }
    assert!(hessian_norm(&mesh, &columns[0][1..], Dual::Barycentric).is_err());
}

#[test]
fn circumcentric_duals_of_squares_have_no_length() {
    let mesh = shapes::grid(2, 2).rotated([1.0, 1.0, 0.3], 1.0).mesh().unwrap();
    let refused = MeshError::ZeroDualEdge { face: 0, neighbor: 1 };
    assert_eq!(hessian(&mesh, Dual::Circumcentric).unwrap_err(), refused.into());
    assert!(hessian(&mesh, Dual::Barycentric).is_ok());
}

#[test]
fn a_nonmanifold_edge_counts_as_boundary() {
    let mut shape = shapes::grid(1, 1);
    let alone = hessian(&shape.mesh().unwrap(), Dual::Barycentric).unwrap();
    assert!(alone.data().iter().any(|&x| x != 0.0));
    shape.vertices.push([0.5, 0.5, 1.0]);
    shape.faces.push([0, 3, 4]);
    let h = hessian(&shape.mesh().unwrap(), Dual::Barycentric).unwrap();
    assert!(h.data().iter().all(|&x| x == 0.0));
}
