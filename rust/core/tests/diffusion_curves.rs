//! Diffusion curves: borders as curves, colors on their sides, and the surface that they rebuild.
#![allow(clippy::unwrap_used, clippy::float_cmp)]

use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::{CutMesh, EdgeTable, Mesh};
use ridgeform_core::shapes::{self, Random, Shape};
use ridgeform_core::tools::{
    diffusion_curves, redraw, ColoredCurves, DiffusionCurves, DiffusionCurvesOptions,
};
use ridgeform_core::{Error, Progress};

/// A color a vertex.
fn painted(shape: &Shape, color: impl Fn([f64; 3]) -> [f64; 3]) -> Columns {
    Columns::from_points(&shape.vertices.iter().map(|&p| color(p)).collect::<Vec<_>>()).unwrap()
}

/// A label a face, from its barycenter.
fn labeled(shape: &Shape, label: impl Fn([f64; 3]) -> i32) -> Vec<i32> {
    let center = |f: &[u32; 3]| {
        [0, 1, 2].map(|axis| f.iter().map(|&v| shape.vertices[v as usize][axis]).sum::<f64>() / 3.0)
    };
    shape.faces.iter().map(|f| label(center(f))).collect()
}

fn run(shape: &Shape, colors: &Columns, labels: &[i32], options: DiffusionCurvesOptions) -> DiffusionCurves {
    diffusion_curves(&shape.mesh().unwrap(), colors, labels, &options, &Progress::new()).unwrap()
}

fn row(data: &[f64], i: usize) -> &[f64] {
    &data[3 * i..3 * i + 3]
}

#[test]
fn a_cut_gives_each_sector_a_copy() {
    let shape = shapes::grid(4, 4);
    let mesh = shape.mesh().unwrap();
    let table = EdgeTable::new(mesh.connectivity()).unwrap();
    let cut = |edges: &[[u32; 2]]| {
        let mut flags = vec![false; mesh.connectivity().n_halfedges()];
        edges.iter().flat_map(|&[a, b]| table.between(a, b)).for_each(|h| flags[h] = true);
        CutMesh::new(mesh.connectivity(), &table, &flags).unwrap()
    };
    let whole = cut(&[]);
    assert_eq!(whole.n_copies(), 25);
    // From the rim at 2 to the center, 12: two copies on the way, one at the end.
    let slit = cut(&[[2, 7], [7, 12]]);
    assert_eq!(slit.n_copies(), 27);
    let count = |cut: &CutMesh, v: u32| cut.vertices.iter().filter(|&&vertex| vertex == v).count();
    assert_eq!([2, 7, 12].map(|v| count(&slit, v)), [2, 2, 1]);
    // A cross through the center has four sectors there.
    let cross = cut(&[[2, 7], [7, 12], [12, 17], [17, 22], [10, 11], [11, 12], [12, 13], [13, 14]]);
    assert_eq!([12, 7, 2].map(|v| count(&cross, v)), [4, 2, 2]);
    for (face, copies) in shape.faces.iter().zip(&cross.faces) {
        assert_eq!(copies.map(|copy| cross.vertices[copy as usize]), *face);
    }
    // Two triangles that touch at a vertex keep it in common;
    // a face that names a vertex twice joins what is there.
    let faces = vec![[0, 1, 2], [0, 3, 4], [1, 1, 2]];
    let bow = Mesh::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, 1.0, 0.0]],
        faces,
    )
    .unwrap();
    let cut =
        CutMesh::new(bow.connectivity(), &EdgeTable::new(bow.connectivity()).unwrap(), &[false; 9]).unwrap();
    assert_eq!(cut.n_copies(), 5);
}

