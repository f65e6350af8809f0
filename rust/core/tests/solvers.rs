//! Both solvers on every class of problem: each within its own certificate, and within the other's.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::block_rows::BlockRows;
use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::shapes::{self, Random};
use ridgeform_core::solve::{solve, Coupling, Problem, Settings, Solution, Solver, Status};
use ridgeform_core::{Error, Progress};

fn operator(mesh: &Mesh) -> BlockRows {
    let c = mesh.connectivity();
    HessianPattern::new(c).unwrap().assemble(c, mesh.edge_lengths(), Dual::Barycentric).unwrap()
}

fn scaled_mass(mesh: &Mesh, alpha: f64) -> Vec<f64> {
    voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap().iter().map(|m| alpha * m).collect()
}

/// A ridge on the positions, with noise.
fn noisy_ridge(mesh: &Mesh, noise: f64, seed: u64) -> Columns {
    let mut random = Random::new(seed);
    let values = mesh
        .positions()
        .unwrap()
        .iter()
        .map(|p| (p[0] - 0.1).abs() + 0.3 * p[1] + noise * random.symmetric());
    Columns::from_column(values.collect())
}

fn problem<'a>(mesh: &Mesh, operator: &'a BlockRows, alpha: f64, target: Columns) -> Problem<'a> {
    let n = operator.n_columns;
    Problem {
        operator,
        weights: vec![1.0; operator.n_blocks()],
        fidelity: scaled_mass(mesh, alpha),
        target,
        fixed: vec![false; n],
        linear_constraints: None,
        coupling: Coupling::Joint,
    }
}

fn run(problem: &Problem<'_>, solver: Solver, tolerance: f64) -> Solution {
    let settings = Settings { tolerance: Some(tolerance), ..Settings::default() };
    solve(problem, solver, &settings, &Progress::new()).unwrap()
}

/// Solves with both and checks that the certificates contain each other's objective.
fn assert_agreement(problem: &Problem<'_>) -> Solution {
    let fast = run(problem, Solver::Fast, 1e-4);
    assert_eq!(fast.status, Status::Solved, "gap {:e} after {} iterations", fast.gap, fast.iterations);
    for solver in [Solver::ClarabelQdldl, Solver::ClarabelFaer] {
        let exact = run(problem, solver, 1e-7);
        assert!(exact.gap < 1e-5, "{solver:?}: gap {:e}", exact.gap);
        let slack = 1e-9 * exact.objective.abs().max(1.0);
        assert!(fast.objective >= exact.dual_objective - slack);
        assert!(exact.objective >= fast.dual_objective - slack);
        assert!(fast.objective - exact.objective <= 1.1e-4 * fast.objective + slack);
    }
    fast
}

#[test]
fn light_and_heavy_denoising() {
    let mesh = shapes::icosphere(3).noisy(0.01, 1).mesh().unwrap();
    let h = operator(&mesh);
    for (noise, alpha) in [(0.0, 1e3), (0.05, 1e3), (0.5, 1e2), (0.5, 1e4)] {
        assert_agreement(&problem(&mesh, &h, alpha, noisy_ridge(&mesh, noise, 7)));
    }
}

#[test]
fn open_mesh() {
    let mesh = shapes::grid(14, 11).noisy(0.2, 3).mesh().unwrap();
    let h = operator(&mesh);
    assert_agreement(&problem(&mesh, &h, 0.05, noisy_ridge(&mesh, 1.0, 5)));
}

#[test]
fn interpolation_between_fixed_values() {
    let mesh = shapes::torus(24, 12, 1.0, 0.4).noisy(0.01, 2).mesh().unwrap();
    let h = operator(&mesh);
    let mut p = problem(&mesh, &h, 1.0, noisy_ridge(&mesh, 0.0, 1));
    p.fidelity.fill(0.0);
    p.fixed = (0..h.n_columns).map(|i| i % 17 == 3).collect();
    let solution = assert_agreement(&p);
    for i in (0..h.n_columns).filter(|i| i % 17 == 3) {
        assert_eq!(solution.values.column(0)[i], p.target.column(0)[i]);
    }
}

