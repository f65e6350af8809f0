//! Surfaces made parallel, orthogonal and equal where they nearly are, as parts are made.

use super::constants::{SHIFTS, TURNS, UNDETERMINED};
use crate::labelling::{Domain, Labelling};
use crate::linear::small::{determined, Quadric};
use crate::mesh::vector::{add, cross, dot, norm, scale, sub, unit, Point};
use crate::surfaces::{Samples, Surface};
use crate::Result;

/// Directions of surfaces, joined where they are parallel.
struct Direction {
    axis: Point,
    weight: f64,
    pieces: Vec<usize>,
}

/// Makes directions parallel and orthogonal that are so up to `tolerance` radians, and radii equal that
/// differ by no more than that part; offsets and centers are fitted again. Returns what was done, in words.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn regularize(domain: &Domain<'_>, state: &mut Labelling, tolerance: f64) -> Result<Vec<String>> {
    let mut said = Vec::new();
    let mut directions = parallel(state, tolerance);
    let joined = directions.iter().map(|d| d.pieces.len().saturating_sub(1)).sum::<usize>();
    if joined > 0 {
        said.push(format!("{joined} directions made parallel"));
    }
    let n = orthogonal(&mut directions, tolerance);
    if n > 0 {
        said.push(format!("{n} pairs of directions made orthogonal"));
    }
    for direction in &directions {
        for &k in &direction.pieces {
            let samples = domain.samples(&state.pieces[k].faces)?;
            if let Some(surface) = &mut state.pieces[k].surface {
                *surface = aligned(surface, direction.axis, &samples);
            }
        }
    }
    let n = equal_radii(state, tolerance);
    if n > 0 {
        said.push(format!("{n} radii made equal"));
    }
    for piece in &mut state.pieces {
        if let Some(surface) = &piece.surface {
            piece.rms = domain.samples(&piece.faces)?.rms(surface);
        }
    }
    Ok(said)
}

/// The directions of all surfaces, the heaviest first, those that are nearly parallel as one.
fn parallel(state: &Labelling, tolerance: f64) -> Vec<Direction> {
    let mut all: Vec<(usize, Point, f64)> = Vec::new();
    for (k, piece) in state.pieces.iter().enumerate() {
        if let Some(axis) = piece.surface.and_then(|surface| surface.direction()) {
            all.push((k, axis, piece.faces.len() as f64));
        }
    }
    all.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
    let mut directions: Vec<Direction> = Vec::new();
    for (k, axis, weight) in all {
        let cosine = tolerance.cos();
        match directions.iter_mut().find(|d| dot(d.axis, axis).abs() >= cosine) {
            Some(direction) => {
                let along = if dot(direction.axis, axis) < 0.0 { -1.0 } else { 1.0 };
                direction.axis =
                    unit(add(scale(direction.axis, direction.weight), scale(axis, along * weight)));
                direction.weight += weight;
                direction.pieces.push(k);
            }
            None => directions.push(Direction { axis, weight, pieces: vec![k] }),
        }
    }
    directions
}

/// Makes directions orthogonal: frames of three or two first, as near to all of them as can be, then what is
/// orthogonal to a direction of a frame. Returns how many pairs are.
fn orthogonal(directions: &mut [Direction], tolerance: f64) -> usize {
    let is_right = |a: Point, b: Point| dot(a, b).abs() <= tolerance.sin();
    let mut done: Vec<usize> = Vec::new();
    let mut pairs = 0;
    for first in 0..directions.len() {
        if done.contains(&first) {
            continue;
        }
        let mut frame = vec![first];
        for k in first + 1..directions.len() {
            let fits = frame.iter().all(|&j| is_right(directions[j].axis, directions[k].axis));
            if frame.len() < 3 && !done.contains(&k) && fits {
                frame.push(k);
            }
        }
        // What was made orthogonal before stays: this frame's first direction gives way.
        let held: Vec<Point> = done
            .iter()
            .map(|&j| directions[j].axis)
            .filter(|&a| is_right(a, directions[first].axis))
            .collect();
        if held.is_empty() && frame.len() > 1 {
            let axes: Vec<(Point, f64)> =
                frame.iter().map(|&k| (directions[k].axis, directions[k].weight)).collect();
            let new = nearest_frame(&axes);
            frame.iter().zip(new).for_each(|(&k, axis)| directions[k].axis = axis);
            pairs += frame.len() * (frame.len() - 1) / 2;
            done.extend(frame);
        } else if !held.is_empty() {
            let axis =
                held.iter().take(2).fold(directions[first].axis, |a, &h| unit(sub(a, scale(h, dot(a, h)))));
            if norm(axis) > 0.5 {
                directions[first].axis = axis;
                pairs += held.len().min(2);
            }
            done.push(first);
        } else {
            done.push(first);
        }
    }
    pairs
}