#[test]
fn two_flat_colors_need_one_closed_curve_and_come_back_exactly() {
    let shape = shapes::grid(20, 20);
    let disk = |p: [f64; 3]| (p[0] - 10.0).hypot(p[1] - 10.0) < 6.0;
    let (inside, outside) = ([0.9, 0.3, 0.1], [0.1, 0.4, 0.8]);
    let colors = painted(&shape, |p| if disk(p) { inside } else { outside });
    for refine in [false, true] {
        // Faces with a corner in the disk belong to it,
        // so the curve runs through vertices of the other color.
        let touches = |f: &[u32; 3]| f.iter().any(|&v| disk(shape.vertices[v as usize]));
        let labels: Vec<i32> = shape.faces.iter().map(|f| i32::from(touches(f))).collect();
        let found = run(&shape, &colors, &labels, DiffusionCurvesOptions { refine, ..Default::default() });
        assert!(found.error < 1e-24, "{}", found.error);
        assert_eq!(found.starts.len(), 2);
        let edges = &found.curves.edges;
        assert!(edges.windows(2).all(|pair| pair[0][1] == pair[1][0]), "the edges form a path");
        assert_eq!(edges[0][0], edges[edges.len() - 1][1]);
        for (f, corners) in found.redrawn.corners.chunks(9).enumerate() {
            let expected = if labels[f] == 1 { inside } else { outside };
            (0..9).for_each(|i| assert!((corners[i] - expected[i % 3]).abs() < 1e-9));
        }
        // The smaller label, outside, lies on the left.
        for i in 0..2 * edges.len() {
            (0..3).for_each(|c| assert!((row(&found.curves.left, i)[c] - outside[c]).abs() < 1e-9));
            (0..3).for_each(|c| assert!((row(&found.curves.right, i)[c] - inside[c]).abs() < 1e-9));
        }
        assert_eq!(found.n_numbers, edges.len() * (2 + 6));
        let thinned = run(
            &shape,
            &colors,
            &labels,
            DiffusionCurvesOptions { refine, color_error: 1e-6, ..Default::default() },
        );
        assert_eq!(thinned.n_numbers, edges.len() * 2 + 2 * 7, "two knots");
        assert!(thinned.error < 1e-12);
    }
}

#[test]
fn blends_on_the_border_belong_to_no_side() {
    let shape = shapes::grid(12, 12);
    // As an image gives them: the colors of the vertices on the border are half and half.
    let (left, right) = ([0.9, 0.3, 0.1], [0.1, 0.4, 0.8]);
    let blend = [0, 1, 2].map(|c| 0.5 * (left[c] + right[c]));
    let colors = painted(&shape, |p| {
        if p[0] == 6.0 {
            blend
        } else if p[0] < 6.0 {
            left
        } else {
            right
        }
    });
    let labels = labeled(&shape, |p| i32::from(p[0] > 6.0));
    let found = run(&shape, &colors, &labels, DiffusionCurvesOptions::default());
    assert!(found.error < 1e-20, "{}", found.error);
    assert_eq!(found.sides.iter().filter(|side| side.is_none()).count(), 13);
}

#[test]
fn curves_end_where_others_meet_them_and_at_the_rim() {
    let shape = shapes::grid(12, 12);
    let third = |p: [f64; 3]| if p[1] < 6.0 { 0 } else { i32::from(p[0] > 6.0) + 1 };
    let labels = labeled(&shape, third);
    let colors = painted(&shape, |p| [p[0] / 12.0, p[1] / 12.0, 0.5]);
    let found = run(&shape, &colors, &labels, DiffusionCurvesOptions::default());
    assert_eq!(found.starts.len() - 1, 3, "three curves meet in the middle");
    assert_eq!(found.curves.edges.len(), 18);
    for bounds in found.starts.windows(2) {
        assert_eq!(bounds[1] - bounds[0], 6);
    }
    let rimmed = run(&shape, &colors, &labels, DiffusionCurvesOptions { rims: true, ..Default::default() });
    assert_eq!(rimmed.curves.edges.len(), 18 + 48);
    assert_eq!(rimmed.starts.len() - 1, 6);
    assert!(rimmed.error < 1e-10, "linear colors are harmonic: {}", rimmed.error);
    // A closed surface in two halves: one closed curve.
    let ball = shapes::icosphere(3);
    let halves = labeled(&ball, |p| i32::from(p[2] > 0.0));
    let found = run(&ball, &painted(&ball, |p| p), &halves, DiffusionCurvesOptions::default());
    assert_eq!(found.starts.len() - 1, 1);
}

