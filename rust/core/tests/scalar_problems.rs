//! Denoising and interpolation with every energy: against dense systems, between the solvers,
//! and what must be refused.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::intrinsic::{delaunay_flips, delaunay_flips_carrying};
use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::{triangle, Mesh};
use ridgeform_core::operators::{voronoi_mass, Dual, Energy, EnergyForm};
use ridgeform_core::shapes::{self, Random};
use ridgeform_core::solve::{Coupling, Solution, Solver, Status};
use ridgeform_core::tools::{
    denoise, interpolate, DenoiseOptions, EnergyOptions, ScalarOptions, SolveOptions,
};
use ridgeform_core::{Error, Progress, Result};

fn options(energy: Energy, solver: Solver, tolerance: f64) -> ScalarOptions {
    let solve = SolveOptions { solver, tolerance: Some(tolerance), ..SolveOptions::default() };
    ScalarOptions {
        energy: EnergyOptions { kind: energy, ..EnergyOptions::default() },
        solve,
        ..ScalarOptions::default()
    }
}

fn ridge(mesh: &Mesh, noise: f64) -> Columns {
    let mut random = Random::new(17);
    let value = |p: &[f64; 3]| (p[0] - 0.2).abs() + 0.5 * p[1] + noise * random.symmetric();
    Columns::from_column(mesh.positions().unwrap().iter().map(value).collect())
}

fn denoised(mesh: &Mesh, fidelity: f64, scalar: ScalarOptions) -> Solution {
    denoise(
        mesh,
        &ridge(mesh, 0.1),
        &DenoiseOptions { fidelity, scalar, ..DenoiseOptions::default() },
        &Progress::new(),
    )
    .unwrap()
}

fn known(mesh: &Mesh, step: usize) -> (Vec<usize>, Columns) {
    let all = ridge(mesh, 0.0);
    let indices: Vec<usize> = (0..all.n_rows).step_by(step).collect();
    let values = indices.iter().map(|&i| all.data[i]).collect();
    (indices, Columns::from_column(values))
}

fn interpolated(mesh: &Mesh, step: usize, scalar: &ScalarOptions) -> Result<Solution> {
    let (indices, values) = known(mesh, step);
    interpolate(mesh, &indices, &values, scalar, &Progress::new())
}

/// The dense matrix of a quadratic energy `½ uᵀ Q u`.
fn dense(form: &EnergyForm) -> Vec<Vec<f64>> {
    let n = form.operator.n_columns;
    let mut q = vec![vec![0.0; n]; n];
    for (b, weight) in form.weights.iter().enumerate() {
        let (columns, values) = form.operator.block(b);
        for (&i, x) in columns.iter().zip(values) {
            for (&j, y) in columns.iter().zip(values) {
                q[i as usize][j as usize] += weight * x.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }
    q
}

/// Solves a dense system by elimination with pivoting.
fn eliminate(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let (upper, lower) = a.split_at_mut(i);
            lower[0][k..].iter_mut().zip(&upper[k][k..]).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - rest) / a[k][k];
    }
    b
}

fn quadratic() -> impl Iterator<Item = (&'static str, Energy)> {
    Energy::ALL.into_iter().filter(|(_, energy)| energy.is_quadratic())
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = expected.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let error = found.iter().zip(expected).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
    assert!(error < tolerance * size, "{what}: {:e}", error / size);
}

#[test]
fn quadratic_denoising_solves_the_normal_equations() {
    let mesh = shapes::torus(14, 8, 1.0, 0.4).noisy(0.02, 1).mesh().unwrap();
    let (fidelity, data) = (30.0, ridge(&mesh, 0.1));
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    for (name, energy) in quadratic() {
        let mut q = dense(&EnergyForm::new(energy, &mesh, None, Dual::Barycentric).unwrap());
        let right = mass.iter().zip(&data.data).map(|(m, x)| 2.0 * fidelity * m * x).collect();
        mass.iter().enumerate().for_each(|(i, m)| q[i][i] += 2.0 * fidelity * m);
        let expected = eliminate(q, right);
        let solution = denoised(&mesh, fidelity, options(energy, Solver::Auto, 1e-10));
        assert_close(solution.values.column(0), &expected, 1e-9, name);
        assert_eq!((solution.status, solution.solver), (Status::Solved, Solver::Cholesky), "{name}");
        assert!(solution.gap < 1e-12 && solution.factorisations == 1, "{name}: {:e}", solution.gap);
    }
}

