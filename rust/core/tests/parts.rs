//! Parts: limbs at every density, nesting, paint, stopping.
#![allow(clippy::unwrap_used, missing_docs)]

use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::solve::Status;
use ridgeform_core::tools::{parts, PartsOptions};
use ridgeform_core::{Error, Progress};

/// A unit ball with a cylinder of radius 0.35 out to 2.5 along z: 20 · 4^levels faces.
fn ball_with_a_limb(levels: usize) -> Shape {
    shapes::icosphere(levels).map(|p| {
        let sine = p[0].hypot(p[1]).max(1e-9);
        let reach = if p[2] > 0.0 { (0.35 / sine).min(2.5) } else { 0.0 };
        p.map(|x| x * reach.max(1.0))
    })
}

#[test]
fn the_limb_is_the_first_part_at_every_density() {
    for levels in [4, 5] {
        let shape = ball_with_a_limb(levels);
        let mesh = shape.mesh().unwrap();
        let found =
            parts(&mesh, &PartsOptions { n_parts: Some(2), ..PartsOptions::default() }, &Progress::new())
                .unwrap();
        assert_eq!(found.n_parts, 2);
        let limb = found.labels[far_face(&shape)];
        for (face, &label) in shape.faces.iter().zip(&found.labels) {
            let height = face.iter().map(|&v| shape.vertices[v as usize][2]).sum::<f64>() / 3.0;
            assert!(label == limb || height < 1.3, "a face of the limb at {height} is on the ball");
            assert!(label != limb || height > 0.7, "a face of the ball at {height} is on the limb");
        }
    }
}

/// The face at the tip.
fn far_face(shape: &Shape) -> usize {
    let height = |f: usize| shape.faces[f].iter().map(|&v| shape.vertices[v as usize][2]).sum::<f64>();
    (0..shape.faces.len()).max_by(|&a, &b| height(a).total_cmp(&height(b))).unwrap()
}

#[test]
fn a_call_can_be_cancelled_and_finished_early() {
    let mesh = ball_with_a_limb(3).mesh().unwrap();
    let cancelled = Progress::new();
    cancelled.cancel();
    assert_eq!(parts(&mesh, &PartsOptions::default(), &cancelled), Err(Error::Cancelled));
    let finishing = Progress::new();
    finishing.finish();
    let found = parts(&mesh, &PartsOptions::default(), &finishing).unwrap();
    assert_eq!(found.status, Status::Stopped);
    assert_eq!(found.labels.len(), mesh.connectivity().n_faces());
}

#[test]
fn no_part_of_a_coarse_mesh_is_a_crumb_of_few_faces() {
    let mesh = ball_with_a_limb(3).mesh().unwrap();
    let options = PartsOptions { n_parts: Some(32), ..PartsOptions::default() };
    let found = parts(&mesh, &options, &Progress::new()).unwrap();
    assert!(found.n_parts > 16);
    for part in 0..found.n_parts as i32 {
        let n_faces = found.labels.iter().filter(|label| **label == part).count();
        assert!(n_faces >= 6, "part {part} of {} has {n_faces} faces", found.n_parts);
    }
}

#[test]
fn what_is_round_falls_into_pieces_of_about_one_size() {
    let ball = shapes::icosphere(4).rotated([0.3, -1.0, 0.7], 0.8);
    let egg = ball.clone().map(|[x, y, z]| [x, y, 1.4 * z + 0.3 * z * z]);
    for shape in [ball, egg] {
        let mesh = shape.mesh().unwrap();
        for count in [2, 4, 8] {
            let options = PartsOptions { n_parts: Some(count), ..PartsOptions::default() };
            let found = parts(&mesh, &options, &Progress::new()).unwrap();
            for part in 0..count as i32 {
                let share = found.labels.iter().filter(|label| **label == part).count() as f64
                    / found.labels.len() as f64;
                assert!(share * count as f64 > 0.25, "part {part} of {count} has {share}");
            }
        }
    }
}
