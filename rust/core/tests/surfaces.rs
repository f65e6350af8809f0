//! Surfaces by name: what was sampled with noise is found again, wherever it lies.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use ridgeform_core::mesh::vector::{add, cross, distance, dot, scale, sub, unit, Point};
use ridgeform_core::shapes::Random;
use ridgeform_core::surfaces::{fit, Kind, Samples, Surface};

/// Points of a part of a surface about the z axis by two numbers from 0 to 1, with their normals.
fn place(kind: Kind, s: f64, t: f64, arc: f64) -> (Point, Point) {
    let angle = arc * (s - 0.5);
    let (sine, cosine) = angle.sin_cos();
    match kind {
        Kind::Plane => ([2.0 * s, t, 0.3], [0.0, 0.0, 1.0]),
        Kind::Sphere => {
            let height = t - 0.3;
            let rho = (1.0 - height * height).sqrt();
            let n = [rho * cosine, rho * sine, height];
            (scale(n, 1.5), n)
        }
        Kind::Cylinder => ([0.8 * cosine, 0.8 * sine, 1.5 * t], [cosine, sine, 0.0]),
        Kind::Cone => {
            let (rho, n) = (0.5 + 0.6 * t, unit([cosine, sine, -0.6]));
            ([rho * cosine, rho * sine, t], n)
        }
        Kind::Torus => {
            let (sin, cos) = (2.5 * (t - 0.4)).sin_cos();
            let rho = 1.0 + 0.4 * cos;
            ([rho * cosine, rho * sine, 0.4 * sin], [cos * cosine, cos * sine, sin])
        }
    }
}

/// So many points of it with noise `sigma`, turned and shifted; the true points, too.
fn samples(kind: Kind, n: usize, arc: f64, sigma: f64, seed: u64, outliers: f64) -> (Samples, Vec<Point>) {
    let mut random = Random::new(seed);
    let mut number = || 0.5 + 0.5 * random.symmetric();
    let z = unit([number() - 0.5, number() - 0.5, number() - 0.3]);
    let x = unit(cross(z, [0.3, 0.9, -0.2]));
    let y = cross(z, x);
    let shift = [3.0 * number(), -2.0 * number(), number()];
    let turned = |p: Point| add(add(scale(x, p[0]), scale(y, p[1])), scale(z, p[2]));
    let (mut found, mut truth) = (Samples::default(), Vec::new());
    for _ in 0..n * n {
        let (p, normal) = place(kind, number(), number(), arc);
        let p = add(turned(p), shift);
        truth.push(p);
        // The sum of twelve is nearly normal.
        let mut noise = || (0..12).map(|_| number()).sum::<f64>() - 6.0;
        let mut off = [noise(), noise(), noise()].map(|x| sigma * x);
        if number() < outliers {
            off = off.map(|x| x + 0.5 * number());
        }
        let blur = [number(), number(), number()].map(|x| 8.0 * sigma * (x - 0.5));
        found.push(add(p, off), unit(add(turned(normal), blur)), 1.0).unwrap();
    }
    (found, truth)
}

fn off(surface: &Surface, truth: &[Point]) -> f64 {
    (truth.iter().map(|&p| surface.distance(p).0.powi(2)).sum::<f64>() / truth.len() as f64).sqrt()
}

#[test]
fn every_kind_is_found_exactly_without_noise_and_near_under_noise() {
    for kind in Kind::ALL {
        for arc in [6.2, 2.0] {
            let (clean, truth) = samples(kind, 20, arc, 0.0, 3, 0.0);
            let found = fit(kind, &clean, 1e-6).unwrap().unwrap();
            assert!(off(&found.surface, &truth) < 1e-7, "{kind:?} {arc}: {:e}", off(&found.surface, &truth));
            assert_eq!(found.surface.kind(), kind);
            assert_eq!(
                clean.side(&found.surface),
                if dot_of(&clean, &found.surface) < 0.0 { -1.0 } else { 1.0 }
            );
            for seed in 0..10 {
                let (noisy, truth) = samples(kind, 25, arc, 0.02, 10 + seed, 0.05);
                let found = fit(kind, &noisy, 0.02).unwrap().unwrap();
                // As well as the number of points and parameters allows, three times over.
                let expected = 0.02 * (kind.n_parameters() as f64 / 625.0).sqrt();
                let error = off(&found.surface, &truth);
                assert!(error < 3.0 * expected, "{kind:?} {arc} {seed}: {error} {expected}");
            }
        }
    }
}

fn dot_of(samples: &Samples, surface: &Surface) -> f64 {
    dot(surface.distance(samples.points[0]).1, samples.normals[0])
}

#[test]
fn the_simplest_kind_costs_least_with_its_parameters() {
    for truth in Kind::ALL {
        let (noisy, _) = samples(truth, 25, 3.0, 0.02, 5, 0.0);
        let cost = |kind: Kind| {
            fit(kind, &noisy, 0.02)
                .unwrap()
                .map_or(f64::INFINITY, |f| f.cost + 3.2 * kind.n_parameters() as f64)
        };
        let best = Kind::ALL.into_iter().min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap();
        assert_eq!(best, truth);
    }
}

#[test]
fn what_determines_no_surface_gives_none() {
    assert!(Kind::ALL.into_iter().all(|kind| fit(kind, &Samples::default(), 1.0).unwrap().is_none()));
    let mut same = Samples::default();
    (0..9).for_each(|_| same.push([1.0; 3], [0.0, 0.0, 1.0], 1.0).unwrap());
    assert!(Kind::ALL.into_iter().all(|kind| fit(kind, &same, 1.0).unwrap().is_none()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn fits_follow_rigid_motions_and_scaling(seed in 0_u64..1000, k in 0_usize..5, size in 0.01_f64..100.0) {
        let kind = Kind::ALL[k];
        let (noisy, _) = samples(kind, 15, 3.0, 0.01, seed, 0.0);
        let before = fit(kind, &noisy, 0.01).unwrap().unwrap();
        let z = unit([0.3, -1.0, 0.5]);
        let x = unit(cross(z, [1.0, 0.0, 0.2]));
        let y = cross(z, x);
        let turned = |p: Point| [dot(x, p), dot(y, p), dot(z, p)];
        let moved = |p: Point| add(scale(turned(p), size), [5.0, -3.0, 1.0]);
        let there = Samples {
            points: noisy.points.iter().map(|&p| moved(p)).collect(),
            normals: noisy.normals.iter().map(|&n| turned(n)).collect(),
            weights: noisy.weights.clone(),
        };
        let after = fit(kind, &there, 0.01 * size).unwrap().unwrap();
        prop_assert!((before.cost - after.cost).abs() < 1e-3 * before.cost, "{} {}", before.cost, after.cost);
        for &p in noisy.points.iter().take(50) {
            let there = sub(moved(before.surface.project(p)), after.surface.project(moved(p)));
            prop_assert!(distance(there, [0.0; 3]) < 1e-3 * size, "{kind:?}");
        }
    }
}
