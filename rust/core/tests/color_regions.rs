//! Regions of painted surfaces: known paints, whose curves redraw them exactly.
#![allow(clippy::unwrap_used)]

use ridgeform_core::linear::Columns;
use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::tools::{
    color_regions, diffusion_curves, DiffusionCurves, DiffusionCurvesOptions, SegmentOptions,
};
use ridgeform_core::Progress;

const PALETTE: [[f64; 3]; 5] =
    [[0.8, 0.1, 0.05], [0.04, 0.18, 0.65], [0.9, 0.7, 0.08], [0.08, 0.42, 0.14], [0.85, 0.85, 0.8]];

fn painted(shape: &Shape, color: impl Fn([f64; 3]) -> [f64; 3]) -> Columns {
    Columns::from_points(&shape.vertices.iter().map(|&p| color(p)).collect::<Vec<_>>()).unwrap()
}

fn regions(shape: &Shape, colors: &Columns, options: SegmentOptions, groups: Option<&[u32]>) -> Vec<i32> {
    let options = SegmentOptions { min_faces: Some(20), ..options };
    color_regions(&shape.mesh().unwrap(), colors, &options, groups, 1e3, &Progress::new()).unwrap()
}

fn curves(shape: &Shape, colors: &Columns, labels: &[i32]) -> DiffusionCurves {
    let options = DiffusionCurvesOptions::default();
    diffusion_curves(&shape.mesh().unwrap(), colors, labels, &options, &Progress::new()).unwrap()
}

fn count(labels: &[i32]) -> i32 {
    labels.iter().max().unwrap() + 1
}

/// The square from -0.5 to 0.5, of irregular triangles.
fn plane(n: usize) -> Shape {
    let size = n as f64;
    shapes::grid(n, n)
        .map(|p| [p[0] / size - 0.5, p[1] / size - 0.5, 0.0])
        .noisy(0.3 / size, 5)
        .map(|p| [p[0], p[1], 0.0])
}

/// A disk; or a hill, a sun that touches it but for a strip of one vertex, a house, and a disk.
fn scene(colors: usize, [x, y, _]: [f64; 3]) -> usize {
    let within = |a: f64, b: f64, radius: f64| (x - a).hypot(y - b) < radius;
    if colors == 2 {
        return usize::from(within(0.0, 0.0, 0.3));
    }
    if within(0.2, -0.2, 0.2) {
        2
    } else if (x + 0.25).abs() < 0.12 && (y + 0.22).abs() < 0.16 {
        3
    } else if within(-0.2, 0.3, 0.13) {
        4
    } else {
        usize::from(y > 0.1 + 0.05 * (6.0 * x).sin())
    }
}

/// Octants in a chequer, or caps around five axes.
fn ball(colors: usize, [x, y, z]: [f64; 3]) -> usize {
    if colors == 2 {
        return usize::from((x > 0.1) ^ (y > -0.2) ^ (z > 0.05));
    }
    [[1.0, 0.2, 0.0], [-0.3, 1.0, 0.1], [0.0, -0.8, 0.7], [0.1, -0.4, -1.0]]
        .iter()
        .position(|axis| axis[0] * x + axis[1] * y + axis[2] * z > 0.75)
        .map_or(0, |i| i + 1)
}

#[test]
fn flat_paint_comes_back_exactly() {
    let sphere = shapes::icosphere(4).noisy(0.01, 3);
    for n_colors in [2, 5] {
        for (shape, region) in [(plane(40), scene as fn(usize, [f64; 3]) -> usize), (sphere.clone(), ball)] {
            let colors = painted(&shape, |p| PALETTE[region(n_colors, p)]);
            let labels = regions(&shape, &colors, SegmentOptions::default(), None);
            let found = curves(&shape, &colors, &labels);
            assert!(found.error < 1e-20, "{n_colors} colors, {} regions: {}", count(&labels), found.error);
            // Every side of a curve has one of the colors, and two sides never have the same.
            for (left, right) in found.curves.left.chunks(3).zip(found.curves.right.chunks(3)) {
                let which = |color: &[f64]| {
                    PALETTE
                        .iter()
                        .position(|other| (0..3).all(|c| (color[c] - other[c]).abs() < 1e-9))
                        .unwrap()
                };
                assert_ne!(which(left), which(right));
            }
        }
    }
}