#[test]
fn quadratic_interpolation_solves_the_free_rows() {
    let mesh = shapes::cylinder(14, 9, 1.0, 2.0).noisy(0.02, 3).mesh().unwrap();
    let (indices, values) = known(&mesh, 11);
    for (name, energy) in quadratic() {
        let mut q = dense(&EnergyForm::new(energy, &mesh, None, Dual::Barycentric).unwrap());
        let mut right = vec![0.0; q.len()];
        for (&i, x) in indices.iter().zip(&values.data) {
            q[i].fill(0.0);
            q[i][i] = 1.0;
            right[i] = *x;
        }
        let solution = interpolated(&mesh, 11, &options(energy, Solver::Auto, 1e-8)).unwrap();
        // The mean of the known values is what the values start from; the optimum does not depend on it.
        assert_close(solution.values.column(0), &eliminate(q, right), 1e-7, name);
        assert_eq!(solution.status, Status::Solved, "{name}: {:e}", solution.gap);
    }
}

#[test]
fn quadratic_problems_keep_linear_constraints_and_need_no_fixed_value_then() {
    let mesh = shapes::icosphere(2).mesh().unwrap();
    let n = mesh.connectivity().n_vertices();
    let mut rows = sprs::TriMat::new((3, n));
    voronoi_mass(mesh.connectivity(), mesh.edge_lengths())
        .unwrap()
        .iter()
        .enumerate()
        .for_each(|(i, m)| rows.add_triplet(0, i, *m));
    rows.add_triplet(1, 4, 1.0);
    rows.add_triplet(1, 90, -1.0);
    rows.add_triplet(2, 33, 1.0);
    let constraints = (rows.to_csr(), Columns::from_column(vec![1.5, 0.7, -0.2]));
    for (name, energy) in quadratic() {
        let scalar = ScalarOptions {
            linear_constraints: Some(constraints.clone()),
            ..options(energy, Solver::Auto, 1e-8)
        };
        let fitted = denoised(&mesh, 10.0, scalar.clone());
        let free =
            interpolate(&mesh, &[7], &Columns::from_column(vec![1.0]), &scalar, &Progress::new()).unwrap();
        let form = EnergyForm::new(energy, &mesh, None, Dual::Barycentric).unwrap();
        for solution in [&fitted, &free] {
            let u = solution.values.column(0);
            let product: Vec<f64> =
                constraints.0.outer_iterator().map(|r| r.iter().map(|(j, v)| v * u[j]).sum()).collect();
            assert_close(&product, &constraints.1.data, 1e-9, name);
            assert_eq!(solution.status, Status::Solved, "{name}: {:e}", solution.gap);
        }
        // Optimal: any change within the constraints costs energy.
        let mut random = Random::new(5);
        let start = free.values.column(0).to_vec();
        let mut moved = start.clone();
        let others = (0..n).filter(|i| ![4, 7, 33, 90].contains(i));
        others.for_each(|i| moved[i] += 1e-3 * random.symmetric());
        let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
        let drift: f64 = mass.iter().zip(moved.iter().zip(&start)).map(|(m, (x, y))| m * (x - y)).sum();
        moved[50] -= drift / mass[50];
        assert!(form.evaluate(&moved).unwrap() > form.evaluate(&start).unwrap(), "{name}");
    }
}

