//! The flow: invariance, robustness, who moves and who does not, and how it ends.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{hessian_norm, Dual};
use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::solve::{Coupling, Solver};
use ridgeform_core::tools::{stylize, FlowStatus, Scale, SolveOptions, StylizeOptions, Stylized};
use ridgeform_core::{Error, Progress};

const AXIS: [f64; 3] = [0.3, -1.0, 0.7];

fn flow(shape: &Shape, options: &StylizeOptions) -> Stylized {
    stylize(&shape.mesh().unwrap(), options, &Progress::new()).unwrap()
}

fn strong(iterations: usize) -> StylizeOptions {
    StylizeOptions { iterations, fidelity: 1e5, scale: Scale::Area, ..StylizeOptions::default() }
}

fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).flat_map(|(p, q)| p.iter().zip(q)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn bumpy() -> Shape {
    shapes::icosphere(3).noisy(0.03, 1)
}

#[test]
fn rotating_and_stylizing_commute() {
    let shape = bumpy();
    for scale in [Scale::MaxEdge, Scale::Area] {
        let options = StylizeOptions { iterations: 10, fidelity: 2e4, scale, ..StylizeOptions::default() };
        let first = Shape { vertices: flow(&shape, &options).vertices, faces: shape.faces.clone() }
            .rotated(AXIS, 1.1);
        let then = flow(&shape.clone().rotated(AXIS, 1.1), &options);
        assert!(farthest(&first.vertices, &then.vertices) < 1e-9);
    }
}

#[test]
fn separate_coordinates_depend_on_the_frame() {
    let shape = bumpy();
    let options = StylizeOptions { coupling: Coupling::Separate, ..strong(5) };
    let first =
        Shape { vertices: flow(&shape, &options).vertices, faces: shape.faces.clone() }.rotated(AXIS, 1.1);
    let then = flow(&shape.clone().rotated(AXIS, 1.1), &options);
    assert!(farthest(&first.vertices, &then.vertices) > 1e-4);
}

#[test]
fn scaling_and_stylizing_commute() {
    let shape = bumpy();
    for scale in [Scale::MaxEdge, Scale::BoundingBox, Scale::Area] {
        let options = StylizeOptions { iterations: 3, fidelity: 2e4, scale, ..StylizeOptions::default() };
        let small = flow(&shape, &options).vertices;
        let large = flow(&shape.clone().map(|p| p.map(|x| 1000.0 * x)), &options).vertices;
        let back: Vec<[f64; 3]> = large.iter().map(|p| p.map(|x| x / 1000.0)).collect();
        assert!(farthest(&small, &back) < 1e-7);
    }
}

#[test]
fn the_energy_falls_and_everything_is_reported() {
    let result = flow(&bumpy(), &strong(8));
    assert_eq!(result.status, FlowStatus::Finished);
    assert_eq!((result.energy.len(), result.gap.len(), result.solver_iterations.len()), (9, 8, 8));
    assert!(result.energy[8] < 0.7 * result.energy[0]);
    assert!(result.gap.iter().all(|g| (-1e-12..0.2).contains(g)), "{:?}", result.gap);
}

#[test]
fn both_solvers_take_the_same_steps() {
    let shape = shapes::cube(5).noisy(0.03, 3);
    let with = |solver| {
        let solve = SolveOptions { solver, tolerance: Some(1e-7), ..SolveOptions::default() };
        flow(&shape, &StylizeOptions { iterations: 3, solve, ..StylizeOptions::default() })
    };
    let (fast, conic) = (with(Solver::Fast), with(Solver::Clarabel));
    assert!(farthest(&fast.vertices, &conic.vertices) < 1e-3);
    assert!((fast.energy[3] - conic.energy[3]).abs() < 1e-3 * conic.energy[3]);
}

#[test]
fn nobody_else_moves() {
    let shape = bumpy();
    let n = shape.vertices.len();
    let fixed: Vec<bool> = (0..n).map(|i| i % 3 == 0).collect();
    let strength: Vec<f64> = (0..n).map(|i| if i % 3 == 1 { 0.0 } else { 1.0 }).collect();
    let options = StylizeOptions { fixed: Some(fixed), strength: Some(strength), ..strong(4) };
    let moved = flow(&shape, &options).vertices;
    for (i, (after, before)) in moved.iter().zip(&shape.vertices).enumerate() {
        assert_eq!(after == before, i % 3 != 2, "vertex {i}");
    }
    let none = StylizeOptions { fixed: Some(vec![true; n]), ..strong(4) };
    let result = flow(&shape, &none);
    assert_eq!((result.vertices, result.status), (shape.vertices, FlowStatus::Converged));
}

#[test]
fn weak_vertices_move_less() {
    let shape = bumpy();
    let distance = |s: f64| {
        let strength = Some(vec![s; shape.vertices.len()]);
        farthest(&flow(&shape, &StylizeOptions { strength, ..strong(1) }).vertices, &shape.vertices)
    };
    assert!(distance(0.05) < 0.5 * distance(1.0));
}

#[test]
fn ridges_form_where_they_are_cheap() {
    // A bent sheet, and a strip beside its middle where ridges cost a fifth.
    let shape = shapes::grid(20, 6).map(|[x, y, _]| [x, y, 0.02 * (x - 10.0) * (x - 10.0)]);
    let in_strip = |f: &[u32; 3]| {
        let x: f64 = f.iter().map(|&v| shape.vertices[v as usize][0]).sum::<f64>() / 3.0;
        (12.0..14.0).contains(&x)
    };
    let share = |ridge_weights: Option<Vec<f64>>| {
        let vertices = flow(&shape, &StylizeOptions { ridge_weights, ..strong(10) }).vertices;
        let mesh = Mesh::new(vertices.clone(), shape.faces.clone()).unwrap();
        let norms =
            hessian_norm(&mesh, &Columns::from_points(&vertices).unwrap().data, Dual::Barycentric).unwrap();
        let strip: f64 = shape.faces.iter().zip(&norms).filter(|(f, _)| in_strip(f)).map(|(_, x)| x).sum();
        strip / norms.iter().sum::<f64>()
    };
    let weights = shape.faces.iter().map(|f| if in_strip(f) { 0.2 } else { 1.0 }).collect();
    let (with, without) = (share(Some(weights)), share(None));
    assert!(with > 2.0 * without, "{with} {without}");
}

#[test]
fn a_flat_sheet_has_nothing_to_do() {
    let result = flow(&shapes::grid(9, 7).rotated(AXIS, 0.4), &strong(20));
    assert_eq!(result.status, FlowStatus::Converged);
    assert_eq!(result.energy.len(), 2);
}

#[test]
fn a_collapse_is_told_and_undone() {
    let shape = bumpy();
    let result = flow(&shape, &StylizeOptions { fidelity: 1e-9, ..strong(5) });
    assert_eq!((result.status, result.vertices), (FlowStatus::Collapsed, shape.vertices));
}

#[test]
fn two_hundred_steps_at_any_strength_stay_finite() {
    let mut slivers = shapes::cylinder(24, 6, 1.0, 0.02);
    slivers = slivers.and(&shapes::torus(20, 9, 1.0, 0.3)).noisy(1e-3, 5);
    let mut broken = shapes::cube(4).noisy(0.05, 2);
    broken.faces.push(broken.faces[3]);
    broken.faces.push([0, 1, 1]);
    broken.faces.push([0, 7, 30]);
    broken.vertices.push([9.0; 3]);
    for shape in [slivers, broken, shapes::tetrahedron(), shapes::grid(6, 6).noisy(0.3, 8)] {
        for (fidelity, delaunay) in [(3e4, false), (3e2, true), (1e-3, false), (1e-12, true)] {
            for sharpness in [0.0, 1.0] {
                let options = StylizeOptions { fidelity, delaunay, sharpness, ..strong(200) };
                let result = flow(&shape, &options);
                assert!(result.vertices.iter().flatten().all(|x| x.is_finite()));
                assert!(result.energy.iter().chain(&result.gap).all(|x| x.is_finite()));
            }
        }
    }
}

#[test]
fn delaunay_flips_change_the_operator_not_the_mesh() {
    let shape = shapes::cylinder(20, 4, 1.0, 4.0).noisy(0.02, 4);
    let plain = flow(&shape, &strong(4));
    let flipped = flow(&shape, &StylizeOptions { delaunay: true, ..strong(4) });
    assert_eq!(plain.vertices.len(), flipped.vertices.len());
    assert!(farthest(&plain.vertices, &flipped.vertices) > 1e-6);
    assert!(flipped.energy[4] < flipped.energy[0]);
}

#[test]
fn progress_cancels_finishes_and_shows_every_step() {
    let mesh = bumpy().mesh().unwrap();
    let progress = Progress::new();
    let result = stylize(&mesh, &strong(3), &progress).unwrap();
    assert_eq!(progress.snapshot().as_deref(), Some(&result.vertices));
    let report = progress.last_report();
    assert_eq!((report.iteration, report.fraction, report.energy), (3, 1.0, result.energy.last().copied()));
    progress.finish();
    let stopped = stylize(&mesh, &strong(3), &progress).unwrap();
    assert_eq!((stopped.status, stopped.gap.len()), (FlowStatus::Stopped, 0));
    progress.cancel();
    assert_eq!(stylize(&mesh, &strong(3), &progress).unwrap_err(), Error::Cancelled);
}

/// Places are counted in questions whether to stop, so that the test is the same on any machine.
#[test]
fn stopped_anywhere_a_flow_on_levels_leaves_its_last_step() {
    /// Places where it is stopped, and questions until it has ended.
    const PLACES: u64 = 9;
    const BESIDE: u64 = 64;
    let shape = shapes::torus(160, 120, 3.0, 1.0).noisy(0.01, 1);
    let mesh = shape.mesh().unwrap();
    let solve = SolveOptions { threads: Some(1), ..SolveOptions::default() };
    let options = StylizeOptions { movement: Some(0.02), solve, ..strong(3) };
    let progress = Progress::new();
    let whole = stylize(&mesh, &options, &progress).unwrap();
    assert!(whole.level_vertices[0] < shape.vertices.len(), "{:?}", whole.level_vertices);
    let total = progress.n_asked();
    let mut done = Vec::new();
    for place in 0..PLACES {
        let (progress, at) = (Progress::new(), 1 + place * (total - 1) / PLACES);
        progress.stop_when_asked(at, true);
        let result = stylize(&mesh, &options, &progress).unwrap();
        assert_eq!(result.status, FlowStatus::Stopped);
        assert!(progress.n_asked() <= at + BESIDE, "{} after {at} of {total}", progress.n_asked());
        let n_steps = result.gap.len();
        assert_eq!(result.gap, whole.gap[..n_steps]);
        assert_eq!(result.energy, whole.energy[..=n_steps]);
        let shown = progress.snapshot();
        assert!(shown.is_some() || n_steps == 0);
        let last = shown.as_deref().unwrap_or(&shape.vertices);
        assert!(farthest(&result.vertices, last) < 1e-9, "{}", farthest(&result.vertices, last));
        done.push(n_steps);

        let progress = Progress::new();
        progress.stop_when_asked(at, false);
        assert_eq!(stylize(&mesh, &options, &progress).unwrap_err(), Error::Cancelled);
        assert!(progress.n_asked() <= at + BESIDE, "{} after {at} of {total}", progress.n_asked());
    }
    assert!(done.is_sorted() && done[0] == 0 && done[PLACES as usize - 1] >= 2, "{done:?}");
}

#[test]
fn same_bits_for_any_number_of_threads() {
    let shape = shapes::icosphere(4).noisy(0.02, 1);
    let on = |threads| {
        let solve = SolveOptions { threads: Some(threads), tolerance: None, ..SolveOptions::default() };
        flow(&shape, &StylizeOptions { solve, ..strong(3) })
    };
    let [one, two, again] = [1, 2, 1].map(on);
    assert!(one == two && one == again);
}

#[test]
fn bad_arguments_are_named() {
    let mesh = shapes::cube(2).mesh().unwrap();
    let n = mesh.connectivity().n_vertices();
    let refused = |options: StylizeOptions, word: &str| {
        let error = stylize(&mesh, &options, &Progress::new()).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    };
    let base = StylizeOptions::default;
    refused(StylizeOptions { fidelity: 0.0, ..base() }, "fidelity");
    refused(StylizeOptions { sharpness: 1.5, ..base() }, "sharpness");
    refused(StylizeOptions { strength: Some(vec![2.0; n]), ..base() }, "strength");
    refused(StylizeOptions { fixed: Some(vec![true]), ..base() }, "fixed");
    refused(
        StylizeOptions { ridge_weights: Some(vec![f64::NAN; mesh.connectivity().n_faces()]), ..base() },
        "ridge_weights",
    );
    let lengths = Mesh::from_edge_lengths(vec![[0, 1, 2]], vec![[1.0; 3]], None).unwrap();
    assert!(stylize(&lengths, &base(), &Progress::new()).unwrap_err().to_string().contains("positions"));
    let empty = Mesh::new(vec![[0.0; 3]; 2], vec![]).unwrap();
    assert!(stylize(&empty, &base(), &Progress::new()).unwrap_err().to_string().contains("no face"));
}
