//! Segmentation: the face Laplacian, the functional's fixed points, stopping, and the paper's way.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::mesh::Connectivity;
use ridgeform_core::operators::face_laplacian_weights;
use ridgeform_core::shapes;
use ridgeform_core::solve::Status;
use ridgeform_core::tools::{segment, SegmentMethod, SegmentOptions};
use ridgeform_core::{Error, Progress};

/// The face Laplacian as a matrix, `m × m`, symmetric, rows that sum to 0: see `face_laplacian_weights`.
fn face_laplacian(connectivity: &Connectivity, weights: &[[f64; 3]]) -> sprs::CsMat<f64> {
    let m = connectivity.n_faces();
    let mut triplets = sprs::TriMat::new((m, m));
    for (f, row) in weights.iter().enumerate() {
        triplets.add_triplet(f, f, row.iter().sum());
        for (i, weight) in row.iter().enumerate() {
            if let Some(twin) = connectivity.twin(3 * f + i).filter(|_| *weight > 0.0) {
                triplets.add_triplet(f, twin / 3, -weight);
            }
        }
    }
    triplets.to_csr()
}

#[test]
fn the_face_laplacian_is_symmetric_knows_constants_and_squares_of_a_lattice() {
    let mesh = shapes::lattice(6, 6).mesh().unwrap();
    let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
    let centroid =
        |f: &[u32; 3]| [0, 1, 2].map(|c| f.iter().map(|&v| positions[v as usize][c]).sum::<f64>() / 3.0);
    let centroids: Vec<[f64; 3]> = connectivity.faces().iter().map(centroid).collect();
    let weights = face_laplacian_weights(connectivity, mesh.edge_lengths(), &centroids).unwrap();
    // Edges of length 1, centroids two inradii apart.
    let expected = 3.0_f64.sqrt();
    assert!(weights.as_flattened().iter().all(|w| *w == 0.0 || (w - expected).abs() < 1e-12));
    let laplacian = face_laplacian(connectivity, &weights);
    for (f, row) in laplacian.outer_iterator().enumerate() {
        assert!(row.iter().map(|(_, x)| x).sum::<f64>().abs() < 1e-12);
        for (g, x) in row.iter() {
            assert_eq!(laplacian.get(g, f), Some(x));
        }
    }
    // An affine function is harmonic away from the boundary.
    for (f, row) in laplacian.outer_iterator().enumerate() {
        if weights[f].iter().all(|w| *w > 0.0) {
            let value: f64 = row.iter().map(|(g, x)| x * (centroids[g][0] - 2.0 * centroids[g][1])).sum();
            assert!(value.abs() < 1e-12, "face {f}: {value}");
        }
    }
}

#[test]
fn a_flat_mesh_is_one_segment_without_borders() {
    let mesh = shapes::grid(12, 9).mesh().unwrap();
    for method in [SegmentMethod::Fitted, SegmentMethod::Paper] {
        let options = SegmentOptions { method, ..SegmentOptions::default() };
        let found = segment(&mesh, None, &options, &Progress::new()).unwrap();
        assert_eq!(found.n_segments, 1);
        assert!(found.boundary_edges.is_empty());
        assert!(found.indicator.iter().all(|v| (v - 1.0).abs() < 1e-6));
    }
}

#[test]
fn both_ways_find_the_sides_of_a_cube_at_any_angle() {
    let mesh = shapes::cube(16).rotated([0.3, -1.0, 0.7], 0.8).mesh().unwrap();
    for method in [SegmentMethod::Fitted, SegmentMethod::Paper] {
        let options = SegmentOptions { method, epsilon_end: 0.02, ..SegmentOptions::default() };
        let found = segment(&mesh, None, &options, &Progress::new()).unwrap();
        assert_eq!(found.n_segments, 6, "{method:?}");
    }
}

#[test]
fn a_call_can_be_cancelled_and_finished_early() {
    let mesh = shapes::cube(8).noisy(0.02, 1).mesh().unwrap();
    let cancelled = Progress::new();
    cancelled.cancel();
    assert_eq!(segment(&mesh, None, &SegmentOptions::default(), &cancelled), Err(Error::Cancelled));
    let finishing = Progress::new();
    finishing.finish();
    let found = segment(&mesh, None, &SegmentOptions::default(), &finishing).unwrap();
    assert_eq!(found.status, Status::Stopped);
    assert_eq!(found.labels.len(), mesh.connectivity().n_faces());
    assert!(found.values.data.iter().all(|x| x.is_finite()));
}
