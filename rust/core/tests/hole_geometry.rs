//! Which loops are holes, and how they are triangulated.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod hole_checks;

use hole_checks::{patch_corners, patched, patches_of, shapeliness};
use ridgeform_core::error::{Error, MeshError, Refusal};
use ridgeform_core::hole_filling::{find_holes, FillOptions, Patch};
use ridgeform_core::mesh::vector::{area_vector, distance, dot, norm, quality};
use ridgeform_core::mesh::{boundary_loops, report, Mesh};
use ridgeform_core::shapes::{self, Shape};

fn flat() -> FillOptions {
    FillOptions { refine: false, ..FillOptions::default() }
}

/// The loops that are neither an outer border nor refused.
fn fillable_loops(mesh: &Mesh) -> Result<Vec<Vec<u32>>, Error> {
    let fillable =
        find_holes(mesh)?.into_iter().filter(|hole| !hole.is_outer_border && hole.refusal.is_none());
    Ok(fillable.map(|hole| hole.vertices).collect())
}

fn fill_all(shape: &Shape, options: &FillOptions) -> (Mesh, Vec<Patch>) {
    let mesh = shape.mesh().unwrap();
    let loops = fillable_loops(&mesh).unwrap();
    let patches = patches_of(&mesh, &loops, options).unwrap();
    (patched(&mesh, &patches).unwrap(), patches)
}

fn filled(mesh: &Mesh, rim: &[u32], options: &FillOptions) -> Result<Patch, Error> {
    Ok(patches_of(mesh, &[rim.to_vec()], options)?.remove(0))
}

