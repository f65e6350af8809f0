//! Which loops are holes, and how they are triangulated.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use ridgeform_core::error::{Error, MeshError, Refusal};
use ridgeform_core::hole_filling::{fill_loop, fill_loops, fillable_loops, find_holes, FillOptions, Patch};
use ridgeform_core::mesh::vector::{area_vector, norm};
use ridgeform_core::mesh::{invariants, report, Mesh, MeshReport};
use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::Progress;

fn flat() -> FillOptions {
    FillOptions { refine: false, ..FillOptions::default() }
}

/// The mesh with patches, checked: sound connectivity, nothing non-manifold or degenerate that was not there before.
fn patched(mesh: &Mesh, patches: &[Patch]) -> Mesh {
    let mut vertices = mesh.positions().unwrap().to_vec();
    let mut faces = mesh.connectivity().faces().to_vec();
    for patch in patches {
        vertices.extend(&patch.vertices);
        faces.extend(&patch.faces);
    }
    let filled = Mesh::new(vertices, faces).unwrap();
    invariants::check(filled.connectivity()).unwrap();
    let (before, after) = (report(mesh), report(&filled));
    let kept = MeshReport {
        n_components: after.n_components,
        n_boundary_loops: before.n_boundary_loops - patches.len(),
        nonmanifold_vertices: after.nonmanifold_vertices.clone(),
        ..before.clone()
    };
    assert_eq!(after, kept);
    assert!(after.nonmanifold_vertices.iter().all(|v| before.nonmanifold_vertices.contains(v)));
    filled
}

fn fill_all(shape: &Shape, options: &FillOptions) -> (Mesh, Vec<Patch>) {
    let mesh = shape.mesh().unwrap();
    let loops = fillable_loops(&mesh).unwrap();
    let patches = fill_loops(&mesh, &loops, options, &Progress::new()).unwrap();
    (patched(&mesh, &patches), patches)
}

fn refusal(mesh: &Mesh, rim: &[u32]) -> Refusal {
    match fill_loop(mesh, rim, &FillOptions::default(), &Progress::new()) {
        Err(Error::Mesh(MeshError::Unfillable { reason, .. })) => reason,
        other => panic!("{other:?}"),
    }
}

/// How many loops there are, and which of them are outer borders.
fn outer_borders(shape: &Shape) -> (usize, Vec<usize>) {
    let holes = find_holes(&shape.mesh().unwrap()).unwrap();
    assert!(holes.iter().all(|hole| hole.refusal.is_none()));
    (holes.len(), (0..holes.len()).filter(|&i| holes[i].is_outer_border).collect())
}

#[test]
fn a_sheet_keeps_its_outer_border_and_a_body_keeps_none() {
    assert_eq!(outer_borders(&shapes::grid(6, 6)), (1, vec![0]));
    let sheet = shapes::grid(9, 9).without_faces(|f| [40, 41, 80, 81, 82, 83].contains(&f));
    assert_eq!(outer_borders(&sheet), (3, vec![0]));
    assert_eq!(outer_borders(&sheet.map(|p| [p[0], p[1], (0.5 * p[0]).sin()])), (3, vec![0]));
    assert_eq!(outer_borders(&shapes::cube(3).without_faces(|f| f < 18)), (1, vec![]));
    assert_eq!(outer_borders(&shapes::cylinder(12, 4, 1.0, 3.0)), (2, vec![]));
    assert_eq!(outer_borders(&shapes::cylinder(12, 1, 1.0, 0.1)), (2, vec![]));
    let half = shapes::icosphere(3);
    let below = |f: usize| half.faces[f].iter().all(|&v| half.vertices[v as usize][2] < 0.0);
    assert_eq!(outer_borders(&half.clone().without_faces(below)), (1, vec![]));
    // Two sheets and a tube: every component is judged alone.
    let several = shapes::grid(3, 3).and(&shapes::cylinder(8, 3, 1.0, 2.0)).and(&shapes::grid(2, 2));
    assert_eq!(outer_borders(&several), (4, vec![0, 3]));
}

#[test]
fn a_face_that_looks_the_other_way_does_not_make_a_sheet_a_body() {
    let mut sheet = shapes::grid(4, 4);
    (0..16).for_each(|f| sheet.faces[f].swap(0, 1));
    let holes = find_holes(&sheet.mesh().unwrap()).unwrap();
    assert!(holes[0].is_outer_border && holes[0].refusal == Some(Refusal::InconsistentOrientation));
}

