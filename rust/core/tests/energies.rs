//! The comparison energies: kernels, known values on the plane and the sphere, invariances.
#![allow(clippy::unwrap_used, missing_docs)]

use proptest::prelude::*;
use ridgeform_core::error::MeshError;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{voronoi_mass, Dual, Energy, EnergyForm};
use ridgeform_core::shapes::{self, Random, Shape};
use ridgeform_core::Error;

fn form(mesh: &Mesh, energy: Energy) -> EnergyForm {
    EnergyForm::new(energy, mesh, None, Dual::Barycentric).unwrap()
}

fn value(mesh: &Mesh, energy: Energy, u: &[f64]) -> f64 {
    form(mesh, energy).evaluate(u).unwrap()
}

fn sample(mesh: &Mesh, f: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    mesh.positions().unwrap().iter().map(|&p| f(p)).collect()
}

/// A flat irregular mesh in a plane that is not one of coordinates.
fn tilted() -> Shape {
    shapes::grid(9, 8)
        .map(|[x, y, z]| {
            let inner = if x > 0.0 && x < 9.0 && y > 0.0 && y < 8.0 { 0.25 } else { 0.0 };
            [x + inner * (5.0 * x + 3.0 * y).sin(), y + inner * (7.0 * x - 4.0 * y).cos(), z]
        })
        .rotated([1.0, 2.0, 0.5], 0.7)
}

#[test]
fn constants_cost_nothing_anywhere_and_affine_functions_nothing_on_the_plane() {
    let closed = shapes::torus(14, 9, 1.0, 0.4).noisy(0.02, 1).mesh().unwrap();
    let flat = shapes::cylinder(12, 5, 1.0, 2.0).mesh().unwrap();
    for (name, energy) in Energy::ALL {
        for mesh in [&closed, &flat] {
            let ones = vec![3.0; mesh.connectivity().n_vertices()];
            assert!(value(mesh, energy, &ones) < 1e-12, "{name}");
        }
        let mesh = tilted().mesh().unwrap();
        let affine = sample(&mesh, |p| 2.0 * p[0] - 0.7 * p[1] + 0.3 * p[2] + 5.0);
        let bent = sample(&mesh, |p| p[0] * p[0]);
        let cost = value(&mesh, energy, &affine) / value(&mesh, energy, &bent);
        if energy == Energy::L2Laplacian {
            assert!(cost > 1e-3, "the zero Neumann condition bends affine functions at the boundary");
        } else {
            assert!(cost < 1e-13, "{name}: {cost:e}");
        }
    }
}

#[test]
fn a_quadratic_function_on_the_plane() {
    // ½ ∫ ‖H_u‖² of u = x² + 3 y² + x y is ½ (2² + 6² + 2 · 1²) = 21 per area,
    // at every vertex whose ring is regular.
    let mesh = shapes::grid(20, 16).mesh().unwrap();
    let u = sample(&mesh, |p| p[0] * p[0] + 3.0 * p[1] * p[1] + p[0] * p[1]);
    let inside = 19.0 * 15.0;
    assert!((value(&mesh, Energy::L2Hessian, &u) / (21.0 * inside) - 1.0).abs() < 1e-12);
    // |entries| sum to 2 + 6 + 1 + 1.
    assert!((value(&mesh, Energy::L1HessianStein2018, &u) / (10.0 * inside) - 1.0).abs() < 1e-12);
    // The curved energy has no curvature here and rings of its own at the boundary.
    let curved = value(&mesh, Energy::L2CurvedHessian, &u);
    assert!((curved / (21.0 * 320.0) - 1.0).abs() < 0.1, "{curved}");
    // The edge operator of a unit square with u = x y: along its diagonal from (0, 0) to (1, 1) the mean of
    // the ends is ½ and that of the other corners is 0; across an axis-parallel edge the crossing is its
    // midpoint.
    let square = shapes::grid(1, 1).mesh().unwrap();
    let xy = sample(&square, |p| p[0] * p[1]);
    assert!((value(&square, Energy::L1EdgeLaplacian, &xy) - 0.5).abs() < 1e-14);
}

