//! Connectivity, boundary loops, reports and refusals on small shapes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use ridgeform_core::error::MeshError;
use ridgeform_core::mesh::{
    boundary_loops, invariants, report, triangle, Connectivity, EdgeKind, Mesh, MeshReport,
};
use ridgeform_core::shapes::{self, Shape};

/// A mesh of `faces` whose positions are in general position.
fn of_faces(faces: &[[u32; 3]]) -> Mesh {
    let n = faces.iter().flatten().max().unwrap() + 1;
    let vertices =
        (0..n).map(|v| [(f64::from(v) * 2.4).cos(), (f64::from(v) * 2.4).sin(), (f64::from(v) * 0.9).sin()]);
    let mesh = Mesh::new(vertices.collect(), faces.to_vec()).unwrap();
    invariants::check(mesh.connectivity()).unwrap();
    mesh
}

fn loops(mesh: &Mesh) -> Vec<Vec<u32>> {
    boundary_loops(mesh.connectivity()).unwrap()
}

fn clean(n_components: usize, n_boundary_loops: usize) -> MeshReport {
    MeshReport { n_components, n_boundary_loops, ..MeshReport::default() }
}

#[test]
fn halfedges_are_opposite_their_corners() {
    let mesh = of_faces(&[[0, 1, 2], [2, 1, 3]]);
    let connectivity = mesh.connectivity();
    assert_eq!((connectivity.tail(0), connectivity.head(0), connectivity.opposite(0)), (1, 2, 0));
    assert_eq!((connectivity.twin(0), connectivity.twin(5), connectivity.twin(1)), (Some(5), Some(0), None));
    assert_eq!((connectivity.kind(0), connectivity.kind(1)), (EdgeKind::Interior, EdgeKind::Boundary));
    assert_eq!(connectivity.edges().count(), 5);
}

#[test]
fn closed_shapes_are_clean() {
    for shape in [shapes::tetrahedron(), shapes::icosphere(2), shapes::cube(3), shapes::torus(5, 4, 2.0, 0.5)]
    {
        let mesh = shape.mesh().unwrap();
        invariants::check(mesh.connectivity()).unwrap();
        assert_eq!(report(&mesh).unwrap(), clean(1, 0));
        let volume: f64 =
            shape.faces.iter().map(|f| signed_volume(f.map(|v| shape.vertices[v as usize]))).sum();
        assert!(volume > 0.5, "faces point outwards");
    }
}

fn signed_volume([a, b, c]: [[f64; 3]; 3]) -> f64 {
    (a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0]))
        / 6.0
}

#[test]
fn an_open_cone_has_one_loop_along_its_halfedges() {
    let mesh = of_faces(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]);
    assert_eq!(loops(&mesh), [[1, 2, 3, 4]]);
    assert_eq!(report(&mesh).unwrap(), clean(1, 1));
}