#[test]
fn weighted_faces_down_to_nothing() {
    let mesh = shapes::icosphere(3).noisy(0.01, 4).mesh().unwrap();
    let h = operator(&mesh);
    let mut p = problem(&mesh, &h, 300.0, noisy_ridge(&mesh, 0.1, 9));
    let mut random = Random::new(11);
    p.weights = (0..h.n_blocks()).map(|_| 10f64.powf(-6.0 * random.uniform())).collect();
    p.weights[5] = 0.0;
    assert_agreement(&p);
}

#[test]
fn linear_constraints_hold() {
    let mesh = shapes::cube(6).noisy(0.02, 4).mesh().unwrap();
    let h = operator(&mesh);
    let n = h.n_columns;
    let mass = scaled_mass(&mesh, 1.0);
    let mut dense = sprs::TriMat::new((2, n));
    for (i, m) in mass.iter().enumerate() {
        dense.add_triplet(0, i, *m);
    }
    dense.add_triplet(1, 3, 1.0);
    dense.add_triplet(1, 40, -1.0);
    let (matrix, right) = (dense.to_csr(), Columns::from_column(vec![2.0, 0.25]));
    for interpolation in [false, true] {
        let mut p = problem(&mesh, &h, 50.0, noisy_ridge(&mesh, 0.1, 9));
        if interpolation {
            p.fidelity.fill(0.0);
            p.fixed = (0..n).map(|i| i % 29 == 0).collect();
        }
        p.linear_constraints = Some((matrix.clone(), right.clone()));
        let solution = assert_agreement(&p);
        let u = solution.values.column(0);
        let mean: f64 = mass.iter().zip(u).map(|(m, x)| m * x).sum();
        assert!((mean - 2.0).abs() < 1e-9 && (u[3] - u[40] - 0.25).abs() < 1e-9);
    }
}

#[test]
fn contradicting_constraints_are_refused() {
    let mesh = shapes::cube(2).mesh().unwrap();
    let h = operator(&mesh);
    let mut p = problem(&mesh, &h, 1.0, noisy_ridge(&mesh, 0.1, 9));
    let mut twice = sprs::TriMat::new((2, h.n_columns));
    twice.add_triplet(0, 0, 1.0);
    twice.add_triplet(1, 0, 1.0);
    p.linear_constraints = Some((twice.to_csr(), Columns::from_column(vec![1.0, 2.0])));
    let error = solve(&p, Solver::Fast, &Settings::default(), &Progress::new()).unwrap_err();
    assert!(error.to_string().contains("depend on each other"), "{error}");
}

#[test]
fn joint_and_separate_columns() {
    let mesh = shapes::cube(5).noisy(0.05, 8).mesh().unwrap();
    let h = operator(&mesh);
    let points = Columns::from_points(mesh.positions().unwrap()).unwrap();
    let mut p = problem(&mesh, &h, 20.0, points.clone());
    let joint = assert_agreement(&p);
    p.coupling = Coupling::Separate;
    let separate = assert_agreement(&p);
    assert!(separate.objective > joint.objective);
    let single: f64 = (0..3)
        .map(|c| {
            run(
                &problem(&mesh, &h, 20.0, Columns::from_column(points.column(c).to_vec())),
                Solver::Fast,
                1e-4,
            )
            .objective
        })
        .sum();
    assert!((single - separate.objective).abs() < 2e-4 * single);
    // Five columns ride in a norm of eight: zero columns change nothing.
    let mut five = Columns::zeros(h.n_columns, 5);
    for c in 0..3 {
        five.column_mut(c).copy_from_slice(points.column(c));
    }
    let padded = run(&problem(&mesh, &h, 20.0, five), Solver::Fast, 1e-4);
    assert!((padded.objective - joint.objective).abs() < 2e-4 * joint.objective);
}

#[test]
fn high_accuracy_is_reachable() {
    let mesh = shapes::icosphere(2).noisy(0.02, 6).mesh().unwrap();
    let h = operator(&mesh);
    let p = problem(&mesh, &h, 100.0, noisy_ridge(&mesh, 0.05, 3));
    let solution = run(&p, Solver::Fast, 1e-8);
    assert_eq!(solution.status, Status::Solved, "gap {:e}", solution.gap);
    let exact = run(&p, Solver::ClarabelQdldl, 1e-9);
    assert!((solution.objective - exact.objective).abs() <= 1e-8 * exact.objective.abs() + 1e-9);
}

