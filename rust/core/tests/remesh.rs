//! Isotropic remeshing: even edges, no folds, and what must stay stays.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use ridgeform_core::error::{Error, MeshError};
use ridgeform_core::mesh::vector::{area_vector, distance, dot, norm, quality, unit, Point};
use ridgeform_core::mesh::{boundary_loops, invariants, report, Mesh, MeshReport};
use ridgeform_core::remesh::closest::{closest_on_triangle, ClosestPoint};
use ridgeform_core::remesh::{remesh, RemeshOptions, Remeshed};
use ridgeform_core::shapes::{self, Random, Shape};
use ridgeform_core::Progress;

fn with_length(edge_length: f64) -> RemeshOptions {
    RemeshOptions { edge_length: Some(edge_length), ..RemeshOptions::default() }
}

fn run(shape: &Shape, options: &RemeshOptions) -> (Remeshed, Mesh) {
    let result = remesh(&shape.mesh().unwrap(), options, &Progress::new()).unwrap();
    let mesh = Mesh::new(result.vertices.clone(), result.faces.clone()).unwrap();
    invariants::check(mesh.connectivity()).unwrap();
    (result, mesh)
}

fn clean(n_components: usize, n_boundary_loops: usize) -> MeshReport {
    MeshReport { n_components, n_boundary_loops, ..MeshReport::default() }
}

fn corners(result: &Remeshed) -> impl Iterator<Item = [Point; 3]> + '_ {
    result.faces.iter().map(|face| face.map(|v| result.vertices[v as usize]))
}

fn least_quality(result: &Remeshed) -> f64 {
    corners(result).map(quality).fold(1.0, f64::min)
}

/// The share of edges between `4/5 - slack` and `4/3 + slack` of the target.
fn even_share(mesh: &Mesh, target: f64) -> f64 {
    let lengths: Vec<f64> = mesh.edge_lengths().iter().flatten().map(|l| l / target).collect();
    lengths.iter().filter(|&&l| l > 0.7 && l < 1.4).count() as f64 / lengths.len() as f64
}

fn area(result: &Remeshed) -> f64 {
    corners(result).map(|t| norm(area_vector(t))).sum()
}

#[test]
fn a_stretched_sphere_gets_even_triangles_and_keeps_its_shape() {
    let shape = shapes::icosphere(3).map(|[x, y, z]| [x, y, 4.0 * z]);
    for length in [0.3, 0.12] {
        let (result, mesh) = run(&shape, &with_length(length));
        assert_eq!(report(&mesh).unwrap(), clean(1, 0));
        assert!(
            even_share(&mesh, length) > 0.97 && least_quality(&result) > 0.45,
            "{}",
            even_share(&mesh, length)
        );
        for &[x, y, z] in &result.vertices {
            assert!((norm([x, y, z / 4.0]) - 1.0).abs() < 0.02);
        }
        for t in corners(&result) {
            assert!(dot(area_vector(t), [t[0][0], t[0][1], t[0][2] / 16.0]) > 0.0, "a face looks inwards");
        }
    }
}

#[test]
fn a_box_keeps_its_edges_exactly() {
    let stretched = shapes::cube(1).map(|[x, y, z]| [x, 2.0 * y, 0.3 * z]);
    let (result, mesh) = run(&stretched, &with_length(0.2));
    assert_eq!(report(&mesh).unwrap(), clean(1, 0));
    assert!((area(&result) - (2.0 * 8.0 + 2.0 * 1.2 + 2.0 * 2.4)).abs() < 1e-9, "{}", area(&result));
    assert!(least_quality(&result) > 0.3, "{}", least_quality(&result));
    let corners: Vec<u32> = result.origin.iter().flatten().copied().collect();
    assert_eq!(corners, [0, 1, 2, 3, 4, 5, 6, 7]);
}

#[test]
fn borders_keep_their_course() {
    let sheet = shapes::grid(7, 5).without_faces(|f| f / 2 == 17);
    let (result, mesh) = run(&sheet, &with_length(0.4));
    assert_eq!(report(&mesh).unwrap(), clean(1, 2));
    assert!((area(&result) - 34.0).abs() < 1e-9);
    assert!(corners(&result).all(|t| area_vector(t)[2] > 0.0) && least_quality(&result) > 0.3);
    let round = shapes::cylinder(40, 6, 1.0, 2.0);
    let (result, mesh) = run(&round, &with_length(0.25));
    assert_eq!(report(&mesh).unwrap(), clean(1, 2));
    for &v in boundary_loops(mesh.connectivity()).unwrap().iter().flatten() {
        let [x, y, z] = result.vertices[v as usize];
        assert!((z == 0.0 || z == 2.0) && (x.hypot(y) - 1.0).abs() < 0.01, "{z}");
    }
}

