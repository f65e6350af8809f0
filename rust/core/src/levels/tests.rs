//! Levels of known shapes.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::mesh::report;
use crate::mesh::vector::{area_vector, distance, dot, norm};
use crate::shapes::{self, Shape};

fn coarser(shape: &Shape, held: Option<&[bool]>, enough: usize) -> (Mesh, Vec<Level>) {
    let mesh = shape.mesh().unwrap();
    let found = levels(&mesh, held, enough, &Progress::new()).unwrap();
    (mesh, found)
}

fn points(mesh: &Mesh) -> &[Point] {
    mesh.positions().unwrap()
}

fn volume(mesh: &Mesh) -> f64 {
    let one = |face: &[u32; 3]| {
        let corners = face.map(|v| points(mesh)[v as usize]);
        dot(area_vector(corners), corners[0]) / 3.0
    };
    mesh.connectivity().faces().iter().map(one).sum()
}

#[test]
fn each_level_is_a_closed_surface_with_a_quarter_of_the_vertices_at_the_most_and_the_same_way_out() {
    let (mesh, found) = coarser(&shapes::torus(96, 48, 1.0, 0.4).noisy(0.01, 1), None, 200);
    let mut finer = &mesh;
    for level in &found {
        let report = report(&level.mesh).unwrap();
        assert_eq!(report.n_boundary_loops, 0);
        assert!(report.nonmanifold_edges.is_empty() && report.inconsistent_edges.is_empty());
        assert!(report.nonmanifold_vertices.is_empty() && report.duplicate_faces.is_empty());
        assert_eq!(2 * level.mesh.connectivity().n_vertices(), level.mesh.connectivity().n_faces());
        let (few, many) = (level.mesh.connectivity().n_vertices(), finer.connectivity().n_vertices());
        assert!(4 * few + 4 >= many && 2 * few < many, "{few} of {many}");
        assert!((volume(&level.mesh) / volume(&mesh) - 1.0).abs() < 0.05);
        finer = &level.mesh;
    }
    assert!(finer.connectivity().n_vertices() <= 200 && found.len() == 3);
}

#[test]
fn under_noise_a_vertex_is_nearer_to_the_surface_than_those_that_it_stands_for() {
    let shape = shapes::icosphere(5).map(|p| crate::mesh::vector::scale(p, 1.0 / norm(p))).noisy(0.01, 3);
    let (mesh, found) = coarser(&shape, None, 700);
    let spread = |mesh: &Mesh| {
        let n = points(mesh).len() as f64;
        let mean = points(mesh).iter().map(|p| norm(*p)).sum::<f64>() / n;
        (mean, (points(mesh).iter().map(|p| (norm(*p) - mean).powi(2)).sum::<f64>() / n).sqrt())
    };
    let coarse = &found.last().unwrap().mesh;
    let ((fine_mean, fine), (mean, left)) = (spread(&mesh), spread(coarse));
    assert!(left < 0.7 * fine && (mean - fine_mean).abs() < fine, "{fine_mean} {fine} {mean} {left}");
}

#[test]
fn corners_and_edges_of_a_cube_stay() {
    let (mesh, found) = coarser(&shapes::cube(24), None, 60);
    let coarse = &found.last().unwrap().mesh;
    let area = |mesh: &Mesh| {
        let one = |face: &[u32; 3]| norm(area_vector(face.map(|v| points(mesh)[v as usize])));
        mesh.connectivity().faces().iter().map(one).sum::<f64>()
    };
    assert!((area(coarse) - area(&mesh)).abs() < 2e-3 * area(&mesh));
    let box_of = |mesh: &Mesh| {
        let side = |c: usize| points(mesh).iter().map(|p| p[c]).fold(f64::NEG_INFINITY, f64::max);
        [side(0), side(1), side(2)]
    };
    assert!(
        box_of(coarse).iter().zip(box_of(&mesh)).all(|(a, b)| (a - b).abs() < 2e-3 * b.abs()),
        "{:?}",
        box_of(coarse)
    );
}

#[test]
fn an_affine_function_is_carried_over_a_flat_sheet_and_its_border_stays() {
    let (mesh, found) = coarser(&shapes::grid(40, 30), None, 100);
    let mut value: Vec<Point> = points(&found.last().unwrap().mesh).to_vec();
    for level in found.iter().rev() {
        assert_eq!(report(&level.mesh).unwrap().n_boundary_loops, 1);
        value = level.carry.points(&value, [9.0; 3]).unwrap();
    }
    let worst = value.iter().zip(points(&mesh)).map(|(a, b)| distance(*a, *b)).fold(0.0, f64::max);
    let size = points(&mesh).iter().map(|p| norm(*p)).fold(0.0, f64::max);
    assert!(worst < 1e-3 * size, "{worst} {size}");
}

