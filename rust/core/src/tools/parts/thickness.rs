//! How thick the shape is under each face: the shape diameter (Shapira et al. 2008), the median length of
//! rays into the shape within a cone around the normal.
//!
//! What is closed has an inside of its own: rays there pass through all other pieces. Where an arm is stuck
//! into a body, the body is as thick as elsewhere.

use rayon::prelude::*;

use super::constants::{LEAST_COSINE, LEAST_RAYS, RAYS, RAY_START, SAMPLES, UNSEEN};
use super::diffusion::{diffused, Link};
use super::graph::NONE;
use super::surface::Surface;
use crate::memory;
use crate::mesh::vector::{add, cross, dot, scale, unit, Point};
use crate::progress::Progress;
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// The logarithm of the thickness under each face, smoothed over `length`, given unit `normals`; 0 where
/// it is known nowhere.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn thickness(
    surface: &Surface,
    normals: &[Point],
    links: &[Link],
    length: f64,
    progress: &Progress,
) -> Result<Vec<f64>> {
    let tree = ClosestPoint::new(memory::twin(&surface.triangles)?)?;
    let closed = surface.closed_pieces()?;
    let samples = sampled(&surface.areas)?;
    let found = samples.par_iter().map(|&f| {
        progress.check()?;
        let own = closed[f as usize];
        let first = |from: Point, along: Point| {
            let is_met = |t: u32| own == NONE || closed[t as usize] == own;
            let (length, t) = tree.first_hit(from, along, RAY_START, is_met)?;
            (dot(surface.normals[t as usize], along) > 0.0).then_some(length)
        };
        Ok((f, diameter(surface.centers[f as usize], normals[f as usize], first)))
    });
    let found: Vec<(u32, Option<f64>)> = memory::all(memory::joined(found)?)?;
    let known = memory::sifted(found.into_iter().filter_map(|(f, d)| d.map(|d| (f, d.ln()))))?;
    if known.is_empty() {
        return Ok(memory::repeated(0.0, surface.n_faces())?);
    }
    // Around their mean, so that faces far from all that is known take that.
    let mean = known.iter().map(|(_, d)| d).sum::<f64>() / known.len() as f64;
    let mut masses = memory::gathered(surface.areas.iter().map(|area| UNSEEN * area))?;
    let mut right = memory::repeated([0.0], surface.n_faces())?;
    for (f, logarithm) in known {
        let mass = surface.areas[f as usize].max(1.0 / samples.len() as f64);
        masses[f as usize] = mass;
        right[f as usize] = [mass * (logarithm - mean)];
    }
    let smooth = diffused(&masses, links, length, right)?;
    Ok(memory::gathered(smooth.into_iter().map(|[x]| mean + x))?)
}

/// Faces at equal steps of area, or all where there are few.
fn sampled(areas: &[f64]) -> Result<Vec<u32>> {
    if areas.len() <= SAMPLES {
        return Ok(memory::sifted(0..areas.len() as u32)?);
    }
    let step = areas.iter().sum::<f64>() / SAMPLES as f64;
    let mut passed = 0.0;
    let steps = |(f, area): (u32, &f64)| {
        let before = (passed / step) as usize;
        passed += area;
        ((passed / step) as usize > before).then_some(f)
    };
    Ok(memory::sifted((0..).zip(areas).filter_map(steps))?)
}

/// The median length of rays from `from` against `normal`, given how far a ray goes where it leaves.
fn diameter(from: Point, normal: Point, leaves: impl Fn(Point, Point) -> Option<f64>) -> Option<f64> {
    let side = if normal[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let first = unit(cross(normal, side));
    let second = cross(normal, first);
    // Equal steps of height and of the golden angle spread points evenly over a cap of the sphere (Vogel
    // 1979).
    let golden = std::f64::consts::PI * (1.0 + 5.0_f64.sqrt());
    let ray = |i: usize| {
        let step = i as f64 + 0.5;
        let cosine = 1.0 - step / RAYS as f64 * (1.0 - LEAST_COSINE);
        let sine = (1.0 - cosine * cosine).sqrt();
        let (s, c) = (golden * step).sin_cos();
        let around = add(scale(first, c * sine), scale(second, s * sine));
        let along = add(scale(normal, -cosine), around);
        leaves(from, along)
    };
    let mut lengths: Vec<f64> = (0..RAYS).filter_map(ray).collect();
    if (lengths.len() as f64) < LEAST_RAYS * RAYS as f64 {
        return None;
    }
    lengths.sort_by(f64::total_cmp);
    Some(lengths[lengths.len() / 2])
}