#[test]
fn both_solvers_agree_on_the_l1_energies() {
    let closed = shapes::icosphere(2).noisy(0.02, 6).mesh().unwrap();
    let open = shapes::grid(11, 9).noisy(0.15, 4).mesh().unwrap();
    for (name, energy) in Energy::ALL.into_iter().filter(|(_, energy)| !energy.is_quadratic()) {
        for mesh in [&closed, &open] {
            let run = |solver, tolerance| {
                let scalar = options(energy, solver, tolerance);
                [denoised(mesh, 5.0, scalar.clone()), interpolated(mesh, 9, &scalar).unwrap()]
            };
            for (fast, exact) in run(Solver::Fast, 1e-3).iter().zip(&run(Solver::ClarabelQdldl, 1e-6)) {
                assert_eq!(fast.status, Status::Solved, "{name}: gap {:e}", fast.gap);
                let slack = 1e-9 * exact.objective.max(1e-3);
                assert!(fast.objective >= exact.dual_objective - slack, "{name}");
                assert!(exact.objective >= fast.dual_objective - slack, "{name}");
                assert!(fast.objective <= 1.0011 * exact.objective + slack, "{name}");
            }
        }
    }
}

#[test]
fn affine_data_on_the_plane_comes_back_from_a_few_points() {
    let mesh = shapes::grid(10, 7).mesh().unwrap();
    let affine: Vec<f64> = mesh.positions().unwrap().iter().map(|p| 2.0 * p[0] - p[1] + 1.0).collect();
    // No three of them on a line, so that they determine the function; the corners,
    // which some energies do not see, are free.
    let indices = [14, 30, 47, 69];
    let values = Columns::from_column(indices.iter().map(|&i| affine[i]).collect());
    for (name, energy) in Energy::ALL.into_iter().filter(|(_, energy)| *energy != Energy::L2Laplacian) {
        let solution =
            interpolate(&mesh, &indices, &values, &options(energy, Solver::Auto, 1e-3), &Progress::new())
                .unwrap();
        let tolerance = if energy.is_quadratic() { 1e-6 } else { 2e-2 };
        assert_close(solution.values.column(0), &affine, tolerance, name);
    }
}