#[test]
fn the_height_on_the_sphere() {
    // On the unit sphere Δz = −2 z, so that ½ ∫ |Δz|² = ½ ∫ ‖∇dz‖² + κ |dz|² = 8π/3.
    let exact = 8.0 * std::f64::consts::PI / 3.0;
    for energy in [Energy::L2Laplacian, Energy::L2CurvedHessian] {
        let errors: Vec<f64> = [2, 3, 4]
            .iter()
            .map(|&levels| {
                let mesh = shapes::icosphere(levels).mesh().unwrap();
                value(&mesh, energy, &sample(&mesh, |p| p[2])) / exact - 1.0
            })
            .collect();
        assert!(errors[2].abs() < 0.01 && errors[2].abs() < errors[0].abs(), "{energy:?}: {errors:?}");
    }
}

#[test]
fn intrinsic_energies_see_edge_lengths_only_and_no_energy_sees_rotations_but_one() {
    let shape = shapes::torus(13, 8, 1.0, 0.4).noisy(0.03, 5);
    let turned = shape.clone().rotated([0.3, 1.0, -0.4], 1.1);
    let (mesh, turned) = (shape.mesh().unwrap(), turned.mesh().unwrap());
    let lengths = Mesh::from_edge_lengths(shape.faces.clone(), mesh.edge_lengths().to_vec(), None).unwrap();
    let mut random = Random::new(8);
    let u: Vec<f64> = shape.vertices.iter().map(|_| random.symmetric()).collect();
    for (name, energy) in Energy::ALL {
        let ratio = value(&turned, energy, &u) / value(&mesh, energy, &u);
        let invariant = (ratio - 1.0).abs() < 1e-11;
        assert_eq!(invariant, energy != Energy::L1HessianStein2018, "{name}: {ratio}");
        match EnergyForm::new(energy, &lengths, None, Dual::Barycentric) {
            Ok(form) => assert!((form.evaluate(&u).unwrap() / value(&mesh, energy, &u) - 1.0).abs() < 1e-12),
            Err(error) => assert!(energy.is_extrinsic() && error == Error::Mesh(MeshError::NoPositions)),
        }
    }
}

#[test]
fn face_weights_scale_the_energy_and_localize_it() {
    let mesh = shapes::grid(12, 6).mesh().unwrap();
    let m = mesh.connectivity().n_faces();
    let u = sample(&mesh, |p| (p[0] - 3.0).abs());
    let right =
        mesh.connectivity().faces().iter().map(|f| mesh.positions().unwrap()[f[0] as usize][0] >= 6.0);
    let away: Vec<f64> = right.map(|right| if right { 7.0 } else { 1.0 }).collect();
    for (name, energy) in Energy::ALL.into_iter().filter(|(_, e)| *e != Energy::L2Laplacian) {
        let plain = value(&mesh, energy, &u);
        let with = |w: &[f64]| {
            EnergyForm::new(energy, &mesh, Some(w), Dual::Barycentric).unwrap().evaluate(&u).unwrap()
        };
        assert!((with(&vec![2.5; m]) / plain - 2.5).abs() < 1e-12, "{name}");
        assert!((with(&away) / plain - 1.0).abs() < 1e-12, "{name}: weights far from the ridge do not count");
    }
    let error = EnergyForm::new(Energy::L1Hessian, &mesh, Some(&away[1..]), Dual::Barycentric).unwrap_err();
    assert!(error.to_string().contains("face_weights"));
}

