#![allow(clippy::unwrap_used)]
use super::*;
use crate::mesh::partition::contiguous;
use crate::mesh::vector::Point;
use crate::mesh::Mesh;
use crate::shapes;

/// How many faces there are: those on surfaces, and the facets of the rest; `None` where the shape is left to
/// its bends.
fn faces(mesh: &Mesh) -> Option<usize> {
    let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
    let surface = Surface::new(connectivity, positions, 1.0, vec![[1.0; 3]; connectivity.n_faces()]).unwrap();
    let found = covered(&surface, 0.4, &Progress::default()).unwrap();
    found.map(|planes| contiguous(&planes.labels).unwrap().1)
}

/// The strip of rows of points, each row connected with the next.
fn strips(rows: &[Vec<Point>]) -> Mesh {
    let n = rows[0].len() as u32;
    let mut triangles = Vec::new();
    for i in 0..rows.len() as u32 - 1 {
        for j in 0..n - 1 {
            let [a, b] = [i * n + j, (i + 1) * n + j];
            triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let single = |p: &Point| p.map(|x| f64::from(x as f32));
    Mesh::new(rows.iter().flatten().map(single).collect(), triangles).unwrap()
}

/// A row of points in a plane that leaves along x, turns by a right angle with a radius of 1 in `n` steps,
/// and leaves along y.
fn rounded_corner(n: usize) -> Vec<[f64; 2]> {
    let arc = (0..=n).map(|k| {
        let angle = std::f64::consts::FRAC_PI_2 * k as f64 / n as f64;
        [3.0 + angle.sin(), 1.0 - angle.cos()]
    });
    std::iter::once([0.0, 0.0]).chain(arc).chain([[4.0, 5.0]]).collect()
}

#[test]
fn a_fillet_is_a_face_between_the_planes_that_it_touches() {
    for n in [4, 6, 16] {
        let profile = rounded_corner(n);
        let row = |z: f64| profile.iter().map(|&[x, y]| [x, y, z]).collect();
        let mesh = strips(&[row(0.0), row(2.5)]);
        assert_eq!(faces(&mesh), Some(3), "{n}");
    }
}

#[test]
fn a_turned_fillet_is_a_face_between_disk_and_cylinder() {
    for (n, sides) in [(4, 24), (13, 60)] {
        let turned = |[rho, z]: [f64; 2]| {
            let point = move |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / sides as f64;
                [rho * angle.cos(), rho * angle.sin(), z]
            };
            (0..=sides / 2).map(point).collect::<Vec<Point>>()
        };
        let rows: Vec<Vec<Point>> =
            rounded_corner(n).into_iter().map(|[x, y]| turned([x + 0.5, y])).collect();
        assert_eq!(faces(&strips(&rows)), Some(3), "{n}");
    }
}

#[test]
fn a_vase_is_no_stack_of_rings() {
    let profile = |k: usize| {
        let t = k as f64 / 20.0;
        [1.0 + 0.3 * (4.0 * t).sin() + 0.1 * t * t, 2.0 * t]
    };
    let row = |[rho, z]: [f64; 2]| {
        (0..=30).map(move |k| {
            let angle = 0.1 * f64::from(k);
            [rho * angle.cos(), rho * angle.sin(), z]
        })
    };
    let rows: Vec<Vec<Point>> = (0..=20).map(|k| row(profile(k)).collect()).collect();
    assert_eq!(faces(&strips(&rows)), None);
}

#[test]
fn what_is_not_exact_is_left_to_its_bends() {
    assert_eq!(faces(&shapes::icosphere(3).mesh().unwrap()), Some(1));
    assert_eq!(faces(&shapes::icosphere(3).noisy(1e-4, 1).mesh().unwrap()), None);
    assert_eq!(faces(&shapes::cube(3).mesh().unwrap()), None);
}