#[test]
fn what_no_curve_reaches_gets_a_point() {
    let far = shapes::grid(3, 3).map(|p| [p[0] + 20.0, p[1], p[2]]);
    let shape = shapes::grid(6, 6).and(&far);
    let colors = painted(&shape, |p| if p[0] > 10.0 { [0.2, 0.4, 0.6] } else { [p[0] / 6.0, 0.0, 1.0] });
    let found = run(&shape, &colors, &vec![5; shape.faces.len()], DiffusionCurvesOptions::default());
    assert!(found.curves.edges.is_empty());
    assert_eq!(found.curves.points, [0, 49]);
    assert_eq!(found.n_numbers, 8);
    for i in 0..3 {
        assert!((row(&found.curves.point_colors, 0)[i] - [0.5, 0.0, 1.0][i]).abs() < 1e-12);
        assert!((row(&found.curves.point_colors, 1)[i] - [0.2, 0.4, 0.6][i]).abs() < 1e-12);
    }
    assert!((found.redrawn.colors.column(0)[17] - 0.5).abs() < 1e-9);
}

#[test]
fn colors_stay_in_range_on_obtuse_meshes() {
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let shape = shapes::grid(14, 14).noisy(0.3, seed).map(|p| [9.0 * p[0], p[1], 0.2 * p[2]]);
        let colors = painted(&shape, |_| [0.0; 3]);
        let data = (0..colors.data.len()).map(|_| random.uniform()).collect();
        let colors = Columns { data, ..colors };
        let labels = labeled(&shape, |p| i32::from(p[1] > 7.0) + 2 * i32::from(p[0] > 60.0));
        let mut errors = Vec::new();
        for refine in [false, true] {
            let found = run(
                &shape,
                &colors,
                &labels,
                DiffusionCurvesOptions { refine, rims: seed > 2, ..Default::default() },
            );
            for c in 0..3 {
                let (least, most) =
                    colors.column(c).iter().fold((1.0_f64, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
                let rebuilt = found.redrawn.colors.column(c);
                assert!(rebuilt.iter().all(|x| *x >= least && *x <= most));
                let corners = found.redrawn.corners.iter().skip(c).step_by(3);
                assert!(corners
                    .chain(found.curves.left.iter().skip(c).step_by(3))
                    .all(|x| *x >= least && *x <= most));
            }
            errors.push(found.error);
        }
        assert!(errors[1] < errors[0], "{errors:?}");
    }
}

#[test]
fn the_curves_alone_redraw_the_surface() {
    let shape = shapes::icosphere(3).noisy(0.01, 4);
    let colors = painted(&shape, |p| p.map(|x| 0.5 + 0.4 * (3.0 * x).sin()));
    let labels =
        labeled(&shape, |p| i32::from(p[0] > 0.1) + 2 * i32::from(p[1] > 0.0) + 4 * i32::from(p[2] > -0.2));
    let found =
        run(&shape, &colors, &labels, DiffusionCurvesOptions { color_error: 0.02, ..Default::default() });
    let mesh = shape.mesh().unwrap();
    let again = redraw(&mesh, &found.curves, Some(&found.sides), &Progress::new()).unwrap();
    assert_eq!(again, found.redrawn);
    // In any unit and orientation, and with the vertices turned about their faces.
    let moved = shape.clone().map(|p| p.map(|x| 1000.0 * x)).rotated([1.0, 2.0, 3.0], 1.0);
    let turned = Shape { faces: moved.faces.iter().map(|&[a, b, c]| [b, c, a]).collect(), ..moved };
    let other =
        run(&turned, &colors, &labels, DiffusionCurvesOptions { color_error: 0.02, ..Default::default() });
    assert_eq!(other.curves.edges, found.curves.edges);
    let pairs = other.redrawn.colors.data.iter().zip(&found.redrawn.colors.data);
    assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-3);
}

#[test]
fn open_curves_diffuse_around_their_ends() {
    let shape = shapes::grid(8, 8);
    let mesh = shape.mesh().unwrap();
    let edges: Vec<[u32; 2]> = (2..6).map(|i| [9 * i + 4, 9 * (i + 1) + 4]).collect();
    let n = edges.len();
    let curves = ColoredCurves {
        edges,
        n_channels: 1,
        left: vec![0.0; 2 * n],
        right: vec![1.0; 2 * n],
        ..ColoredCurves::default()
    };
    let colors = redraw(&mesh, &curves, None, &Progress::new()).unwrap().colors;
    let at = |i: usize, j: usize| colors.column(0)[9 * j + i];
    // The curve runs up, so its left is at small x; beyond its ends the colors go over into each other.
    assert!(at(3, 4) < 0.3 && at(5, 4) > 0.7);
    assert!((0.3..0.7).contains(&at(4, 0)) && at(3, 0) < at(4, 0) && at(4, 0) < at(5, 0));
    assert!((at(4, 4) - 0.5).abs() < 1e-12, "the mean of its sides");
}