#[test]
fn a_square_hole_takes_two_triangles() {
    let (mesh, patches) = fill_all(&shapes::grid(3, 3).without_faces(|f| f / 2 == 4), &flat());
    assert!(patches[0].vertices.is_empty());
    assert_eq!(patches[0].faces.len(), 2);
    assert_eq!(mesh.connectivity().n_faces(), 18);
    let area: f64 =
        patches[0].faces.iter().map(|f| area_vector(f.map(|v| mesh.positions().unwrap()[v as usize]))[2]).sum();
    assert!((area - 1.0).abs() < 1e-12);
}

#[test]
fn a_flat_hole_is_filled_flat_and_without_overlap_also_where_it_is_not_convex() {
    // An L of three cells, and a hole with straight sides of several edges.
    for cells in [vec![6, 7, 11], vec![6, 7, 8, 11, 12, 13, 16, 17, 18], vec![6, 7, 8, 11, 16, 17, 18]] {
        let shape = shapes::grid(5, 5).without_faces(|f| cells.contains(&(f / 2)));
        let (mesh, patches) = fill_all(&shape, &flat());
        let positions = mesh.positions().unwrap();
        let areas: Vec<f64> =
            patches[0].faces.iter().map(|f| area_vector(f.map(|v| positions[v as usize]))[2]).collect();
        assert!(areas.iter().all(|&a| a > 0.1), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - cells.len() as f64).abs() < 1e-9);
    }
}

#[test]
fn a_hole_across_the_edge_of_a_box_is_filled_without_a_chamfer_deeper_than_needed() {
    let (mesh, _) = fill_all(&shapes::cube(2).without_faces(|f| f < 8), &flat());
    assert!(report(&mesh).n_boundary_loops == 0);
}

#[test]
fn long_loops_are_divided_and_still_filled_soundly() {
    let disk = shapes::cylinder(3000, 1, 1.0, 0.002);
    let (_, patches) = fill_all(&disk, &flat());
    for patch in &patches {
        assert_eq!((patch.vertices.len(), patch.faces.len()), (0, 2998));
    }
    // Straight sides: no triangle may lie on one.
    let frame = shapes::grid(152, 152).without_faces(|f| {
        let (i, j) = ((f / 2) % 152, f / 2 / 152);
        (1..151).contains(&i) && (1..151).contains(&j)
    });
    let (mesh, patches) = fill_all(&frame, &flat());
    let positions = mesh.positions().unwrap();
    let area: f64 = patches[0].faces.iter().map(|f| norm(area_vector(f.map(|v| positions[v as usize])))).sum();
    assert!((area - 22500.0).abs() < 1e-6, "{area}");
}

#[test]
fn loops_that_cannot_be_filled_are_refused_by_name() {
    let triangle = Shape { vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], faces: vec![[0, 1, 2]] };
    let triangle = triangle.mesh().unwrap();
    assert_eq!(find_holes(&triangle).unwrap()[0].refusal, Some(Refusal::SingleFace));
    assert_eq!(refusal(&triangle, &[0, 1, 2]), Refusal::SingleFace);
    let sheet = shapes::grid(3, 3).without_faces(|f| f / 2 == 4).mesh().unwrap();
    for wrong in [vec![], vec![5, 6], vec![5, 6, 10, 10], vec![0, 1, 5, 4], vec![5, 6, 10, 99]] {
        assert_eq!(refusal(&sheet, &wrong), Refusal::NotALoop, "{wrong:?}");
    }
    // A slit: two sides of a seam that were never merged.
    let mut seam = shapes::grid(4, 2);
    seam.vertices.push([2.0, 1.0, 0.0]);
    for face in &mut seam.faces[8..] {
        *face = face.map(|v| if v == 7 { 15 } else { v });
    }
    let seam = seam.mesh().unwrap();
    let holes = find_holes(&seam).unwrap();
    assert_eq!(holes.iter().map(|h| h.refusal).collect::<Vec<_>>(), [None, Some(Refusal::NoExtent)]);
    assert_eq!(refusal(&seam, &holes[1].vertices), Refusal::NoExtent);
    let lengths = Mesh::from_edge_lengths(vec![[0, 1, 2]], vec![[1.0; 3]], None).unwrap();
    assert_eq!(find_holes(&lengths), Err(MeshError::NoPositions.into()));
}