#[test]
fn a_bow_tie_has_two_loops_and_a_nonmanifold_vertex() {
    let mesh = of_faces(&[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(loops(&mesh), [[0, 3, 4], [1, 2, 0]]);
    assert_eq!(report(&mesh).unwrap(), MeshReport { nonmanifold_vertices: vec![0], ..clean(1, 2) });
}

#[test]
fn two_holes_that_touch_at_a_vertex_are_two_loops() {
    let sheet = shapes::grid(4, 4);
    // The cells (1, 1) and (2, 2) touch at the vertex (2, 2), number 12.
    let mesh = sheet.without_faces(|f| [5, 10].contains(&(f / 2))).mesh().unwrap();
    let mut found = loops(&mesh);
    assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [16, 4, 4]);
    for rim in &mut found {
        rim.sort_unstable();
    }
    found.sort_unstable();
    found.sort_by_key(|rim| std::cmp::Reverse(rim.len()));
    assert_eq!(found[1..], [vec![6, 7, 11, 12], vec![12, 13, 17, 18]]);
    assert_eq!(report(&mesh).unwrap().nonmanifold_vertices, [12]);
}

#[test]
fn a_sheet_with_a_hole_has_an_outer_and_an_inner_rim() {
    let mesh = shapes::grid(5, 3).without_faces(|f| f / 2 == 7).mesh().unwrap();
    let found = loops(&mesh);
    // The outer rim runs counterclockwise, the hole's clockwise.
    assert_eq!(found[0][..4], [0, 1, 2, 3]);
    assert_eq!((found.len(), found[0].len()), (2, 16));
    let start = found[1].iter().position(|&v| v == 8).unwrap();
    let mut hole = found[1].clone();
    hole.rotate_left(start);
    assert_eq!(hole, [8, 14, 15, 9]);
    assert_eq!(report(&mesh).unwrap(), clean(1, 2));
}

#[test]
fn components_and_unreferenced_vertices_are_counted() {
    let mut shape = shapes::tetrahedron().and(&shapes::cylinder(5, 2, 1.0, 1.0));
    shape.vertices.push([9.0, 9.0, 9.0]);
    let mesh = shape.mesh().unwrap();
    assert_eq!(report(&mesh).unwrap(), MeshReport { unreferenced_vertices: vec![19], ..clean(2, 2) });
}

#[test]
fn a_moebius_strip_has_an_inconsistent_edge_and_one_loop() {
    let n = 6;
    let faces: Vec<[u32; 3]> = (0..n)
        .flat_map(|i| {
            let (a, b) = (2 * i, 2 * i + 1);
            let (c, d) = if i + 1 == n { (1, 0) } else { (a + 2, b + 2) };
            [[a, c, b], [b, c, d]]
        })
        .collect();
    let mesh = of_faces(&faces);
    let found = report(&mesh).unwrap();
    assert_eq!(found.inconsistent_edges, [[0, 1]]);
    assert_eq!(
        found,
        MeshReport { nonmanifold_edges: vec![[0, 1]], inconsistent_edges: vec![[0, 1]], ..clean(1, 1) }
    );
    let mut rim = loops(&mesh).remove(0);
    rim.sort_unstable();
    assert_eq!(rim, (0..12).collect::<Vec<u32>>());
}

#[test]
fn a_flipped_face_does_not_hide_a_hole() {
    let mut shape = shapes::grid(5, 3).without_faces(|f| f / 2 == 7);
    // The face before the hole, which has one of its four edges.
    shape.faces[13].reverse();
    let mesh = shape.mesh().unwrap();
    assert_eq!(loops(&mesh).iter().map(Vec::len).collect::<Vec<_>>(), [16, 4]);
    assert!(!report(&mesh).unwrap().inconsistent_edges.is_empty());
}

#[test]
fn three_faces_on_an_edge_are_no_holes() {
    let mesh = of_faces(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    assert!((0..9).all(|h| mesh.connectivity().twin(h).is_none()));
    assert_eq!(
        report(&mesh).unwrap(),
        MeshReport { nonmanifold_edges: vec![[0, 1]], nonmanifold_vertices: vec![0, 1], ..clean(1, 0) }
    );
}

#[test]
fn duplicate_and_degenerate_faces_are_named() {
    let mesh = of_faces(&[[0, 1, 2], [1, 2, 3], [2, 0, 1], [3, 2, 1], [4, 4, 1]]);
    let found = report(&mesh).unwrap();
    assert_eq!((found.duplicate_faces, found.degenerate_faces), (vec![2, 3], vec![4]));
    // Faces 1 and 3, back to back, share two edges in the way of a closed surface.
    assert_eq!(found.nonmanifold_edges, [[0, 1], [0, 2], [1, 2]]);
    assert_eq!(mesh.connectivity().kind(12), EdgeKind::Degenerate);
    let flat = Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.3, 0.0, 0.0]], vec![[0, 1, 2]]).unwrap();
    assert_eq!(report(&flat).unwrap().degenerate_faces, [0]);
}

#[test]
fn empty_meshes_are_meshes() {
    let mesh = Mesh::new(vec![], vec![]).unwrap();
    assert_eq!(report(&mesh).unwrap(), MeshReport::default());
    assert_eq!(
        Mesh::new(vec![[0.0; 3]], vec![]).map(|mesh| report(&mesh).unwrap().unreferenced_vertices),
        Ok(vec![0])
    );
}