#[test]
fn circumcentric_duals_without_length_are_named_or_replaced() {
    let mesh = shapes::grid(5, 4).mesh().unwrap();
    let error = EnergyForm::new(Energy::L1Hessian, &mesh, None, Dual::Circumcentric).unwrap_err();
    assert_eq!(error, Error::Mesh(MeshError::ZeroDualEdge { face: 0, neighbor: 1 }));
    let mixed = EnergyForm::new(Energy::L1Hessian, &mesh, None, Dual::CircumcentricOrBarycentric).unwrap();
    let affine = sample(&mesh, |p| p[0] - 2.0 * p[1]);
    assert!(mixed.evaluate(&affine).unwrap() < 1e-12);
    assert!(mixed.operator.values.iter().flatten().all(|x| x.is_finite()));
    // Where all dual edges have a length it is the circumcentric operator itself.
    let lattice = shapes::lattice(6, 5).mesh().unwrap();
    let of = |dual| EnergyForm::new(Energy::L1Hessian, &lattice, None, dual).unwrap();
    assert_eq!(of(Dual::CircumcentricOrBarycentric), of(Dual::Circumcentric));
    assert_ne!(of(Dual::CircumcentricOrBarycentric), of(Dual::Barycentric));
    let error = EnergyForm::new(Energy::L2Laplacian, &mesh, None, Dual::Circumcentric).unwrap_err();
    assert!(error.to_string().contains("dual"));
}

#[test]
fn poor_meshes_give_finite_energies() {
    let shape = shapes::cube(3).and(&shapes::tetrahedron().map(|p| [p[0], p[1], 1e-9 * p[2]]));
    let mut faces = shape.faces.clone();
    faces.extend([[0, 1, 9], [0, 0, 1], [2, 3, 2]]);
    let mesh = Mesh::new(shape.vertices.clone(), faces).unwrap();
    let mut random = Random::new(2);
    let u: Vec<f64> = shape.vertices.iter().map(|_| random.symmetric()).collect();
    for (name, energy) in Energy::ALL {
        assert!(value(&mesh, energy, &u).is_finite(), "{name}");
    }
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths()).unwrap();
    assert!(mass.iter().all(|m| m.is_finite()));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    /// L1 energies are seminorms; quadratic ones obey the parallelogram law.
    #[test]
    fn energies_are_seminorms_or_their_squares(
        seed in 0_u64..1 << 40, amplitude in 0.0_f64..0.15, factor in -3.0_f64..3.0,
    ) {
        let mesh = shapes::torus(9, 7, 1.0, 0.4).noisy(amplitude, seed).mesh().unwrap();
        let mut random = Random::new(seed);
        let n = mesh.connectivity().n_vertices();
        let [u, v]: [Vec<f64>; 2] = std::array::from_fn(|_| (0..n).map(|_| random.symmetric()).collect());
        let weights: Vec<f64> = (0..mesh.connectivity().n_faces()).map(|_| random.uniform()).collect();
        let plus = |s: f64| -> Vec<f64> { u.iter().zip(&v).map(|(x, y)| x + s * y).collect() };
        for (name, energy) in Energy::ALL {
            let form = EnergyForm::new(energy, &mesh, Some(&weights), Dual::Barycentric).unwrap();
            let of = |x: &[f64]| form.evaluate(x).unwrap();
            let scaled: Vec<f64> = u.iter().map(|x| factor * x).collect();
            let size = of(&u).abs() + of(&v).abs();
            if energy.is_quadratic() {
                let off = (of(&scaled) - factor * factor * of(&u)).abs();
                prop_assert!(off <= 1e-9 * size * (1.0 + factor * factor), "{}", name);
                let parallelogram = of(&plus(1.0)) + of(&plus(-1.0)) - 2.0 * of(&u) - 2.0 * of(&v);
                prop_assert!(parallelogram.abs() <= 1e-9 * size, "{}", name);
            } else {
                let off = (of(&scaled) - factor.abs() * of(&u)).abs();
                prop_assert!(off <= 1e-9 * size * (1.0 + factor.abs()), "{}", name);
                prop_assert!(of(&plus(1.0)) <= (1.0 + 1e-12) * size, "{}", name);
            }
        }
    }
}