#[test]
fn running_out_of_iterations_is_told() {
    let mesh = shapes::icosphere(3).noisy(0.02, 6).mesh().unwrap();
    let h = operator(&mesh);
    let p = problem(&mesh, &h, 100.0, noisy_ridge(&mesh, 0.2, 3));
    let settings = Settings { tolerance: Some(1e-9), max_iterations: Some(7), ..Settings::default() };
    let solution = solve(&p, Solver::Fast, &settings, &Progress::new()).unwrap();
    assert_eq!((solution.status, solution.iterations), (Status::Inaccurate, 7));
    let exact = run(&p, Solver::ClarabelQdldl, 1e-9);
    assert!(solution.gap > 1e-9 && solution.dual_objective <= exact.objective + 1e-9);
}

#[test]
fn affine_data_has_no_energy_and_no_gap() {
    let mesh = shapes::grid(8, 8).mesh().unwrap();
    let h = operator(&mesh);
    let affine = mesh.positions().unwrap().iter().map(|p| 2.0 * p[0] - p[1] + 4.0).collect();
    let solution = run(&problem(&mesh, &h, 1.0, Columns::from_column(affine)), Solver::Fast, 1e-3);
    assert!(solution.objective.abs() < 1e-9);
    assert_eq!(solution.status, Status::Solved);
}

#[test]
fn everything_fixed() {
    let mesh = shapes::tetrahedron().mesh().unwrap();
    let h = operator(&mesh);
    let mut p = problem(&mesh, &h, 1.0, noisy_ridge(&mesh, 0.1, 1));
    p.fixed.fill(true);
    let solution = run(&p, Solver::Fast, 1e-3);
    assert_eq!(solution.values, p.target);
    assert_eq!(solution.gap, 0.0);
}

#[test]
fn cancelling_and_finishing() {
    let mesh = shapes::icosphere(3).noisy(0.02, 6).mesh().unwrap();
    let h = operator(&mesh);
    let p = problem(&mesh, &h, 100.0, noisy_ridge(&mesh, 0.2, 3));
    for solver in [Solver::Fast, Solver::ClarabelQdldl] {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(solve(&p, solver, &Settings::default(), &progress).unwrap_err(), Error::Cancelled);
    }
    let progress = Progress::new();
    progress.finish();
    let solution =
        solve(&p, Solver::Fast, &Settings { tolerance: Some(1e-9), ..Settings::default() }, &progress)
            .unwrap();
    assert_eq!((solution.status, solution.iterations), (Status::Stopped, 1));
    assert!(solution.objective.is_finite());
}

#[test]
fn same_bits_for_any_number_of_threads() {
    let mesh = shapes::icosphere(5).noisy(0.01, 6).mesh().unwrap();
    let h = operator(&mesh);
    let p = problem(&mesh, &h, 1000.0, noisy_ridge(&mesh, 0.1, 3));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&p, Solver::Fast, 1e-3))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(1));
}

#[test]
fn arguments_are_checked() {
    let mesh = shapes::cube(2).mesh().unwrap();
    let h = operator(&mesh);
    let good = problem(&mesh, &h, 1.0, noisy_ridge(&mesh, 0.1, 1));
    let refused = |p: Problem<'_>, word: &str| {
        let error = solve(&p, Solver::Fast, &Settings::default(), &Progress::new()).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    };
    refused(Problem { weights: vec![1.0; 3], ..good.clone() }, "face_weights");
    refused(Problem { fidelity: vec![-1.0; h.n_columns], ..good.clone() }, "at least 0");
    refused(Problem { fixed: vec![], ..good.clone() }, "fixed");
    let mut nan = good.clone();
    nan.target.data[4] = f64::NAN;
    refused(nan, "row 4 column 0 is not finite");
    refused(Problem { target: Columns::zeros(h.n_columns, 17), ..good }, "separate coupling");
}
