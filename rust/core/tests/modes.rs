//! Vibration modes: known spectra of the sphere and the square, the constraints of (38), determinism.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::mesh::{triangle, Mesh};
use ridgeform_core::operators::{voronoi_mass, Dual, Energy, EnergyForm, HessianPattern};
use ridgeform_core::shapes;
use ridgeform_core::solve::eigen::Pencil;
use ridgeform_core::solve::{Solver, Status};
use ridgeform_core::tools::{vibration_modes, EnergyOptions, ModeOptions, Modes, SolveOptions};
use ridgeform_core::{Error, Progress};

fn options(kind: Energy) -> ModeOptions {
    ModeOptions { energy: EnergyOptions { kind, ..EnergyOptions::default() }, ..ModeOptions::default() }
}

fn modes(mesh: &Mesh, count: usize, kind: Energy) -> Modes {
    vibration_modes(mesh, count, &options(kind), &Progress::new()).unwrap()
}

fn inner(mass: &[f64], x: &[f64], y: &[f64]) -> f64 {
    mass.iter().zip(x.iter().zip(y)).map(|(m, (x, y))| m * x * y).sum()
}

fn assert_orthonormal_and_ascending(mesh: &Mesh, found: &Modes, count: usize) {
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert_eq!((found.values.n_columns, found.energies.len()), (count, count));
    for a in 0..count {
        for b in 0..=a {
            let product = inner(&mass, found.values.column(a), found.values.column(b));
            assert!((product - f64::from(u8::from(a == b))).abs() < 1e-10, "{a} {b}: {product}");
        }
        let largest =
            found.values.column(a).iter().fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        assert!(largest > 0.0 || found.values.column(a).iter().any(|x| (x + largest).abs() < 1e-5 * x.abs()));
    }
    assert!(found.energies.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn quadratic_modes_of_the_sphere_are_spherical_harmonics() {
    // ½ ∫ |Δu|² of a harmonic of degree l is ½ (l (l + 1))²: 0, three times 2, five times 18, seven times 72.
    let mesh = shapes::icosphere(4).mesh().unwrap();
    for energy in [Energy::L2Laplacian, Energy::L2CurvedHessian] {
        let found = modes(&mesh, 16, energy);
        assert_orthonormal_and_ascending(&mesh, &found, 16);
        let exact = [0.0].into_iter().chain([2.0; 3]).chain([18.0; 5]).chain([72.0; 7]);
        for (value, exact) in found.energies.iter().zip(exact) {
            assert!((value - exact).abs() < 0.03 * exact + 1e-9, "{energy:?}: {value} instead of {exact}");
        }
        // The first is constant, the next three are linear in the coordinates.
        let first = found.values.column(0);
        assert!(first.iter().all(|x| (x - first[0]).abs() < 1e-7));
        let form = EnergyForm::new(energy, &mesh, None, Dual::Barycentric).unwrap();
        for (c, energy) in found.energies.iter().enumerate() {
            assert!((form.evaluate(found.values.column(c)).unwrap() - energy).abs() < 1e-6 * (1.0 + energy));
        }
    }
}

#[test]
fn quadratic_modes_of_the_square() {
    // With zero Neumann conditions ½ (π² (i² + j²))² on the unit square. With natural ones affine functions
    // are free, and then comes a twist, for which x y with its energy of ½ · 2 · 144 is a bound from above
    // and a tenth too large.
    let mesh = shapes::grid(30, 30).map(|p| p.map(|x| x / 30.0)).mesh().unwrap();
    let neumann = modes(&mesh, 6, Energy::L2Laplacian);
    let square = std::f64::consts::PI.powi(4);
    for (value, sum) in neumann.energies.iter().zip([0.0, 1.0, 1.0, 2.0, 4.0, 4.0]) {
        let exact = 0.5 * square * sum * sum;
        assert!((value - exact).abs() < 0.03 * exact + 1e-6, "{value} instead of {exact}");
    }
    for energy in [Energy::L2Hessian, Energy::L2CurvedHessian] {
        let found = modes(&mesh, 6, energy);
        assert_orthonormal_and_ascending(&mesh, &found, 6);
        assert!(
            found.energies[2] < 1e-6 && (110.0..145.0).contains(&found.energies[3]),
            "{:?}",
            found.energies
        );
    }
}

#[test]
fn l1_modes_obey_their_constraints_and_beat_the_quadratic_ones() {
    let sphere = shapes::icosphere(2).noisy(0.02, 3).mesh().unwrap();
    let square = shapes::lattice(12, 12).mesh().unwrap();
    for (mesh, kernel) in [(&sphere, 1), (&square, 3)] {
        let found = modes(mesh, 5, Energy::L1Hessian);
        assert_eq!(found.status, Status::Solved);
        assert_orthonormal_and_ascending(mesh, &found, 5);
        assert!(found.energies[kernel - 1] < 1e-6 * found.energies[kernel], "{:?}", found.energies);
        let form = EnergyForm::new(Energy::L1Hessian, mesh, None, Dual::Barycentric).unwrap();
        for (c, energy) in found.energies.iter().enumerate() {
            assert!((form.evaluate(found.values.column(c)).unwrap() - energy).abs() <= 1e-9 * (1.0 + energy));
        }
        let smooth = modes(mesh, 5, Energy::L2CurvedHessian);
        let total = |m: &Modes| (kernel..5).map(|c| form.evaluate(m.values.column(c)).unwrap()).sum::<f64>();
        assert!(total(&found) < 0.97 * total(&smooth), "{} against {}", total(&found), total(&smooth));
    }
}

#[test]
fn every_energy_has_modes_with_weights_and_flips() {
    let mesh = shapes::torus(14, 8, 1.0, 0.4).noisy(0.02, 2).mesh().unwrap();
    for (name, kind) in Energy::ALL {
        let plain = modes(&mesh, 4, kind);
        assert_orthonormal_and_ascending(&mesh, &plain, 4);
        assert!(plain.energies[0] < 1e-7 * plain.energies[1], "{name}: the constant comes first");
        let mut heavy = options(kind);
        heavy.energy.face_weights = Some(vec![3.0; mesh.connectivity().n_faces()]);
        heavy.energy.delaunay = !kind.is_extrinsic();
        let weighted = vibration_modes(&mesh, 4, &heavy, &Progress::new()).unwrap();
        let ratio = weighted.energies[1] / plain.energies[1];
        let expected = if kind.is_extrinsic() { 2.99..3.01 } else { 2.0..4.0 };
        assert!(expected.contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn same_bits_and_both_solvers() {
    let mesh = shapes::icosphere(2).noisy(0.03, 5).mesh().unwrap();
    let with = |solver, threads| {
        let solve = SolveOptions { solver, threads, ..SolveOptions::default() };
        vibration_modes(&mesh, 4, &ModeOptions { solve, ..ModeOptions::default() }, &Progress::new()).unwrap()
    };
    let fast = with(Solver::Auto, Some(1));
    assert_eq!(fast, with(Solver::Auto, Some(2)));
    let exact = with(Solver::Clarabel, None);
    for (a, b) in fast.energies.iter().zip(&exact.energies) {
        assert!((a - b).abs() < 0.02 * b + 1e-6, "{:?} {:?}", fast.energies, exact.energies);
    }
}

#[test]
fn wrong_counts_are_refused_and_cancelling_is_heard() {
    let mesh = shapes::tetrahedron().mesh().unwrap();
    for count in [0, 5] {
        let error = vibration_modes(&mesh, count, &ModeOptions::default(), &Progress::new()).unwrap_err();
        assert!(error.to_string().starts_with("count"), "{error}");
    }
    assert_orthonormal_and_ascending(&mesh, &modes(&mesh, 4, Energy::L2Laplacian), 4);
    let progress = Progress::new();
    progress.cancel();
    let error = vibration_modes(&mesh, 2, &ModeOptions::default(), &progress).unwrap_err();
    assert_eq!(error, Error::Cancelled);
    let progress = Progress::new();
    progress.finish();
    let sphere = shapes::icosphere(1).mesh().unwrap();
    let stopped = vibration_modes(&sphere, 4, &ModeOptions::default(), &progress).unwrap();
    assert_eq!((stopped.status, stopped.values.n_columns), (Status::Stopped, 1));
}

#[test]
fn slivers_do_not_keep_modes_from_settling() {
    let mut shape = shapes::torus(24, 12, 1.0, 0.4);
    let plain = modes(&shape.mesh().unwrap(), 5, Energy::L2Laplacian);
    // Half of a ring moves onto its neighbors but for a ten thousandth: entries of the energy grow by 1e8.
    for i in (0..24).step_by(2) {
        let (a, b) = (shape.vertices[i], shape.vertices[i + 1]);
        shape.vertices[i] = [0, 1, 2].map(|k| b[k] + 1e-4 * (a[k] - b[k]));
    }
    let mesh = shape.mesh().unwrap();
    let found = modes(&mesh, 5, Energy::L2Laplacian);
    assert_orthonormal_and_ascending(&mesh, &found, 5);
    for (a, b) in found.energies.iter().zip(&plain.energies) {
        assert!((a - b).abs() < 0.15 * b + 1e-6, "{:?} {:?}", found.energies, plain.energies);
    }
}

/// The energies of a band of slim faces fall with the square of its edges, far below what its area tells.
#[test]
fn rounds_hardly_grow_with_the_edges_of_a_band() {
    let rounds = |n: usize| {
        let mesh = shapes::cylinder(n, 2, 1.0, 0.2).mesh().unwrap();
        let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
        let operator =
            HessianPattern::new(connectivity).unwrap().assemble(connectivity, lengths, Dual::Barycentric);
        let mass = voronoi_mass(connectivity, lengths).unwrap();
        let area: f64 = mass.iter().sum();
        let weights: Vec<f64> = lengths.iter().map(|&l| 1.0 / triangle::area(l)).collect();
        let pencil = Pencil {
            operator: &operator.unwrap(),
            weights: &weights,
            mass: &mass,
            scale: (4.0 * std::f64::consts::PI / area).powi(2),
            accuracy: 1e-8,
            memory_limit: None,
        };
        let progress = Progress::new();
        let found = pencil.smallest(3, &progress).unwrap();
        assert!(found.values.windows(2).all(|pair| pair[0] <= pair[1]));
        progress.n_asked()
    };
    let [short, long] = [500, 4000].map(rounds);
    // The shift falls step by step to where the energies are.
    assert!(long <= 3 * short, "{long} rounds, and {short} for an eighth of the edges");
}