#[test]
fn a_thin_sheet_is_carried_by_its_own_side() {
    // Two sheets a hundredth of an edge apart, joined nowhere.
    let lower = shapes::grid(30, 30);
    let gap = 1e-2 / 30.0;
    let shape = lower.clone().and(&lower.map(|p| [p[0], p[1], p[2] + gap]));
    let (mesh, found) = coarser(&shape, None, 200);
    let level = &found[0];
    let height: Vec<Point> = points(&level.mesh).iter().map(|p| [p[2], 0.0, 0.0]).collect();
    let carried = level.carry.points(&height, [9.0; 3]).unwrap();
    assert!(carried.iter().zip(points(&mesh)).all(|(value, p)| (value[0] - p[2]).abs() < 1e-3 * gap));
}

#[test]
fn held_and_loose_vertices_keep_apart_and_nothing_is_carried_to_them() {
    let mut shape = shapes::icosphere(4);
    let mut held: Vec<bool> = shape.vertices.iter().map(|p| p[2] > 0.0).collect();
    shape.vertices.push([5.0; 3]);
    held.push(false);
    let (_, found) = coarser(&shape, Some(&held), 300);
    let level = &found[0];
    let values: Vec<f64> = held.iter().map(|&is| f64::from(u8::from(is))).collect();
    assert!(level.mean_of(&values).unwrap().iter().all(|mean| *mean == 0.0 || *mean == 1.0));
    assert_eq!(*level.parents.last().unwrap(), u32::MAX);
    let carried = level.carry.points(points(&level.mesh), [7.0; 3]).unwrap();
    assert!(carried.iter().zip(&held).filter(|(_, &is)| is).all(|(p, _)| *p == [7.0; 3]));
    assert!(carried.iter().zip(&held).filter(|(p, &is)| !is && **p == [7.0; 3]).count() == 1);
    assert_eq!(*carried.last().unwrap(), [7.0; 3]);
}

#[test]
fn what_cannot_collapse_has_no_levels() {
    // Every edge has three faces.
    let page = |k: u32| [0, 1, 2 + k];
    let vertices =
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
    let mesh = Mesh::new(vertices, (0..3).map(page).collect()).unwrap();
    assert!(levels(&mesh, None, 2, &Progress::new()).unwrap().is_empty());
}

#[test]
fn levels_end_when_they_are_cancelled() {
    let mesh = shapes::icosphere(4).mesh().unwrap();
    let progress = Progress::new();
    progress.cancel();
    assert!(levels(&mesh, None, 100, &progress).is_err());
}

#[test]
fn where_slivers_cannot_collapse_the_rest_keeps_its_vertices() {
    // A disk whose inner rings are far below the noise.
    let disk = shapes::cylinder(240, 40, 1.0, 1.0).map(|[x, y, z]| [x * (z + 1e-4), y * (z + 1e-4), 0.0]);
    let (_, found) = coarser(&disk.noisy(5e-3, 5), None, 150);
    let coarse = &found.last().unwrap().mesh;
    let areas = coarse.connectivity().faces().iter();
    let areas: Vec<f64> =
        areas.map(|face| norm(area_vector(face.map(|v| points(coarse)[v as usize])))).collect();
    let (sum, largest) = (areas.iter().sum::<f64>(), areas.iter().copied().fold(0.0, f64::max));
    assert!(sum > 3.0 && largest < 0.02 * sum, "{largest} of {sum}");
}

#[test]
fn kept_vertices_stay_each_on_its_own() {
    let shape = shapes::grid(20, 20);
    let mesh = shape.mesh().unwrap();
    let kept: Vec<bool> = shape.vertices.iter().map(|p| p[0] == shape.vertices[0][0]).collect();
    let level = level(&mesh, None, Some(&kept), 60, &Progress::new()).unwrap();
    let points = level.mesh.positions().unwrap();
    let own: std::collections::BTreeSet<u32> =
        (0..kept.len()).filter(|&v| kept[v]).map(|v| level.parents[v]).collect();
    assert_eq!(own.len(), kept.iter().filter(|kept| **kept).count());
    for v in (0..kept.len()).filter(|&v| kept[v]) {
        assert_eq!(points[level.parents[v] as usize], shape.vertices[v]);
    }
    assert!(points.len() < 100);
    assert!(level
        .carry
        .places()
        .all(|place| place.is_some_and(|(_, w)| (w.iter().sum::<f64>() - 1.0).abs() < 1e-12)));
}