#[test]
fn bad_surfaces_are_drawn_too() {
    // Three pages on one spine, one of another color; a Möbius strip; a page with a face without area.
    let book = Shape {
        vertices: vec![[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]],
        faces: vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]],
    };
    let colors = painted(&book, |p| if p[0] > 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] });
    let found = run(&book, &colors, &[1, 0, 0], DiffusionCurvesOptions::default());
    assert_eq!(found.curves.edges.len(), 1);
    assert_eq!(
        [row(&found.curves.left, 0)[2], row(&found.curves.right, 1)[0]],
        [1.0, 1.0],
        "the odd page is a side"
    );
    assert!(found.redrawn.colors.data.iter().all(|x| (0.0..=1.0).contains(x)), "{found:?}");
    let strip = shapes::grid(9, 2);
    let twisted = |v: u32| if v % 10 == 9 { 10 * (2 - v / 10) } else { v };
    let strip = Shape { faces: strip.faces.iter().map(|f| f.map(twisted)).collect(), ..strip };
    let labels: Vec<i32> = (0..strip.faces.len()).map(|f| i32::from(f % 18 < 9)).collect();
    let found =
        run(&strip, &painted(&strip, |p| [p[0] / 9.0, 0.0, 0.5]), &labels, DiffusionCurvesOptions::default());
    assert!(found.error.is_finite());
    let mut flat = shapes::grid(4, 4);
    flat.faces.extend([[0, 1, 1], [2, 2, 2], [0, 2, 1]]);
    let labels = vec![0; flat.faces.len()];
    let found =
        run(&flat, &painted(&flat, |_| [0.25, 0.5, 0.75]), &labels, DiffusionCurvesOptions::default());
    assert!(found.error < 1e-20);
}

#[test]
fn refusals_name_the_argument() {
    let shape = shapes::grid(2, 2);
    let mesh = shape.mesh().unwrap();
    let colors = painted(&shape, |p| p);
    let options = DiffusionCurvesOptions::default();
    let name = |error: Error| match error {
        Error::Argument { name, problem } => format!("{name}: {problem}"),
        other => other.to_string(),
    };
    let find = |labels: &[i32], options: &DiffusionCurvesOptions| {
        name(diffusion_curves(&mesh, &colors, labels, options, &Progress::new()).unwrap_err())
    };
    assert!(find(&[0; 7], &options).starts_with("labels: has 7 entries"));
    assert!(find(&[0; 8], &DiffusionCurvesOptions { fidelity: 0.0, ..options }).starts_with("fidelity"));
    assert!(
        find(&[0; 8], &DiffusionCurvesOptions { color_error: -1.0, ..options }).starts_with("color_error")
    );
    let draw = |curves: &ColoredCurves, sides: Option<&[Option<u32>]>| {
        name(redraw(&mesh, curves, sides, &Progress::new()).unwrap_err())
    };
    let mut curves = ColoredCurves { n_channels: 1, ..ColoredCurves::default() };
    assert!(draw(&curves, None).contains("the piece of surface of face 0"));
    curves.edges = vec![[0, 8]];
    assert!(draw(&curves, None).starts_with("left: has 0 numbers"));
    (curves.left, curves.right) = (vec![0.0; 2], vec![0.0, f64::NAN]);
    assert!(draw(&curves, None).starts_with("right: row 1 is not finite"));
    curves.right[1] = 0.0;
    assert!(draw(&curves, None).contains("no edge of the mesh joins vertices 0 and 8"));
    curves.edges = vec![[0, 1]];
    assert!(draw(&curves, Some(&[Some(7); 9])).contains("entry 0 names face 7"));
    let cancelled = Progress::new();
    cancelled.cancel();
    let error = diffusion_curves(&mesh, &colors, &[0; 8], &options, &cancelled).unwrap_err();
    assert_eq!(error, Error::Cancelled);
}