#[test]
fn bad_input_is_refused_by_name() {
    let Shape { mut vertices, faces } = shapes::tetrahedron();
    assert_eq!(
        Mesh::new(vertices[..3].to_vec(), faces.clone()),
        Err(MeshError::VertexOutOfRange { face: 1, vertex: 3, n_vertices: 3 }.into())
    );
    vertices[2][1] = f64::NAN;
    assert_eq!(Mesh::new(vertices, faces.clone()), Err(MeshError::NonFiniteVertex { vertex: 2 }.into()));
    let with = |f: usize, i: usize, length: f64| {
        let mut lengths = vec![[1.0; 3]; 4];
        lengths[f][i] = length;
        Mesh::from_edge_lengths(faces.clone(), lengths, None)
    };
    assert!(with(0, 0, 1.0).is_ok());
    assert_eq!(with(2, 0, f64::INFINITY), Err(MeshError::BadEdgeLength { face: 2 }.into()));
    assert_eq!(with(2, 0, -1.0), Err(MeshError::BadEdgeLength { face: 2 }.into()));
    assert_eq!(with(1, 2, 2.5), Err(MeshError::TriangleInequality { face: 1 }.into()));
    assert_eq!(with(1, 0, 1.1), Err(MeshError::UnequalEdgeLengths { first: 1, second: 3 }.into()));
    let rows = Mesh::from_edge_lengths(faces, vec![[1.0; 3]; 3], None);
    assert_eq!(rows, Err(MeshError::LengthRows { rows: 3, n_faces: 4 }.into()));
}

#[test]
fn triangles_are_laid_out_by_their_lengths() {
    let [a, b, c] = triangle::layout([5.0, 4.0, 3.0]);
    assert_eq!((a, b), ([0.0; 2], [3.0, 0.0]));
    assert!(c[0].abs() < 1e-15 && (c[1] - 4.0).abs() < 1e-15);
    assert_eq!(triangle::area([5.0, 4.0, 3.0]), 6.0);
    let angles = triangle::angles([5.0, 4.0, 3.0]);
    assert!((angles[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!((angles.iter().sum::<f64>() - std::f64::consts::PI).abs() < 1e-15);
    let cotangents = triangle::cotangents([5.0, 4.0, 3.0]);
    assert!(cotangents[0].abs() < 1e-15 && (cotangents[1] - 0.75).abs() < 1e-15);
    // A needle whose area Heron's formula gets wrong in the third digit.
    let needle = triangle::area([1.0, 1.0, 1e-7]);
    assert!((needle / (0.5 * 1e-7) - 1.0).abs() < 1e-12);
    assert_eq!((triangle::area([3.0, 1.0, 1.0]), triangle::slack([3.0, 1.0, 1.0])), (0.0, -1.0));
    assert_eq!(triangle::angles([2.0, 1.0, 1.0]), [std::f64::consts::PI, 0.0, 0.0]);
    assert!(triangle::is_degenerate([0.0, 1.0, 1.0]) && triangle::is_degenerate([f64::NAN, 1.0, 1.0]));
    assert!(triangle::is_degenerate([0.0; 3]) && !triangle::is_degenerate([1.0, 1.0, 1e-9]));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_list_of_faces_has_sound_halfedges_and_loops(
        faces in prop::collection::vec(prop::array::uniform3(0_u32..9), 1..40),
    ) {
        let connectivity = Connectivity::new(faces, 9).unwrap();
        invariants::check(&connectivity).unwrap();
        let mut boundary = std::collections::HashSet::new();
        for h in (0..connectivity.n_halfedges()).filter(|&h| connectivity.kind(h) == EdgeKind::Boundary) {
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            prop_assert!(boundary.insert((tail.min(head), tail.max(head))), "a boundary edge has one face");
        }
        for rim in boundary_loops(&connectivity).unwrap() {
            prop_assert!(rim.len() >= 3);
            for (k, &vertex) in rim.iter().enumerate() {
                let following = rim[(k + 1) % rim.len()];
                let edge = (vertex.min(following), vertex.max(following));
                prop_assert!(boundary.remove(&edge), "each edge is in one loop");
                prop_assert!(!rim[..k].contains(&vertex));
            }
        }
    }

    #[test]
    fn manifold_boundaries_are_all_in_loops(holes in prop::collection::vec(0_usize..60, 0..30)) {
        let mesh = shapes::grid(6, 5).without_faces(|f| holes.contains(&f)).mesh().unwrap();
        let connectivity = mesh.connectivity();
        let halfedges = 0..connectivity.n_halfedges();
        let boundary = halfedges.filter(|&h| connectivity.kind(h) == EdgeKind::Boundary).count();
        let found = boundary_loops(connectivity).unwrap();
        prop_assert_eq!(boundary, found.iter().map(Vec::len).sum::<usize>());
        for rim in &found {
            let forward = |k: usize| (0..connectivity.n_halfedges())
                .any(|h| (connectivity.tail(h), connectivity.head(h)) == (rim[k], rim[(k + 1) % rim.len()]));
            prop_assert!((0..rim.len()).all(forward));
        }
    }
}
