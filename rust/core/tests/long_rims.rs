//! Round rims of thousands of edges: as many faces as asked for, without needles on the way.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use ridgeform_core::hole_filling::{fill_loops, FillOptions};
use ridgeform_core::mesh::Mesh;
use ridgeform_core::Progress;

/// A ring of 2 `n` faces around a round hole of `n` edges, and that hole.
fn ring(n: u32) -> (Mesh, Vec<u32>) {
    let at = |i: u32, radius: f64| {
        let angle = TAU * f64::from(i) / f64::from(n);
        [radius * angle.cos(), radius * angle.sin(), 0.3 * radius]
    };
    let vertices = (0..n).map(|i| at(i, 1.0)).chain((0..n).map(|i| at(i, 1.01))).collect();
    let faces = (0..n).flat_map(|i| {
        let next = (i + 1) % n;
        [[i, n + i, n + next], [i, n + next, next]]
    });
    (Mesh::new(vertices, faces.collect()).unwrap(), (0..n).collect())
}

#[test]
fn a_long_round_rim_is_refined_without_needles_before_it_is_remeshed() {
    for n in [1500, 4000] {
        let (mesh, hole) = ring(n);
        let options = FillOptions { remesh_iterations: 0, ..FillOptions::default() };
        let patch = &fill_loops(&mesh, &[hole], &options, &Progress::new()).unwrap()[0];
        assert!((20_000..60_000).contains(&patch.faces.len()), "{n}: {} faces", patch.faces.len());
        let mut valences = vec![0_u32; 2 * n as usize + patch.vertices.len()];
        patch.faces.iter().flatten().for_each(|&v| valences[v as usize] += 1);
        // With sizes that were means of the corners' a vertex had more than a thousand faces.
        assert!(*valences.iter().max().unwrap() < 200, "{n}: {:?}", valences.iter().max());
    }
}

#[test]
fn a_round_rim_of_twenty_thousand_edges_is_filled() {
    let (mesh, hole) = ring(20_000);
    let options = FillOptions { remesh_iterations: 1, ..FillOptions::default() };
    let patch = &fill_loops(&mesh, &[hole], &options, &Progress::new()).unwrap()[0];
    // Five for each edge of the rim.
    assert!((50_000..120_000).contains(&patch.faces.len()), "{} faces", patch.faces.len());
}