#[test]
fn shading_needs_no_curves_of_its_own() {
    let shape = plane(48);
    let wave = |[x, y, _]: [f64; 3]| 0.85 + 0.08 * (5.0 * x).sin() + 0.08 * (4.0 * y + 1.0).cos();
    let colors = painted(&shape, |p| PALETTE[scene(5, p)].map(|channel| channel * wave(p)));
    let found = curves(&shape, &colors, &regions(&shape, &colors, SegmentOptions::default(), None));
    assert!(found.error < 1e-4, "{}", found.error);
    let jump =
        |rows: (&[f64], &[f64])| rows.0.iter().zip(rows.1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let rows = found.curves.left.chunks(3).zip(found.curves.right.chunks(3));
    assert!(rows.map(jump).fold(f64::INFINITY, f64::min) > 0.2, "no curve where no color changes");
}

#[test]
fn a_crease_of_the_colors_keeps_its_curve() {
    // Linear on both sides and continuous: without the curve, colors would be flat.
    let shape = plane(40);
    let colors = painted(&shape, |[x, _, _]| [1.0 - 1.6 * x.abs(), 0.5, 0.2 + 1.2 * x.abs()]);
    let labels = regions(&shape, &colors, SegmentOptions::default(), None);
    assert!(count(&labels) >= 2);
    let options = DiffusionCurvesOptions { rims: true, ..DiffusionCurvesOptions::default() };
    let found =
        diffusion_curves(&shape.mesh().unwrap(), &colors, &labels, &options, &Progress::new()).unwrap();
    assert!(found.error < 1e-4, "{}", found.error);
}

#[test]
fn small_patches_and_strips_of_one_vertex_are_kept() {
    // A spot of nine vertices and a strip of single vertices, both left out of the regions.
    let shape = shapes::grid(30, 30);
    let strip = |p: [f64; 3]| (p[0] - p[1]).abs() < 0.5 && p[0] < 22.0;
    let spot = |p: [f64; 3]| (p[0] - 22.0).abs() < 1.2 && (p[1] - 8.0).abs() < 1.2;
    let color = |p| PALETTE[if strip(p) || spot(p) { 1 } else { usize::from(p[0] + p[1] > 44.5) * 2 }];
    let colors = painted(&shape, color);
    let labels = regions(&shape, &colors, SegmentOptions::default(), None);
    assert_eq!(count(&labels), 4);
    assert!(curves(&shape, &colors, &labels).error < 1e-20);
}

#[test]
fn borders_are_short_and_quads_stay_whole() {
    let shape = plane(40);
    let colors = painted(&shape, |p| PALETTE[usize::from(p[0] + 0.3 * p[1] > 0.0)]);
    let length = |labels: &[i32]| {
        let at = |v: u32| shape.vertices[v as usize];
        let edges = curves(&shape, &colors, labels).curves.edges;
        edges
            .iter()
            .map(|&[a, b]| (0..2).map(|c| (at(a)[c] - at(b)[c]).powi(2)).sum::<f64>().sqrt())
            .sum::<f64>()
    };
    let labels = regions(&shape, &colors, SegmentOptions::default(), None);
    let straight = 1.0_f64.hypot(0.3);
    assert!(length(&labels) < 1.3 * straight, "{}", length(&labels));
    let groups: Vec<u32> = (0..shape.faces.len() as u32).map(|f| f / 2).collect();
    let labels = regions(&shape, &colors, SegmentOptions::default(), Some(&groups));
    assert!(labels.chunks(2).all(|pair| pair[0] == pair[1]));
    assert!(curves(&shape, &colors, &labels).error < 1e-20);
    let colors = painted(&shape, |p| PALETTE[scene(5, p)]);
    let asked = SegmentOptions { n_segments: Some(3), ..SegmentOptions::default() };
    assert_eq!(count(&regions(&shape, &colors, asked, None)), 3, "a number that was asked for is kept");
}

/// Colors averaged over the neighbors of each vertex.
fn averaged(shape: &Shape, colors: &Columns) -> Columns {
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); colors.n_rows];
    for face in &shape.faces {
        face.iter().for_each(|&v| around[v as usize].extend(face.iter().filter(|&&u| u != v)));
    }
    let mut averaged = colors.clone();
    for c in 0..colors.n_columns {
        for (x, ring) in averaged.column_mut(c).iter_mut().zip(&mut around) {
            ring.sort_unstable();
            ring.dedup();
            *x = ring.iter().map(|&u| colors.column(c)[u as usize]).sum::<f64>() / ring.len() as f64;
        }
    }
    averaged
}

/// Colors in bands around the ball.
fn bands(n_colors: usize, p: [f64; 3]) -> usize {
    (0.5 * (p[2] + 1.0) * n_colors as f64).clamp(0.0, n_colors as f64 - 1.0) as usize
}

#[test]
fn soft_edges_are_no_regions() {
    let sphere = shapes::icosphere(4).noisy(0.005, 3);
    for (shape, region) in [(plane(40), scene as fn(usize, [f64; 3]) -> usize), (sphere, bands)] {
        for n_colors in [2, 5] {
            let flat = painted(&shape, |p| PALETTE[region(n_colors, p)]);
            let labels = regions(&shape, &flat, SegmentOptions::default(), None);
            let (n_regions, n_curves) = (count(&labels), curves(&shape, &flat, &labels).starts.len());
            for times in [1, 2] {
                let soft = (0..times).fold(flat.clone(), |colors, _| averaged(&shape, &colors));
                let labels = regions(&shape, &soft, SegmentOptions::default(), None);
                let found = curves(&shape, &soft, &labels);
                let (found_curves, decibels) = (found.starts.len(), -10.0 * found.error.log10());
                let case = format!("{n_colors} colors, averaged {times} times");
                assert_eq!(count(&labels), n_regions, "{case}: regions");
                assert_eq!(found_curves, n_curves, "{case}: ends of curves");
                assert!(decibels > 26.0, "{case}: {decibels} dB");
            }
        }
    }
}