#[test]
fn columns_and_weights_count() {
    let mesh = shapes::cube(4).noisy(0.03, 2).mesh().unwrap();
    let m = mesh.connectivity().n_faces();
    let points = Columns::from_points(mesh.positions().unwrap()).unwrap();
    for (name, energy) in Energy::ALL {
        let run = |values: &Columns, face_weights: Option<Vec<f64>>, fidelity: f64, coupling: Coupling| {
            let mut scalar = ScalarOptions { coupling, ..options(energy, Solver::Auto, 1e-4) };
            scalar.energy.face_weights = face_weights;
            denoise(
                &mesh,
                values,
                &DenoiseOptions { fidelity, scalar, ..DenoiseOptions::default() },
                &Progress::new(),
            )
            .unwrap()
        };
        let separate = run(&points, None, 8.0, Coupling::Separate);
        let single: f64 = (0..3)
            .map(|c| {
                run(&Columns::from_column(points.column(c).to_vec()), None, 8.0, Coupling::Joint).objective
            })
            .sum();
        assert!((separate.objective / single - 1.0).abs() < 3e-4, "{name}");
        // Weights of 2 with twice the fidelity are the same problem times 2.
        let twice = run(&points, Some(vec![2.0; m]), 16.0, Coupling::Separate);
        assert!((twice.objective / separate.objective - 2.0).abs() < 6e-4, "{name}");
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let mesh = shapes::cube(3).mesh().unwrap();
    let refusal = |scalar: &ScalarOptions| interpolated(&mesh, 5, scalar).unwrap_err().to_string();
    for (name, energy) in Energy::ALL.into_iter().filter(|(_, energy)| *energy != Energy::L1Hessian) {
        let mut plain = options(energy, Solver::Auto, 1e-3);
        let text = refusal(&ScalarOptions { sharpness: 0.5, ..plain.clone() });
        assert!(text.starts_with("sharpness") && text.contains(name), "{text}");
        plain.energy.dual = Dual::Circumcentric;
        let text = refusal(&plain);
        assert!(text.starts_with("dual") && text.contains(name), "{text}");
    }
    let text = refusal(&options(Energy::L2Laplacian, Solver::ClarabelQdldl, 1e-3));
    assert!(text.starts_with("solver"), "{text}");
    let square = shapes::grid(1, 1).mesh().unwrap();
    let error = interpolated(&square, 2, &options(Energy::L2Hessian, Solver::Auto, 1e-3)).unwrap_err();
    assert!(matches!(error, Error::Argument { name: "energy", .. }), "{error}");
    let progress = Progress::new();
    progress.cancel();
    let (indices, values) = known(&mesh, 5);
    let scalar = options(Energy::L2Laplacian, Solver::Auto, 1e-3);
    assert_eq!(interpolate(&mesh, &indices, &values, &scalar, &progress).unwrap_err(), Error::Cancelled);
}

#[test]
fn delaunay_flips_help_every_intrinsic_energy_and_keep_the_vertices() {
    // The same flat square as slivers and as good triangles: flips make the first as good as the second.
    let affine = |p: &[f64; 3]| 1.0 + 0.5 * p[0] - 0.25 * p[1];
    let mesh = shapes::grid(12, 12).map(|[x, y, z]| [0.12 * x + 0.9 * y, y, z]).mesh().unwrap();
    let (connectivity, lengths, flips) = delaunay_flips(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert!(flips > 50);
    let by_hand = Mesh::from_connectivity(connectivity, lengths).unwrap();
    let values = Columns::from_column(mesh.positions().unwrap().iter().map(affine).collect());
    let (indices, some) = ([0, 40, 100, 168], [0, 40, 100, 168].map(|i: usize| values.data[i]).to_vec());
    for (name, energy) in Energy::ALL {
        let mut scalar = options(energy, Solver::Auto, 1e-4);
        scalar.energy.delaunay = true;
        scalar.energy.face_weights = Some(vec![1.5; mesh.connectivity().n_faces()]);
        let run = |mesh: &Mesh, scalar: &ScalarOptions| {
            interpolate(mesh, &indices, &Columns::from_column(some.clone()), scalar, &Progress::new())
        };
        let found = run(&mesh, &scalar);
        if energy.is_extrinsic() {
            assert!(found.unwrap_err().to_string().starts_with("delaunay"), "{name}");
            continue;
        }
        scalar.energy.delaunay = false;
        assert_eq!(found.unwrap(), run(&by_hand, &scalar).unwrap(), "{name}");
    }
}

#[test]
fn face_weights_follow_the_flips() {
    let mesh = shapes::grid(9, 9).map(|[x, y, z]| [0.2 * x + 0.8 * y, y, z]).mesh().unwrap();
    let mut weights: Vec<f64> = (0..162).map(|f| 1.0 + f64::from(f % 7)).collect();
    let integral = |lengths: &[[f64; 3]], weights: &[f64]| -> f64 {
        lengths.iter().zip(weights).map(|(&l, w)| triangle::area(l) * w).sum()
    };
    let before = integral(mesh.edge_lengths(), &weights);
    let (_, lengths, flips) =
        delaunay_flips_carrying(mesh.connectivity(), mesh.edge_lengths(), &mut weights).unwrap();
    assert!(flips > 0 && (integral(&lengths, &weights) / before - 1.0).abs() < 1e-12);
    assert!(weights.iter().all(|w| (1.0..=7.0).contains(w)));
}

#[test]
fn the_curved_energy_of_an_open_saddle_is_not_convex_and_says_so() {
    let saddle = |p: [f64; 3]| [p[0] - 6.0, p[1] - 6.0, 0.2 * ((p[0] - 6.0).powi(2) - (p[1] - 6.0).powi(2))];
    let mesh = shapes::grid(12, 12).map(saddle).mesh().unwrap();
    let scalar = options(Energy::L2CurvedHessian, Solver::Auto, 1e-6);
    for indices in [vec![84], vec![3, 60, 150]] {
        let values = Columns::from_column((0..indices.len()).map(|i| i as f64).collect());
        let error = interpolate(&mesh, &indices, &values, &scalar, &Progress::new()).unwrap_err();
        assert!(error.to_string().contains("not convex"), "{error}");
    }
    // Enough values, or data to stay close to, make it convex.
    assert_eq!(interpolated(&mesh, 5, &scalar).unwrap().status, Status::Solved);
    assert_eq!(denoised(&mesh, 1.0, scalar).status, Status::Solved);
}