fn refusal(mesh: &Mesh, rim: &[u32]) -> Refusal {
    match filled(mesh, rim, &FillOptions::default()) {
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
    let aside = |shape: Shape, by: f64| shape.map(|p| [p[0] + by, p[1], p[2]]);
    let tube = aside(shapes::cylinder(8, 3, 1.0, 2.0), 10.0);
    let several = shapes::grid(3, 3).and(&tube).and(&aside(shapes::grid(2, 2), 20.0));
    assert_eq!(outer_borders(&several), (4, vec![0, 3]));
}

#[test]
fn a_face_that_looks_the_other_way_does_not_make_a_sheet_a_body() {
    let mut sheet = shapes::grid(4, 4);
    (0..16).for_each(|f| sheet.faces[f].swap(0, 1));
    let holes = find_holes(&sheet.mesh().unwrap()).unwrap();
    assert!(holes[0].is_outer_border && holes[0].refusal.is_none());
}

#[test]
fn a_square_hole_takes_two_triangles() {
    let (mesh, patches) = fill_all(&shapes::grid(3, 3).without_faces(|f| f / 2 == 4), &flat());
    assert!(patches[0].vertices.is_empty());
    assert_eq!(patches[0].faces.len(), 2);
    assert_eq!(mesh.connectivity().n_faces(), 18);
    let area: f64 = patches[0]
        .faces
        .iter()
        .map(|f| area_vector(f.map(|v| mesh.positions().unwrap()[v as usize]))[2])
        .sum();
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
fn a_hole_across_the_edge_of_a_box_gets_one_chamfer_from_end_to_end() {
    // The cells along an edge of the cube: between its two ends nothing has to bend by more than the 45
    // degrees of a chamfer.
    let cube = shapes::cube(8);
    let near = |p: &[f64; 3]| p[0] + p[1] > 1.4 && p[2].abs() < 0.6;
    let hole =
        cube.clone().without_faces(|f| cube.faces[f].iter().all(|&v| near(&cube.vertices[v as usize])));
    let mesh = hole.mesh().unwrap();
    let patch = filled(&mesh, &fillable_loops(&mesh).unwrap()[0], &flat()).unwrap();
    let filled = patched(&mesh, &[patch]).unwrap();
    assert!(shapeliness(&filled, mesh.connectivity().n_faces()).cosine > -1e-9);
}

/// A fan of a regular polygon with `n` corners at height `height(angle)`, turned inside out:
/// its rim is a hole.
fn ring(n: usize, height: impl Fn(f64) -> f64) -> Shape {
    shapes::cylinder(n, 1, 1.0, -1.0).map(|[x, y, z]| {
        if z == 0.0 {
            [x, y, height(y.atan2(x))]
        } else {
            [1.5 * x, 1.5 * y, z]
        }
    })
}

#[test]
fn a_regular_polygon_and_a_saddle_are_filled_with_even_triangles() {
    for (n, wave) in [(6, 0.0), (7, 0.0), (24, 0.0), (40, 0.4), (60, 0.8)] {
        let mesh = ring(n, |angle| wave * (2.0 * angle).sin()).mesh().unwrap();
        let rim =
            find_holes(&mesh).unwrap().into_iter().map(|h| h.vertices).find(|rim| rim.contains(&0)).unwrap();
        let simple = filled(&mesh, &rim, &flat()).unwrap();
        assert_eq!((simple.vertices.len(), simple.faces.len()), (0, n - 2));
        let patch = filled(&mesh, &rim, &FillOptions::default()).unwrap();
        let filled = patched(&mesh, std::slice::from_ref(&patch)).unwrap();
        let least = patch_corners(&filled, &patch).map(quality).fold(1.0, f64::min);
        assert!(least > 0.5, "{n} {wave}: {least}");
        if wave == 0.0 {
            assert!(patch.vertices.iter().all(|p| p[2].abs() < 1e-12));
            assert!(patch_corners(&filled, &patch).all(|t| area_vector(t)[2].abs() > 0.0));
        }
        let edge = rim.iter().zip(rim.iter().cycle().skip(1)).map(|(&a, &b)| {
            distance(mesh.positions().unwrap()[a as usize], mesh.positions().unwrap()[b as usize])
        });
        let edge = edge.sum::<f64>() / n as f64;
        let inside = patch_corners(&filled, &patch).map(|t| distance(t[0], t[1])).sum::<f64>()
            / patch.faces.len() as f64;
        assert!(n < 20 || (inside / edge - 1.0).abs() < 0.35, "{n} {wave}: {inside} of {edge}");
    }
}

#[test]
fn the_edge_length_can_be_set_and_faces_be_limited() {
    let mesh = ring(64, |_| 0.0).mesh().unwrap();
    let rim =
        find_holes(&mesh).unwrap().into_iter().map(|h| h.vertices).find(|rim| rim.contains(&0)).unwrap();
    let count = |options: &FillOptions| filled(&mesh, &rim, options).unwrap().faces.len();
    let usual = count(&FillOptions::default());
    let coarse = count(&FillOptions { edge_length: Some(0.3), ..FillOptions::default() });
    let fine = count(&FillOptions { edge_length: Some(0.05), ..FillOptions::default() });
    let limited = count(&FillOptions { max_faces: 300, ..FillOptions::default() });
    assert!(
        coarse < usual && usual < fine && limited < 450 && limited < usual,
        "{coarse} {usual} {fine} {limited}"
    );
}

#[test]
fn holes_that_touch_and_rims_that_touch_themselves_are_filled() {
    // Cells that meet at vertices only, and a frame whose inner rim touches the outer one.
    for cells in [vec![14, 21, 28], vec![7, 14], vec![14, 15, 22, 27, 26], vec![0, 7]] {
        let shape = shapes::grid(6, 6).without_faces(|f| cells.contains(&(f / 2)));
        let (filled, patches) = fill_all(&shape, &FillOptions::default());
        let area: f64 = patches
            .iter()
            .flat_map(|p| patch_corners(&filled, p).collect::<Vec<_>>())
            .map(|t| area_vector(t)[2])
            .sum();
        let corner_cells = cells.iter().filter(|&&c| c == 0).count();
        assert!((area - (cells.len() - corner_cells) as f64).abs() < 1e-9, "{cells:?}: {area}");
        assert!(report(&filled).unwrap().nonmanifold_edges.is_empty());
    }
}

#[test]
fn no_edge_is_made_that_exists_already() {
    // Two vertices of the rim are joined across the back, so the diagonals of the square hole are both taken.
    let square = Shape {
        vertices: vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 0.5, -1.0],
            [0.5, 0.5, -2.0],
        ],
        faces: vec![[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0], [0, 5, 2], [1, 5, 3]],
    };
    let mesh = square.mesh().unwrap();
    for options in [flat(), FillOptions::default()] {
        let patch = filled(&mesh, &[0, 1, 2, 3], &options).unwrap();
        let filled = patched(&mesh, std::slice::from_ref(&patch)).unwrap();
        assert!(patch.faces.len() >= 4 && !patch.vertices.is_empty());
        assert!(report(&filled).unwrap().nonmanifold_edges.is_empty());
    }
    // Both sides of a thin plate: what the first patch makes, the second may not.
    let band = shapes::cylinder(4, 1, 1.0, 0.1);
    let (filled, _) = fill_all(&band, &flat());
    assert_eq!(report(&filled).unwrap().n_boundary_loops, 0);
}

#[test]
fn an_island_in_a_hole_is_named() {
    let sheet = shapes::grid(9, 9).without_faces(|f| {
        let (i, j) = ((f / 2) % 9, f / 2 / 9);
        (2..7).contains(&i) && (2..7).contains(&j) && (i, j) != (4, 4)
    });
    let holes = find_holes(&sheet.mesh().unwrap()).unwrap();
    let said: Vec<_> = holes.iter().map(|h| (h.vertices.len(), h.is_outer_border, h.refusal)).collect();
    assert_eq!(said, [(36, true, None), (20, false, Some(Refusal::Island)), (4, true, None)]);
    // Not if the piece lies elsewhere, or is a speck.
    let beside = shapes::grid(9, 9).without_faces(|f| f / 2 == 40);
    let far = beside.clone().and(&shapes::grid(1, 1).map(|p| [0.4 * p[0] + 4.3, 0.4 * p[1] + 4.3, 3.0]));
    assert_eq!(fillable_loops(&far.mesh().unwrap()).unwrap().len(), 1);
    let speck = beside.and(&shapes::grid(1, 1).map(|p| [0.05 * p[0] + 4.5, 0.05 * p[1] + 4.5, 0.0]));
    assert_eq!(fillable_loops(&speck.mesh().unwrap()).unwrap().len(), 1);
}