#[test]
fn fixed_vertices_stay_bit_by_bit_and_with_them_their_borders_and_faces() {
    let shape = shapes::icosphere(3).without_faces(|f| f % 640 < 60);
    let fixed: Vec<bool> = shape.vertices.iter().map(|p| p[0] > 0.2).collect();
    let options = RemeshOptions { fixed: Some(fixed.clone()), ..with_length(0.1) };
    let (result, mesh) = run(&shape, &options);
    assert_eq!(report(&mesh).unwrap().nonmanifold_edges.len(), 0);
    let mut new = vec![u32::MAX; shape.vertices.len()];
    for (v, origin) in result.origin.iter().enumerate() {
        if let Some(old) = origin {
            assert_eq!(result.vertices[v], shape.vertices[*old as usize]);
            new[*old as usize] = v as u32;
        }
    }
    for face in shape.faces.iter().filter(|face| face.iter().all(|&v| fixed[v as usize])) {
        assert!(result.faces.contains(&face.map(|v| new[v as usize])));
    }
    let all = RemeshOptions { fixed: Some(vec![true; shape.vertices.len()]), ..with_length(0.05) };
    let (result, _) = run(&shape, &all);
    assert_eq!((result.vertices, result.faces), (shape.vertices, shape.faces));
}

#[test]
fn edges_and_vertices_that_are_not_manifold_stay() {
    // Three sheets that meet in the line x = 0.
    let sheet = shapes::grid(4, 6);
    let book = Shape {
        vertices: sheet
            .vertices
            .iter()
            .copied()
            .chain(
                sheet
                    .vertices
                    .iter()
                    .filter(|p| p[0] > 0.0)
                    .flat_map(|p| [[-p[0], p[1], 0.0], [0.0, p[1], p[0]]]),
            )
            .collect(),
        faces: Vec::new(),
    };
    let find = |p: Point| book.vertices.iter().position(|q| distance(*q, p) == 0.0).unwrap() as u32;
    let places: [fn(Point) -> Point; 3] = [|p| p, |p| [-p[0], p[1], 0.0], |p| [0.0, p[1], p[0]]];
    let mut faces = Vec::new();
    for place in places {
        faces.extend(sheet.faces.iter().map(|f| f.map(|v| find(place(sheet.vertices[v as usize])))));
    }
    let book = Shape { faces, ..book };
    let before = report(&book.mesh().unwrap()).unwrap();
    assert_eq!(before.nonmanifold_edges.len(), 6);
    let (result, mesh) = run(&book, &with_length(0.5));
    let after = report(&mesh).unwrap();
    assert_eq!(
        (after.nonmanifold_edges.len(), after.degenerate_faces.len(), after.duplicate_faces.len()),
        (6, 0, 0)
    );
    assert!((area(&result) - 72.0).abs() < 1e-9 && result.faces.len() > 2 * book.faces.len());
    // A bow tie keeps its knot.
    let tie = Shape {
        vertices: vec![[0.0; 3], [1.0, 0.5, 0.0], [1.0, -0.5, 0.0], [-1.0, 0.5, 0.0], [-1.0, -0.5, 0.0]],
        faces: vec![[0, 2, 1], [0, 3, 4]],
    };
    let (result, mesh) = run(&tie, &with_length(0.2));
    assert_eq!(
        (report(&mesh).unwrap().nonmanifold_vertices.len(), report(&mesh).unwrap().n_components),
        (1, 1)
    );
    assert!((area(&result) - 1.0).abs() < 1e-9);
}

#[test]
fn a_vertex_with_a_thousand_faces_is_remeshed() {
    let n = 1000;
    let rim = (0..n).map(|i| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        [angle.cos(), angle.sin(), 0.05 * (5.0 * angle).sin()]
    });
    let vertices = [[0.0, 0.0, 0.3], [0.0, 0.0, -0.3]].into_iter().chain(rim).collect();
    let faces = (0..n).flat_map(|i| {
        let (here, next) = (2 + i, 2 + (i + 1) % n);
        [[0, here, next], [1, next, here]]
    });
    let mesh = Mesh::new(vertices, faces.collect()).unwrap();
    let options = RemeshOptions { edge_length: Some(0.1), iterations: 5, ..RemeshOptions::default() };
    let result = remesh(&mesh, &options, &Progress::new()).unwrap();
    let after = Mesh::new(result.vertices.clone(), result.faces.clone()).unwrap();
    assert_eq!(report(&after).unwrap(), clean(1, 0));
    let mut valences = vec![0; result.vertices.len()];
    result.faces.iter().flatten().for_each(|&v| valences[v as usize] += 1);
    assert!(*valences.iter().max().unwrap() < 30, "{:?}", valences.iter().max());
}

#[test]
fn slivers_and_faces_without_area_go() {
    let mut random = Random::new(5);
    let squeezed = shapes::grid(12, 12).map(|[x, y, z]| [x, 0.02 * y, z]);
    let (result, _) = run(&squeezed, &with_length(0.1));
    assert!(
        least_quality(&result) > 0.2 && (area(&result) - 12.0 * 0.24).abs() < 1e-9,
        "{}",
        least_quality(&result)
    );
    // A vertex put onto an edge of its neighbors leaves faces without area.
    let mut flat = shapes::grid(8, 8);
    flat.vertices[30] = flat.vertices[31];
    flat.vertices[50] = flat.vertices[49];
    let (result, mesh) = run(&flat, &with_length(0.9));
    assert!(
        report(&mesh).unwrap().degenerate_faces.is_empty() && least_quality(&result) > 0.2,
        "{}",
        least_quality(&result)
    );
    let rough = shapes::icosphere(3)
        .map(|p| p.map(|x| x + 0.04 * random.clone().symmetric()))
        .noisy(0.02, random.bits());
    assert!(least_quality(&run(&rough, &with_length(0.13)).0) > 0.2);
}