/// The orthonormal vectors nearest to two or three nearly orthogonal ones by weighted squares (Horn 1987, by
/// small turns).
fn nearest_frame(axes: &[(Point, f64)]) -> Vec<Point> {
    let mut frame: Vec<Point> = Vec::new();
    for (axis, _) in axes {
        frame.push(unit(frame.iter().fold(*axis, |a, &f: &Point| sub(a, scale(f, dot(a, f))))));
    }
    for _ in 0..TURNS.steps {
        // The turn ω that takes the frame to the axes: Σ w (I − f fᵀ) ω = Σ w f × a.
        let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        for (f, (a, w)) in frame.iter().zip(axes) {
            right = add(right, scale(cross(*f, *a), *w));
            for i in 0..3 {
                (0..3).for_each(|j| matrix[i][j] += w * (f64::from(u8::from(i == j)) - f[i] * f[j]));
            }
        }
        let turn = determined(matrix, right, 0.0);
        let turned: Vec<Point> = frame.iter().map(|&f| add(f, cross(turn, f))).collect();
        frame.clear();
        for axis in turned {
            frame.push(unit(frame.iter().fold(axis, |a, &f: &Point| sub(a, scale(f, dot(a, f))))));
        }
        if norm(turn) < TURNS.rest {
            break;
        }
    }
    frame
}

/// The surface with another direction, its offset or its center and radius fitted again.
fn aligned(surface: &Surface, axis: Point, samples: &Samples) -> Surface {
    let total = samples.total();
    let each = || samples.points.iter().zip(&samples.weights);
    let mean = |value: &dyn Fn(Point) -> f64| each().map(|(&p, w)| w * value(p)).sum::<f64>() / total;
    let toward = |old: Point| if dot(old, axis) < 0.0 { scale(axis, -1.0) } else { axis };
    match *surface {
        Surface::Plane { normal, .. } => {
            let normal = toward(normal);
            Surface::Plane { normal, offset: mean(&|p| dot(p, normal)) }
        }
        Surface::Cylinder { point, axis: old, radius } => {
            let axis = toward(old);
            slid(Surface::Cylinder { point, axis, radius }, samples)
        }
        Surface::Cone { point, axis: old, radius, slope } => {
            slid(Surface::Cone { point, axis: toward(old), radius, slope }, samples)
        }
        Surface::Torus { center, axis: old, major, minor } => {
            slid(Surface::Torus { center, axis: toward(old), major, minor }, samples)
        }
        sphere @ Surface::Sphere { .. } => sphere,
    }
}

/// The surface shifted to where its points are, without turning.
fn slid(mut surface: Surface, samples: &Samples) -> Surface {
    for _ in 0..SHIFTS.steps {
        let mut planes = Quadric::default();
        for (&p, &w) in samples.points.iter().zip(&samples.weights) {
            let (distance, normal) = surface.distance(p);
            planes.add(w, normal, distance);
        }
        let shift = planes.nearest(UNDETERMINED);
        surface = surface.placed(1.0, shift);
        if norm(shift) < SHIFTS.rest {
            break;
        }
    }
    surface
}

/// Radii of cylinders and spheres, weighted by faces, made equal where they differ by less than that part.
/// Returns how many.
fn equal_radii(state: &mut Labelling, tolerance: f64) -> usize {
    let mut radii: Vec<(f64, f64, usize)> = Vec::new();
    for (k, piece) in state.pieces.iter().enumerate() {
        if let Some(Surface::Cylinder { radius, .. } | Surface::Sphere { radius, .. }) = piece.surface {
            radii.push((radius, piece.faces.len() as f64, k));
        }
    }
    radii.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let mut count = 0;
    for group in radii.chunk_by(|a, b| b.0 - a.0 <= tolerance * a.0).filter(|group| group.len() > 1) {
        let total: f64 = group.iter().map(|(_, w, _)| w).sum();
        let mean = group.iter().map(|(r, w, _)| r * w).sum::<f64>() / total;
        for &(_, _, k) in group {
            if let Some(Surface::Cylinder { radius, .. } | Surface::Sphere { radius, .. }) =
                &mut state.pieces[k].surface
            {
                *radius = mean;
                count += 1;
            }
        }
    }
    count
}
