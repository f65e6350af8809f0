//! A flow that looks for its end by itself: how far it goes, when it has settled,
//! and what does not change that.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::tools::{stylize, Flatness, FlowStatus, Scale, StylizeOptions, Stylized};
use ridgeform_core::{Error, Progress};

const AXIS: [f64; 3] = [0.3, -1.0, 0.7];

fn options(movement: f64) -> StylizeOptions {
    StylizeOptions {
        fidelity: 3e6,
        movement: Some(movement),
        sharpness: 0.75,
        scale: Scale::Area,
        ..StylizeOptions::default()
    }
}

fn flow(shape: &Shape, options: &StylizeOptions) -> Stylized {
    stylize(&shape.mesh().unwrap(), options, &Progress::new()).unwrap()
}

/// Root mean square distance, weighted by a third of the faces' areas before,
/// in parts of the root of the area.
fn moved(shape: &Shape, result: &Stylized) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for face in &shape.faces {
        let [a, b, c] = face.map(|v| shape.vertices[v as usize]);
        let area = ridgeform_core::mesh::vector::norm(ridgeform_core::mesh::vector::area_vector([a, b, c]));
        total += area;
        for v in face {
            let (p, q) = (shape.vertices[*v as usize], result.vertices[*v as usize]);
            sum += area / 3.0 * ridgeform_core::mesh::vector::distance(p, q).powi(2);
        }
    }
    (sum / total).sqrt() / total.sqrt()
}

fn blob() -> Shape {
    shapes::icosphere(4)
        .map(|[x, y, z]| [x * (1.0 + 0.2 * (3.0 * y).sin()), 1.3 * y, z * (1.0 + 0.15 * (4.0 * x).cos())])
}

#[test]
fn it_moves_as_far_as_it_may_and_little_farther() {
    for movement in [0.002, 0.007, 0.02] {
        let result = flow(&blob(), &options(movement));
        assert_eq!(result.status, FlowStatus::Reached);
        let moved = moved(&blob(), &result);
        assert!(moved > 0.95 * movement && moved < 1.3 * movement, "{moved} {movement}");
        assert!(result.flatness[1].flat_share > result.flatness[0].flat_share);
    }
}

#[test]
fn it_ends_when_enough_is_flat_and_facets_have_formed() {
    let asked = |share| StylizeOptions { flat_share: Some(share), movement: None, ..options(1.0) };
    let [less, more] = [0.2, 0.5].map(|share| flow(&blob(), &asked(share)));
    assert_eq!([less.status, more.status], [FlowStatus::Reached; 2]);
    let [less, more] = [less, more].map(|result| result.flatness[1].flat_share);
    assert!(less >= 0.2 && less < more && more >= 0.5, "{less} {more}");
    // Under noise planes come out at once: they are not left half done because a fifth is flat already.
    let noisy = flow(&shapes::cube(16).noisy(0.015, 3), &asked(0.2));
    assert!(noisy.flatness[1].flat_share > 0.7, "{:?}", noisy.flatness);
    // Whichever comes first.
    let near = flow(&blob(), &StylizeOptions { movement: Some(0.001), ..asked(0.5) });
    assert!(moved(&blob(), &near) < 0.0013);
}

#[test]
fn planes_that_meet_in_ridges_are_left_as_they_are() {
    for shape in [shapes::cube(1), shapes::cube(9).rotated(AXIS, 0.8), shapes::grid(6, 5)] {
        let result = flow(&shape, &options(0.007));
        assert_eq!((result.status, result.gap.len()), (FlowStatus::Settled, 0));
        assert_eq!(result.vertices, shape.vertices);
    }
}

#[test]
fn rough_noise_is_not_taken_for_planes() {
    let shape = shapes::cube(12).noisy(0.15, 5);
    let result = flow(&shape, &options(0.02));
    assert!(!result.gap.is_empty() && result.flatness[1].n_facets < result.flatness[0].n_facets);
}

#[test]
fn a_noisy_cube_settles_at_its_planes_however_far_it_may_move() {
    let shape = shapes::cube(16).noisy(0.015, 3);
    let result = flow(&shape, &options(0.1));
    assert_eq!(result.status, FlowStatus::Settled);
    assert!(result.flatness[1].flat_share > 0.7, "{:?}", result.flatness);
    assert!(moved(&shape, &result) < 0.01);
    assert!(result.gap.len() < 15);
}

#[test]
fn density_rotation_and_size_do_not_change_where_it_ends() {
    let shape = blob();
    let base = flow(&shape, &options(0.007));
    let turned = flow(&shape.clone().rotated(AXIS, 1.1), &options(0.007));
    let larger = flow(&shape.clone().map(|p| p.map(|x| 64.0 * x)), &options(0.007));
    for other in [turned, larger] {
        assert_eq!((other.status, other.gap.len()), (base.status, base.gap.len()));
        assert!((other.flatness[1].flat_share - base.flatness[1].flat_share).abs() < 1e-6);
    }
}