#[test]
fn wrong_options_are_refused() {
    let mesh = shapes::grid(2, 2).mesh().unwrap();
    let refused = |options: RemeshOptions| match remesh(&mesh, &options, &Progress::new()) {
        Err(Error::Argument { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-6] {
        assert_eq!(refused(with_length(length)), "edge_length");
    }
    assert_eq!(refused(RemeshOptions { fixed: Some(vec![true]), ..RemeshOptions::default() }), "fixed");
    assert_eq!(
        refused(RemeshOptions { feature_angle: Some(4.0), ..RemeshOptions::default() }),
        "feature_angle"
    );
    let cancelled = Progress::new();
    cancelled.cancel();
    assert_eq!(remesh(&mesh, &RemeshOptions::default(), &cancelled), Err(Error::Cancelled));
    let point = Mesh::new(vec![[0.0; 3]; 3], vec![[0, 1, 2]]).unwrap();
    assert_eq!(remesh(&point, &RemeshOptions::default(), &Progress::new()), Err(MeshError::NoFaces.into()));
}

#[test]
fn the_tree_finds_the_closest_point() {
    let shape = shapes::torus(12, 9, 2.0, 0.7);
    let triangles: Vec<[Point; 3]> =
        shape.faces.iter().map(|f| f.map(|v| shape.vertices[v as usize])).collect();
    let tree = ClosestPoint::new(triangles.clone()).unwrap();
    let mut random = Random::new(3);
    for _ in 0..200 {
        let p = [0; 3].map(|_| 3.0 * random.symmetric());
        let least =
            triangles.iter().map(|&t| distance(p, closest_on_triangle(p, t))).fold(f64::INFINITY, f64::min);
        for guess in [None, Some(7)] {
            let found = tree.closest(p, guess, |_| true).unwrap();
            assert!((found.squared.sqrt() - least).abs() < 1e-12);
            assert!((distance(found.point, p) - least).abs() < 1e-12);
        }
        assert!(tree.closest(p, None, |t| t == 5).is_some_and(|found| found.triangle == 5));
    }
    assert_eq!(ClosestPoint::new(Vec::new()).unwrap().closest([0.0; 3], None, |_| true), None);
}

#[test]
fn the_closest_point_of_a_triangle_is_right_inside_on_edges_at_corners_and_without_area() {
    let t = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    for (p, q) in [
        ([0.5, 0.5, 3.0], [0.5, 0.5, 0.0]),
        ([1.0, -1.0, 1.0], [1.0, 0.0, 0.0]),
        ([2.0, 2.0, 0.0], [1.0, 1.0, 0.0]),
        ([-1.0, -2.0, 0.0], [0.0, 0.0, 0.0]),
        ([5.0, -1.0, 0.0], [2.0, 0.0, 0.0]),
    ] {
        assert!(distance(closest_on_triangle(p, t), q) < 1e-15);
    }
    let segment = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    assert_eq!(closest_on_triangle([0.25, 1.0, 0.0], segment), [0.25, 0.0, 0.0]);
    assert_eq!(closest_on_triangle([4.0, 1.0, 0.0], [[1.0; 3]; 3]), [1.0; 3]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn remeshing_is_sound_on_rough_shapes(seed in any::<u64>(), which in 0..4_usize, factor in 0.4..2.5_f64) {
        let (shape, n_loops, unit_length) = [
            (shapes::icosphere(2), 0, 0.3),
            (shapes::torus(16, 10, 2.0, 0.8), 0, 0.5),
            (shapes::grid(8, 8), 1, 1.0),
            (shapes::cylinder(14, 7, 1.0, 3.0), 2, 0.4),
        ][which].clone();
        let rough = shape.noisy(0.15 * unit_length, seed);
        let (result, mesh) = run(&rough, &with_length(factor * unit_length));
        prop_assert_eq!(report(&mesh).unwrap(), clean(1, n_loops));
        prop_assert!(least_quality(&result) > 0.08, "{}", least_quality(&result));
        let connectivity = mesh.connectivity();
        let corners = |f: usize| connectivity.faces()[f].map(|v| result.vertices[v as usize]);
        let normal = |f: usize| unit(area_vector(corners(f)));
        let folds = connectivity.edges().filter(|&h| {
            connectivity.twin(h).is_some_and(|twin| dot(normal(h / 3), normal(twin / 3)) < -0.9)
        });
        prop_assert_eq!(folds.count(), 0);
        let longer = with_length(factor * unit_length);
        let again = remesh(&rough.mesh().unwrap(), &longer, &Progress::new()).unwrap();
        prop_assert_eq!(again, result);
    }
}
