//! Random holes in ten meshes, several at once.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod hole_checks;

use hole_checks::{patched, patches_of, shapeliness, with_random_holes};
use ridgeform_core::hole_filling::{find_holes, FillOptions};
use ridgeform_core::shapes::{self, Random, Shape};

/// Smooth and sharp, even and uneven, closed and open, clean and rough.
fn ten_meshes() -> [Shape; 10] {
    [
        shapes::icosphere(3),
        shapes::cube(12).rotated([1.0, 2.0, 3.0], 0.7),
        shapes::torus(40, 24, 2.0, 0.8),
        shapes::grid(24, 24),
        shapes::cylinder(32, 16, 1.0, 3.0),
        shapes::icosphere(3).noisy(0.02, 1),
        shapes::lattice(24, 20).map(|[x, y, z]| [x, y, z + 2.0 * (0.4 * x).sin() * (0.3 * y).cos()]),
        shapes::icosphere(3).map(|[x, y, z]| [x, y, 5.0 * z]),
        shapes::grid(24, 24).map(|[x, y, z]| [x * (1.0 + 0.1 * x), y, z]).noisy(0.2, 2),
        shapes::cube(10).map(|p| p.map(|x| x + 0.15 * (5.0 * x).sin())),
    ]
}

/// Cuts and fills `count` times in every mesh, with the seeds from `first` on.
/// Returns how many holes were filled.
fn stress(first: u64, count: u64) -> usize {
    let mut filled_holes = 0;
    let (mut thin, mut folded, mut n_faces) = (0, 0, 0);
    for (which, shape) in ten_meshes().iter().enumerate() {
        for seed in first..first + count {
            let mut random = Random::new(1000 * which as u64 + seed);
            let n_holes = 1 + (random.bits() % 4) as usize;
            let mesh = with_random_holes(shape, n_holes, &mut random).mesh().unwrap();
            let holes = find_holes(&mesh).unwrap();
            let wanted: Vec<Vec<u32>> = holes
                .iter()
                .filter(|hole| !hole.is_outer_border && hole.refusal.is_none())
                .map(|hole| hole.vertices.clone())
                .collect();
            let patches = patches_of(&mesh, &wanted, &FillOptions::default())
                .unwrap_or_else(|error| panic!("mesh {which}, seed {seed}: {error}"));
            let filled =
                patched(&mesh, &patches).unwrap_or_else(|why| panic!("mesh {which}, seed {seed}: {why}"));
            let shape = shapeliness(&filled, mesh.connectivity().n_faces());
            assert!(shape.quality > 0.02, "mesh {which}, seed {seed}: {shape:?}");
            if shape.quality < 0.1 || shape.cosine < -0.9 {
                println!(
                    "mesh {which} seed {seed}: {shape:?}, loops {:?}",
                    wanted.iter().map(Vec::len).collect::<Vec<_>>()
                );
            }
            thin += usize::from(shape.quality < 0.1);
            folded += usize::from(shape.cosine < -0.9);
            n_faces += shape.n_faces;
            filled_holes += patches.len();
        }
    }
    assert_eq!(folded, 0);
    println!("{filled_holes} holes, {n_faces} faces; cases with a sliver: {thin}, with a fold: {folded}");
    filled_holes
}

#[test]
fn random_holes_are_filled_soundly() {
    assert!(stress(0, 4) > 50);
}

#[test]
#[ignore = "some ten seconds: 500 cuts of one to four holes"]
fn five_hundred_random_holes_are_filled_soundly() {
    assert!(stress(100, 50) > 500);
}
