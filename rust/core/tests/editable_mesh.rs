//! Edits of a triangle mesh: what they do, and what they refuse.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use ridgeform_core::mesh::vector::{between, distance};
use ridgeform_core::mesh::{invariants, report, Connectivity, Mesh, MeshReport};
use ridgeform_core::remesh::{guard, Edge, EditableMesh, Rings};
use ridgeform_core::shapes::{self, Random, Shape};

fn editable(shape: &Shape) -> EditableMesh {
    EditableMesh::new(shape.vertices.clone(), shape.faces.clone()).unwrap()
}

/// The mesh after the edits, checked: clean, with the number of boundary loops given. The edits ask for no
/// guard of shape, so a face may lose its area and a vertex may come to lie on an open edge by chance.
fn checked(mesh: EditableMesh, n_boundary_loops: usize) -> Mesh {
    let (vertices, faces, _) = mesh.into_parts(|_| false).unwrap();
    let connectivity = Connectivity::new(faces.clone(), vertices.len()).unwrap();
    invariants::check(&connectivity).unwrap();
    let mesh = Mesh::new(vertices, faces).unwrap();
    let found =
        MeshReport { degenerate_faces: Vec::new(), t_junctions: Vec::new(), ..report(&mesh).unwrap() };
    assert_eq!(found, MeshReport { n_components: 1, n_boundary_loops, ..MeshReport::default() });
    mesh
}

fn euler_characteristic(mesh: &Mesh) -> i64 {
    let connectivity = mesh.connectivity();
    connectivity.n_vertices() as i64 - connectivity.edges().count() as i64 + connectivity.n_faces() as i64
}

/// The square 0 1 3 2 with the diagonal 0 3.
fn square() -> EditableMesh {
    editable(&shapes::grid(1, 1))
}

