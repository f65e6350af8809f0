//! Intrinsic Delaunay flips.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use ridgeform_core::intrinsic::delaunay_flips;
use ridgeform_core::mesh::{edge_lengths, invariants, triangle, Connectivity, Mesh};
use ridgeform_core::operators::{cotangent_laplacian, hessian, mollify, Dual};
use ridgeform_core::shapes;

fn total_area(lengths: &[[f64; 3]]) -> f64 {
    lengths.iter().map(|&l| triangle::area(l)).sum()
}

/// The largest sum of two angles opposite an interior edge, less π.
fn largest_excess(connectivity: &Connectivity, lengths: &[[f64; 3]]) -> f64 {
    let angle = |h: usize| triangle::angles(lengths[h / 3])[h % 3];
    (0..connectivity.n_halfedges())
        .filter_map(|h| connectivity.twin(h).map(|twin| angle(h) + angle(twin) - std::f64::consts::PI))
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_long_diagonal_of_a_kite_becomes_the_short_one() {
    let vertices = vec![[-2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let (connectivity, lengths, n_flips) = delaunay_flips(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert_eq!(n_flips, 1);
    invariants::check(&connectivity).unwrap();
    let edge = connectivity.edges().find(|&h| connectivity.twin(h).is_some()).unwrap();
    let mut ends = [connectivity.tail(edge), connectivity.head(edge)];
    ends.sort_unstable();
    assert_eq!(ends, [1, 3]);
    assert!((lengths[edge / 3][edge % 3] - 2.0).abs() < 1e-15);
}

#[test]
fn squares_and_delaunay_meshes_stay() {
    for shape in [shapes::grid(5, 5), shapes::icosphere(2), shapes::cube(3)] {
        let mesh = shape.mesh().unwrap();
        let (connectivity, lengths, n_flips) =
            delaunay_flips(mesh.connectivity(), mesh.edge_lengths()).unwrap();
        assert_eq!((n_flips, &connectivity), (0, mesh.connectivity()));
        assert_eq!(lengths, mesh.edge_lengths());
    }
}

#[test]
fn flips_in_the_plane_match_positions() {
    let shape =
        shapes::grid(12, 12).map(|[x, y, _]| [x, y, 0.0]).noisy(0.35, 3).map(|[x, y, _]| [x, 0.4 * y, 0.0]);
    let mesh = shape.mesh().unwrap();
    let (connectivity, lengths, n_flips) = delaunay_flips(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert!(n_flips > 50);
    for (found, expected) in lengths
        .iter()
        .flatten()
        .zip(edge_lengths(connectivity.faces(), &shape.vertices).unwrap().iter().flatten())
    {
        assert!((found - expected).abs() < 1e-12);
    }
    // Delaunay weights are not negative, and affine functions stay without a Hessian.
    let laplacian = cotangent_laplacian(&connectivity, &lengths).unwrap();
    let boundary: Vec<bool> = {
        let mut on = vec![false; shape.vertices.len()];
        (0..connectivity.n_halfedges()).filter(|&h| connectivity.twin(h).is_none()).for_each(|h| {
            on[connectivity.tail(h) as usize] = true;
            on[connectivity.head(h) as usize] = true;
        });
        on
    };
    assert!(laplacian.iter().all(|(&w, (i, j))| i == j || w < 1e-9 || (boundary[i] && boundary[j])));
    let flipped = Mesh::from_connectivity(connectivity, lengths).unwrap();
    let h = hessian(&flipped, Dual::Barycentric).unwrap();
    for row in h.outer_iterator() {
        let sum: f64 = row.iter().map(|(c, v)| v * (shape.vertices[c][0] - 2.0 * shape.vertices[c][1])).sum();
        let size: f64 = row.iter().map(|(_, v)| v.abs()).sum();
        assert!(sum.abs() <= 1e-12 * (1.0 + size) * 40.0);
    }
}

#[test]
fn a_spike_becomes_a_face_glued_to_itself_and_keeps_all_operators_finite() {
    // A tetrahedron with a far apex, vertex 0, whose edges have different lengths:
    // they are flipped away until one is left.
    let shape = shapes::tetrahedron();
    let length =
        |a: u32, b: u32| [1.0, 30.0, 30.9, 30.2][if a == 0 || b == 0 { (a + b) as usize } else { 0 }];
    let lengths = shape.faces.iter().map(|&[a, b, c]| [length(b, c), length(c, a), length(a, b)]).collect();
    let mesh = Mesh::from_edge_lengths(shape.faces, lengths, None).unwrap();
    let (connectivity, lengths, n_flips) = delaunay_flips(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    invariants::check(&connectivity).unwrap();
    assert!(largest_excess(&connectivity, &lengths) < 1e-8);
    assert!((total_area(&lengths) / total_area(mesh.edge_lengths()) - 1.0).abs() < 1e-12);
    assert!(n_flips > 0);
    let repeated = connectivity.faces().iter().any(|f| f[0] == f[1] || f[1] == f[2] || f[2] == f[0]);
    assert!(repeated, "{:?}", connectivity.faces());
    let flipped = Mesh::from_connectivity(connectivity, lengths).unwrap();
    let h = hessian(&flipped, Dual::Barycentric).unwrap();
    assert!(h.data().iter().all(|x| x.is_finite()));
    for row in h.outer_iterator() {
        let size: f64 = row.iter().map(|(_, v)| v.abs()).sum();
        assert!(row.iter().map(|(_, v)| v).sum::<f64>().abs() <= 1e-12 * size);
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(13),
        ..ProptestConfig::default()
    })]

    #[test]
    fn all_edges_become_delaunay_and_the_area_stays(
        seed in any::<u64>(), amplitude in 0.0..0.4_f64, stretch in 0.05..1.0_f64,
    ) {
        let torus = shapes::torus(12, 9, 2.0, 0.8);
        for shape in [shapes::icosphere(2), torus, shapes::cylinder(9, 6, 1.0, 2.0)] {
            let mesh = shape.noisy(amplitude, seed).map(|[x, y, z]| [x, y, stretch * z]).mesh().unwrap();
            let mut lengths = mesh.edge_lengths().to_vec();
            mollify(mesh.connectivity(), &mut lengths);
            let (connectivity, flipped, _) = delaunay_flips(mesh.connectivity(), &lengths).unwrap();
            invariants::check(&connectivity).unwrap();
            prop_assert!(largest_excess(&connectivity, &flipped) < 1e-8);
            prop_assert!((total_area(&flipped) / total_area(&lengths) - 1.0).abs() < 1e-9);
            for h in connectivity.edges() {
                if let Some(twin) = connectivity.twin(h) {
                    let (a, b) = (flipped[h / 3][h % 3], flipped[twin / 3][twin % 3]);
                    prop_assert!((a - b).abs() <= 1e-12 * a);
                }
            }
        }
    }
}
