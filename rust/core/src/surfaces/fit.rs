//! The surface of a kind that fits points best: robust least squares by the method of Levenberg and
//! Marquardt.

use super::constants::{DAMPING, FIT, FOLLOWED, LARGEST, LEAST_DAMPING, QUARTILE, TAIL, UNDETERMINED};
use super::motion::COUNT;
use super::samples::Samples;
use super::starts::starts;
use super::{Kind, Surface};
use crate::error::SolveError;
use crate::linear::small::solved;
use crate::mesh::vector::{norm, scale};

/// A fitted surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedSurface {
    /// The surface.
    pub surface: Surface,
    /// The sum of all points' [`misfit`]s.
    pub cost: f64,
}

/// The surface of a `kind` with the least sum of [`misfit`]s to `samples`, whose noise has standard deviation
/// `sigma` along the normal. `None` where the points determine none.
///
/// Distances, not algebraic residuals, are minimized: radii have no bias to speak of. Several starts are made
/// of points and normals, the best followed with weights of Geman and McClure, whose scale falls from what
/// the start leaves to the noise.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub fn fit(kind: Kind, samples: &Samples, sigma: f64) -> Result<Option<FittedSurface>, SolveError> {
    let Some((here, center, size)) = samples.normalized()? else { return Ok(None) };
    let sigma = sigma / size;
    let mut begun: Vec<(f64, Surface)> = starts(kind, &here)?
        .into_iter()
        .filter(is_sound)
        .map(|surface| (here.spread(&surface), surface))
        .filter(|(spread, _)| spread.is_finite())
        .collect();
    begun.sort_by(|a, b| a.0.total_cmp(&b.0));
    begun.truncate(FOLLOWED);
    let ends = begun.into_iter().map(|(_, start)| refined(start, &here, sigma)).filter(|(s, _)| is_sound(s));
    let best = ends.min_by(|a, b| a.1.total_cmp(&b.1));
    Ok(best.map(|(surface, cost)| FittedSurface { surface: surface.placed(size, center), cost }))
}

/// The same from one start: a surface of the same kind.
///
/// # Errors
/// [`SolveError::Memory`].
pub fn refit(start: &Surface, samples: &Samples, sigma: f64) -> Result<Option<FittedSurface>, SolveError> {
    let Some((here, center, size)) = samples.normalized()? else { return Ok(None) };
    let (surface, cost) = refined(start.placed(1.0 / size, scale(center, -1.0 / size)), &here, sigma / size);
    Ok(is_sound(&surface).then(|| FittedSurface { surface: surface.placed(size, center), cost }))
}

fn is_sound(surface: &Surface) -> bool {
    let radii = match *surface {
        Surface::Plane { .. } => [0.0, 0.0],
        Surface::Sphere { radius, .. } | Surface::Cylinder { radius, .. } | Surface::Cone { radius, .. } => {
            [radius, 0.0]
        }
        // Spindle tori meet themselves.
        Surface::Torus { major, minor, .. } if minor > major => return false,
        Surface::Torus { major, minor, .. } => [major, minor],
    };
    surface.is_finite() && radii.iter().all(|r| r.abs() <= LARGEST)
}

/// A surface refined from a start, and what it costs.
fn refined(start: Surface, samples: &Samples, sigma: f64) -> (Surface, f64) {
    let (mut surface, mut damping) = (start, DAMPING[0]);
    let (mut best, mut least) = (start, samples.cost(&start, sigma));
    let mut width = (samples.spread(&start) / QUARTILE).max(sigma);
    let mut before = soft_cost(samples, &surface, width);
    for _ in 0..FIT.steps {
        let (matrix, right) = normal_equations(samples, &surface, width);
        let step = damped(&matrix, &right, damping);
        let next = surface.moved(&step);
        let after = soft_cost(samples, &next, width);
        if after.is_nan() || after > before {
            damping *= 10.0;
            if damping > DAMPING[1] {
                break;
            }
            continue;
        }
        let gained = before - after;
        surface = next;
        damping = (damping * 0.1).max(LEAST_DAMPING);
        let cost = samples.cost(&surface, sigma);
        if cost < least {
            (best, least) = (surface, cost);
        }
        let narrower = (samples.spread(&surface) / QUARTILE).clamp(sigma, width);
        let is_still = gained <= FIT.rest * after && narrower >= 0.9 * width;
        if is_still && (width <= sigma || narrower > 0.999 * width) {
            break;
        }
        width = narrower;
        before = soft_cost(samples, &surface, width);
    }
    (best, least)
}

fn soft_cost(samples: &Samples, surface: &Surface, width: f64) -> f64 {
    let reach = (TAIL * width).powi(2);
    let each = samples.points.iter().zip(&samples.weights);
    each.map(|(&p, w)| {
        let square = surface.distance(p).0.powi(2);
        w * square / (1.0 + square / reach)
    })
    .sum()
}

type Matrix = [[f64; COUNT]; COUNT];

fn normal_equations(samples: &Samples, surface: &Surface, width: f64) -> (Matrix, [f64; COUNT]) {
    let reach = (TAIL * width).powi(2);
    let (mut matrix, mut right) = ([[0.0; COUNT]; COUNT], [0.0; COUNT]);
    for (&p, &w) in samples.points.iter().zip(&samples.weights) {
        let (distance, row) = surface.derivatives(p);
        let weight = w / (1.0 + distance * distance / reach).powi(2);
        for i in 0..COUNT {
            right[i] -= weight * distance * row[i];
            for j in 0..=i {
                matrix[i][j] += weight * row[i] * row[j];
            }
        }
    }
    let lower = matrix;
    for (i, row) in matrix.iter_mut().enumerate() {
        row.iter_mut().enumerate().skip(i + 1).for_each(|(j, entry)| *entry = lower[j][i]);
    }
    (matrix, right)
}

/// The step that the equations ask for; what they leave open, as turning a sphere, is not done.
fn damped(matrix: &Matrix, right: &[f64; COUNT], damping: f64) -> [f64; COUNT] {
    let rows = matrix.iter().map(|row| row.to_vec()).collect();
    let mut step = [0.0; COUNT];
    step.copy_from_slice(&solved(rows, right, UNDETERMINED, damping));
    // No turn of more than half a radian at once, nor a shift of more than the size.
    let most =
        norm([step[3], step[4], step[5]]).max(step[7].abs()).max(0.5 * norm([step[0], step[1], step[2]]))
            / 0.5;
    if most > 1.0 {
        step.iter_mut().for_each(|s| *s /= most);
    }
    step
}