#[test]
fn edges_say_what_lies_at_them() {
    let mesh = square();
    let wings = mesh.wings(0, 3).unwrap();
    assert_eq!((wings.faces, wings.tips), ([1, 0], [2, 1]));
    assert_eq!(mesh.wings(3, 0).unwrap().faces, [0, 1]);
    assert_eq!(mesh.edge(1, 0), Edge::Border(0, 3));
    assert_eq!(mesh.edge(1, 2), Edge::None);
    assert_eq!(mesh.edges().unwrap(), [[0, 1], [0, 2], [0, 3], [1, 3], [2, 3]]);
    assert_eq!((mesh.neighbors(0), mesh.neighbors(1)), (vec![1, 2, 3], vec![0, 3]));
    assert!(mesh.is_border(0) && !editable(&shapes::grid(2, 2)).is_border(4));
    let book = EditableMesh::new(vec![[0.0; 3]; 5], vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
    assert_eq!(book.edge(0, 1), Edge::NonManifold);
    assert!(!book.is_manifold(0) && book.is_manifold(2));
    let bow_tie = EditableMesh::new(vec![[0.0; 3]; 5], vec![[0, 1, 2], [0, 3, 4]]).unwrap();
    assert!(!bow_tie.is_manifold(0) && bow_tie.is_manifold(1));
}

#[test]
fn rings_grow_by_one_edge() {
    let mesh = editable(&shapes::grid(8, 8));
    let center = 4 * 9 + 4;
    assert_eq!(
        [0, 1, 2, 3].map(|rings| Rings::new(&mesh).unwrap().within(center, rings).len()),
        [0, 6, 24, 54]
    );
}

#[test]
fn a_flip_turns_the_diagonal_and_back() {
    let mut mesh = square();
    assert_eq!(mesh.flipped(0, 3), Some([[2, 0, 1], [1, 3, 2]]));
    assert_eq!(mesh.flip(3, 0), Some([1, 2]));
    assert_eq!(mesh.edges().unwrap(), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
    assert_eq!(mesh.flip(0, 3), None);
    assert!(mesh.flip(1, 2).is_some());
    assert_eq!(mesh.flip(0, 1), None, "a border");
    checked(mesh, 1);
}

#[test]
fn a_flip_refuses_an_edge_that_exists_or_is_forbidden() {
    let mut mesh = editable(&shapes::tetrahedron());
    assert!(mesh.edges().unwrap().into_iter().all(|[a, b]| mesh.flip(a, b).is_none()));
    let mut mesh = square();
    mesh.forbid_edge(2, 1);
    assert_eq!(mesh.flip(0, 3), None);
}

#[test]
fn the_guard_refuses_a_flip_across_a_notch_and_a_move_across_an_edge() {
    // An arrowhead: the diagonal that lies outside of it may not be made.
    let mesh = EditableMesh::new(
        vec![[0.0, 0.0, 0.0], [-1.0, -1.0, 0.0], [3.0, 0.0, 0.0], [-1.0, 1.0, 0.0]],
        vec![[0, 1, 2], [0, 2, 3]],
    )
    .unwrap();
    assert!(mesh.flipped(0, 2).is_some() && !guard::may_flip(&mesh, 0, 2));
    assert!(guard::may_flip(&square(), 0, 3));
    let mesh = editable(&shapes::grid(2, 2));
    assert!(guard::may_move(&mesh, 4, [1.2, 0.9, 0.1]) && !guard::may_move(&mesh, 4, [2.2, 1.0, 0.0]));
    assert!(
        guard::may_collapse(&mesh, 4, 8, [2.0, 2.0, 0.0])
            && !guard::may_collapse(&mesh, 0, 4, [3.0, 3.0, 0.0])
    );
}

#[test]
fn splits_keep_the_surface() {
    let mut mesh = square();
    assert_eq!(mesh.split(0, 3, [0.5, 0.5, 0.0]).unwrap(), Some(4));
    assert_eq!(mesh.neighbors(4), [0, 1, 2, 3]);
    assert_eq!(mesh.split(0, 1, [0.5, 0.0, 0.0]).unwrap(), Some(5));
    assert_eq!(mesh.split(1, 2, [0.0; 3]).unwrap(), None);
    assert_eq!(mesh.split_face(0, [0.6, 0.2, 0.0]).unwrap(), Some(6));
    let mesh = checked(mesh, 1);
    assert_eq!((mesh.connectivity().n_faces(), euler_characteristic(&mesh)), (7, 1));
    // Two faces back to back: the edge to their tip would have four.
    let mut pillow = EditableMesh::new(vec![[0.0; 3]; 3], vec![[0, 1, 2], [0, 2, 1]]).unwrap();
    assert_eq!(pillow.split(0, 1, [0.0; 3]).unwrap(), None);
}

#[test]
fn a_collapse_keeps_the_surface_or_is_refused() {
    let mut mesh = editable(&shapes::icosphere(1));
    let end = mesh.position(1);
    let neighbor = mesh.neighbors(1)[0];
    assert!(mesh.collapse(neighbor, 1, end));
    assert!(mesh.faces_of(neighbor).is_empty());
    let mesh = checked(mesh, 0);
    assert_eq!((mesh.connectivity().n_vertices(), euler_characteristic(&mesh)), (41, 2));
    let mut tetrahedron = editable(&shapes::tetrahedron());
    assert!(tetrahedron.edges().unwrap().into_iter().all(|[a, b]| !tetrahedron.collapse(a, b, [0.0; 3])));
    // The diagonal joins two border vertices: without it the sheet would hang together at a point.
    let mut mesh = editable(&shapes::grid(2, 1));
    assert!(!mesh.collapse(1, 5, [0.0; 3]) && !square().collapse(0, 3, [0.0; 3]));
}

#[test]
fn faces_without_a_shape_are_left_out_and_numbers_stay() {
    let mut mesh = EditableMesh::new(vec![[0.0; 3]; 4], vec![[0, 0, 1], [0, 1, 3]]).unwrap();
    assert_eq!((mesh.face(0), mesh.face(1), mesh.n_faces()), (None, Some([0, 1, 3]), 2));
    assert!(EditableMesh::new(vec![[0.0; 3]; 2], vec![[0, 1, 2]]).is_err());
    assert_eq!(mesh.split_face(0, [0.0; 3]).unwrap(), None);
    assert_eq!(mesh.twin().unwrap().into_parts(|_| false).unwrap().2, [0, 1, 3]);
    assert_eq!(mesh.into_parts(|v| v == 2).unwrap().2, [0, 1, 2, 3]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn random_edits_keep_the_surface(seed in any::<u64>(), which in 0..4_usize) {
        let torus = shapes::torus(8, 6, 2.0, 0.7);
        let shape = [shapes::icosphere(2), torus, shapes::grid(6, 5), shapes::cylinder(7, 5, 1.0, 2.0)];
        let n_loops = [0, 0, 1, 2][which];
        let before = euler_characteristic(&shape[which].mesh().unwrap());
        let mut mesh = editable(&shape[which]);
        let mut random = Random::new(seed);
        for _ in 0..200 {
            let edges = mesh.edges().unwrap();
            let [a, b] = edges[(random.bits() % edges.len() as u64) as usize];
            let middle = between(mesh.position(a), mesh.position(b), 0.5);
            match random.bits() % 4 {
                0 => prop_assert!(mesh.split(a, b, middle).unwrap().is_some()),
                1 => { mesh.flip(a, b); }
                _ => { mesh.collapse(a, b, middle); }
            }
        }
        let mesh = checked(mesh, n_loops);
        prop_assert_eq!(euler_characteristic(&mesh), before);
    }

    #[test]
    fn guarded_moves_fold_nothing(seed in any::<u64>()) {
        let mut mesh = editable(&shapes::grid(6, 6));
        let mut random = Random::new(seed);
        for _ in 0..300 {
            let v = (random.bits() % 49) as u32;
            let p = mesh.position(v);
            let target = [p[0] + random.symmetric(), p[1] + random.symmetric(), 0.0];
            if !mesh.is_border(v) && guard::may_move(&mesh, v, target) {
                mesh.set_position(v, target);
                prop_assert!(distance(mesh.position(v), target) == 0.0);
            }
        }
        prop_assert!(mesh.faces().all(|(f, _)| mesh.area_vector(f)[2] > 0.0));
    }
}