#[test]
fn patches_turn_and_grow_with_the_mesh() {
    let shape = shapes::icosphere(3).without_faces(|f| f < 60);
    let (filled, _) = fill_all(&shape, &FillOptions::default());
    let turned = shape.rotated([1.0, 2.0, 0.5], 0.8).map(|p| p.map(|x| 1000.0 * x));
    let (other, _) = fill_all(&turned, &FillOptions::default());
    let back = Shape { vertices: other.positions().unwrap().to_vec(), faces: Vec::new() };
    let back = back.map(|p| p.map(|x| x / 1000.0)).rotated([1.0, 2.0, 0.5], -0.8);
    let near = |p: &[f64; 3]| {
        filled.positions().unwrap().iter().map(|&q| distance(*p, q)).fold(f64::INFINITY, f64::min)
    };
    // Ties may be decided otherwise by rounding, but the surface is the same.
    assert!(back.vertices.iter().all(|p| near(p) < 0.08));
    assert!(filled.positions().unwrap().iter().all(|&p| dot(p, p) < 1.0 + 1e-9));
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
    let area: f64 =
        patches[0].faces.iter().map(|f| norm(area_vector(f.map(|v| positions[v as usize])))).sum();
    assert!((area - 22500.0).abs() < 1e-6, "{area}");
}

#[test]
fn loops_that_cannot_be_filled_are_refused_by_name() {
    let triangle =
        Shape { vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], faces: vec![[0, 1, 2]] };
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
    assert_eq!(refusal(&seam, &boundary_loops(seam.connectivity()).unwrap()[1]), Refusal::NoExtent);
    // Looking for holes joins them first.
    let holes = find_holes(&seam).unwrap();
    assert_eq!(holes.iter().map(|h| (h.vertices.len(), h.refusal)).collect::<Vec<_>>(), [(12, None)]);
    let lengths = Mesh::from_edge_lengths(vec![[0, 1, 2]], vec![[1.0; 3]], None).unwrap();
    assert_eq!(find_holes(&lengths), Err(MeshError::NoPositions.into()));
}

/// A ring around one round hole of `n` edges.
fn wide_ring(n: u32) -> Mesh {
    let at = |i: u32, radius: f64, z: f64| {
        let angle = 2.0 * std::f64::consts::PI * f64::from(i) / f64::from(n);
        [radius * angle.cos(), radius * angle.sin(), z]
    };
    let vertices = (0..n).map(|i| at(i, 1.0, 0.0)).chain((0..n).map(|i| at(i, 1.1, 0.05))).collect();
    let faces =
        (0..n).flat_map(|i| [[i, n + i, n + (i + 1) % n], [i, n + (i + 1) % n, (i + 1) % n]]).collect();
    Mesh::new(vertices, faces).unwrap()
}

#[test]
fn a_budget_that_a_rim_cannot_meet_gives_way_and_the_patch_stays_bounded() {
    for (n, max_faces) in [(400, 10), (400, 1000), (1500, 2000), (900, 40_000)] {
        let mesh = wide_ring(n);
        let hole = find_holes(&mesh).unwrap().into_iter().find(|hole| hole.vertices[0] < n).unwrap();
        let options = FillOptions { max_faces, ..FillOptions::default() };
        let patch = filled(&mesh, &hole.vertices, &options).unwrap();
        let most = 2 * max_faces.max(5 * n as usize);
        assert!(
            (n as usize - 2..most).contains(&patch.faces.len()),
            "{n} edges: {} faces",
            patch.faces.len()
        );
    }
}

#[test]
fn lengths_that_coordinates_cannot_tell_apart_end() {
    let shape = shapes::grid(7, 7);
    let fine = |p: &[f64; 3]| p.map(|x| 1.0 + f64::EPSILON * (1.0 + x.round()));
    let mesh = Mesh::new(shape.vertices.iter().map(fine).collect(), shape.faces).unwrap();
    for hole in find_holes(&mesh).unwrap() {
        if let Ok(patch) = filled(&mesh, &hole.vertices, &FillOptions::default()) {
            assert!(patch.faces.len() < 10_000, "{} faces", patch.faces.len());
        }
    }
}

#[test]
fn an_edge_length_that_asks_for_more_faces_than_there_is_memory_is_refused() {
    let mesh = wide_ring(40);
    let hole = find_holes(&mesh).unwrap().remove(0).vertices;
    let options = FillOptions { edge_length: Some(1e-12), ..FillOptions::default() };
    let error = filled(&mesh, &hole, &options).unwrap_err();
    assert!(error.to_string().starts_with("edge_length: 0.000000000001 would make"), "{error}");
}