#[test]
fn movement_is_that_of_the_free_vertices() {
    let shape = blob();
    let fixed: Vec<bool> = shape.vertices.iter().map(|p| p[1] < 0.6).collect();
    let held = flow(&shape, &StylizeOptions { fixed: Some(fixed.clone()), ..options(0.007) });
    assert_eq!(held.status, FlowStatus::Reached);
    let farthest = |want: bool| {
        let rows = shape.vertices.iter().zip(&held.vertices).zip(&fixed).filter(|(_, is)| **is == want);
        rows.map(|((p, q), _)| ridgeform_core::mesh::vector::distance(*p, *q)).fold(0.0, f64::max)
    };
    assert_eq!(farthest(true), 0.0);
    assert!(farthest(false) > 0.007);
    let none = flow(&shape, &StylizeOptions { fixed: Some(vec![true; fixed.len()]), ..options(0.007) });
    assert_eq!((none.status, &none.vertices), (FlowStatus::Converged, &shape.vertices));
}

#[test]
fn steps_that_run_out_or_miss_the_gap_are_told() {
    let short = flow(&blob(), &StylizeOptions { iterations: 2, ..options(0.02) });
    assert_eq!((short.status, short.gap.len()), (FlowStatus::Finished, 2));
    let mut hasty = options(0.007);
    hasty.solve.tolerance = Some(1e-9);
    hasty.solve.max_iterations = Some(2);
    assert_eq!(flow(&blob(), &hasty).status, FlowStatus::Inaccurate);
    let wrong = stylize(&blob().mesh().unwrap(), &options(0.0), &Progress::new());
    assert!(matches!(wrong, Err(Error::Argument { .. })));
}

#[test]
fn loose_cards_that_were_rounded_are_flat_already() {
    let card = shapes::grid(1, 1);
    let turned = |k: u32| {
        let card = card.clone().rotated([0.3, f64::from(k), -0.7], 0.4 * f64::from(k));
        card.map(|[x, y, z]| [x + f64::from(k), y, z].map(|x| f64::from(x as f32)))
    };
    let mut all = Shape { vertices: Vec::new(), faces: Vec::new() };
    for card in (0..40).map(turned) {
        let n = all.vertices.len() as u32;
        all.faces.extend(card.faces.iter().map(|face| face.map(|v| v + n)));
        all.vertices.extend(card.vertices);
    }
    let result = flow(&all, &options(0.007));
    assert_eq!((result.status, result.gap.len(), &result.vertices), (FlowStatus::Settled, 0, &all.vertices));
}

#[test]
fn flatness_of_known_shapes() {
    let of = |shape: &Shape| {
        let mesh = shape.mesh().unwrap();
        Flatness::of(mesh.connectivity(), &shape.vertices).unwrap()
    };
    let cube = of(&shapes::cube(8));
    assert_eq!((cube.n_facets, cube.soft_share < 1e-9, cube.plane_share), (6, true, 1.0));
    // The faces in the two rows beside the edges meet a neighbor at a right angle,
    // but for one triangle of two at some.
    assert!(cube.flat_share > 0.5 && cube.flat_share < 0.9);
    let sheet = of(&shapes::grid(5, 4));
    assert_eq!((sheet.n_facets, sheet.flat_share, sheet.soft_share), (1, 1.0, 0.0));
    let ball = of(&shapes::icosphere(3));
    assert_eq!((ball.flat_share, ball.soft_share, ball.plane_share), (0.0, 1.0, 0.0));
    let turned = shapes::cube(3);
    let mut reversed = turned.clone();
    reversed.faces[5].swap(0, 1);
    assert_eq!(of(&reversed).n_facets, 6);
}

#[test]
fn round_shapes_are_flat_nowhere_however_dense() {
    for density in 2..=6 {
        let shape = shapes::icosphere(density);
        let ball = Flatness::of(shape.mesh().unwrap().connectivity(), &shape.vertices).unwrap();
        assert_eq!((ball.flat_share, ball.plane_share), (0.0, 0.0), "{density}");
    }
}

#[test]
fn planes_are_flat_however_dense_and_rounded() {
    for density in [4, 40, 200] {
        // Triangles a hundred times as long as high, too.
        for stretch in [1.0, 0.01] {
            let rounded = |shape: Shape| shape.map(|point| point.map(|x| f64::from(x as f32)));
            let cube = rounded(shapes::cube(density).rotated(AXIS, 0.8));
            let sheet = shapes::grid(density, density).map(|[x, y, z]| [x, stretch * y, z]);
            let sheet = rounded(sheet.rotated(AXIS, 0.8));
            let of =
                |shape: &Shape| Flatness::of(shape.mesh().unwrap().connectivity(), &shape.vertices).unwrap();
            let (cube, sheet) = (of(&cube), of(&sheet));
            assert_eq!((cube.n_facets, sheet.n_facets), (6, 1), "{density} {stretch}");
            assert!(sheet.flat_share > 0.999 && cube.plane_share > 0.999);
        }
    }
}

#[test]
fn a_dense_ball_becomes_facets() {
    let ball = flow(&shapes::icosphere(5), &StylizeOptions { flat_share: Some(0.5), ..options(0.012) });
    assert!(ball.flatness[1].n_facets > 12 && ball.flatness[1].n_facets < 300, "{:?}", ball.flatness);
    assert!(ball.flatness[1].flat_share > 0.3, "{:?}", ball.flatness);
}
