//! Voronoi mass, cotangent Laplacian and mollification.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use ridgeform_core::mesh::{triangle, Mesh};
use ridgeform_core::operators::{cotangent_laplacian, mollify, voronoi_mass, MOLLIFICATION_MARGIN};
use ridgeform_core::shapes::{self, Random, Shape};

fn mass(mesh: &Mesh) -> Vec<f64> {
    voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap()
}

fn total_area(mesh: &Mesh) -> f64 {
    mesh.edge_lengths().iter().map(|&l| triangle::area(l)).sum()
}

#[test]
fn the_mass_of_an_equilateral_lattice_is_its_voronoi_cells() {
    let mesh = shapes::lattice(4, 4).mesh().unwrap();
    // The vertex (2, 2) has six triangles of area √3/4, a third of each.
    assert!((mass(&mesh)[12] - 0.75_f64.sqrt()).abs() < 1e-14);
    let square = shapes::grid(2, 2).mesh().unwrap();
    let expected = [0.25, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.25];
    assert!(mass(&square).iter().zip(expected).all(|(m, e)| (m - e).abs() < 1e-14));
}

#[test]
fn an_obtuse_corner_gets_half_of_its_triangle() {
    let mesh = Mesh::new(vec![[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.5, 0.0]], vec![[0, 1, 2]]).unwrap();
    assert!(mass(&mesh).iter().zip([0.25, 0.25, 0.5]).all(|(m, e)| (m - e).abs() < 1e-14));
}

#[test]
fn masses_are_positive_and_sum_to_the_area() {
    for shape in [shapes::icosphere(2).noisy(0.1, 1), shapes::grid(9, 9).noisy(0.6, 2), shapes::cube(5)] {
        let mesh = shape.mesh().unwrap();
        let found = mass(&mesh);
        assert!(found.iter().all(|&m| m > 0.0));
        assert!((found.iter().sum::<f64>() / total_area(&mesh) - 1.0).abs() < 1e-13);
    }
}

#[test]
fn degenerate_faces_and_unreferenced_vertices_have_no_mass() {
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0, 0.0, 0.0]];
    assert_eq!(mass(&Mesh::new(vertices, vec![[0, 1, 2], [0, 0, 0]]).unwrap()), [0.0; 4]);
}

#[test]
fn the_laplacian_is_the_dirichlet_energy() {
    let shape = shapes::grid(6, 5).noisy(0.3, 3).map(|[x, y, _]| [x, y, 0.0]);
    let mesh = shape.clone().rotated([0.3, 1.0, 0.2], 1.1).mesh().unwrap();
    let laplacian = cotangent_laplacian(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    let quadratic =
        |u: &[f64]| laplacian.iter().map(|(value, (row, column))| u[row] * value * u[column]).sum::<f64>();
    let affine: Vec<f64> = shape.vertices.iter().map(|p| 3.0 * p[0] - 2.0 * p[1] + 1.0).collect();
    assert!((quadratic(&affine) / (13.0 * total_area(&mesh)) - 1.0).abs() < 1e-12);
    assert!(quadratic(&vec![1.0; affine.len()]).abs() < 1e-12);
}

#[test]
fn the_laplacian_is_symmetric_and_positive_semidefinite() {
    // Strong noise: many angles are obtuse, many weights negative.
    let mesh = shapes::icosphere(2).noisy(0.4, 4).mesh().unwrap();
    let laplacian = cotangent_laplacian(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert!(sprs::is_symmetric(&laplacian));
    assert!(laplacian.iter().any(|(&value, (row, column))| row != column && value > 0.0));
    let mut random = Random::new(5);
    for _ in 0..50 {
        let u: Vec<f64> = (0..mesh.connectivity().n_vertices()).map(|_| random.symmetric()).collect();
        let energy: f64 = laplacian.iter().map(|(value, (row, column))| u[row] * value * u[column]).sum();
        assert!(energy > 0.0);
    }
}

#[test]
fn good_triangles_are_not_mollified() {
    let mesh = shapes::icosphere(2).mesh().unwrap();
    let mut lengths = mesh.edge_lengths().to_vec();
    assert_eq!(mollify(mesh.connectivity(), &mut lengths), 0.0);
    assert_eq!(lengths, mesh.edge_lengths());
}

#[test]
fn mollified_triangles_keep_the_margin_and_no_more() {
    let Shape { vertices, mut faces } = shapes::grid(5, 5).map(|[x, y, _]| [x, y * 1e-9, 0.0]);
    faces.push([0, 0, 1]);
    let mesh = Mesh::new(vertices, faces).unwrap();
    let mut lengths = mesh.edge_lengths().to_vec();
    let epsilon = mollify(mesh.connectivity(), &mut lengths);
    let before: Vec<f64> = mesh.connectivity().edges().map(|h| mesh.edge_lengths()[h / 3][h % 3]).collect();
    let margin = MOLLIFICATION_MARGIN * before.iter().sum::<f64>() / before.len() as f64;
    let least = lengths.iter().map(|&l| triangle::slack(l)).fold(f64::INFINITY, f64::min);
    assert!((least / margin - 1.0).abs() < 1e-9, "{least} {margin}");
    for (old, new) in mesh.edge_lengths().iter().flatten().zip(lengths.iter().flatten()) {
        assert!((new - old - epsilon).abs() < 1e-15);
    }
    assert!(lengths.iter().all(|&l| !triangle::is_degenerate(l)));
}

#[test]
fn lengths_that_violate_the_triangle_inequality_are_repaired() {
    let connectivity = Mesh::new(vec![[0.0; 3]; 3], vec![[0, 1, 2]]).unwrap().connectivity().clone();
    let mut lengths = vec![[3.0, 1.0, 1.0]];
    let epsilon = mollify(&connectivity, &mut lengths);
    assert!((epsilon - 1.0 - MOLLIFICATION_MARGIN * 5.0 / 3.0).abs() < 1e-14);
}
