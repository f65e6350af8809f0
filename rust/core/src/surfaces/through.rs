//! Surfaces through points that lie on them to rounding: plain least squares, which no point is dropped from.

use super::constants::{DAMPING, LEAST_THROUGH, THROUGH, UNDETERMINED};
use super::motion::COUNT;
use super::Surface;
use crate::linear::small::solved;
use crate::mesh::vector::{add, distance, scale, sub, Point};

/// The surface of the same kind near `start` that has the least sum of squared distances from `points`, by
/// the method of Levenberg and Marquardt.
#[must_use]
pub fn through(start: &Surface, points: &[Point]) -> Surface {
    let center = scale(points.iter().fold([0.0; 3], |sum, &p| add(sum, p)), 1.0 / points.len().max(1) as f64);
    let size = points.iter().map(|&p| distance(p, center)).fold(f64::MIN_POSITIVE, f64::max);
    let here = |p: Point| scale(sub(p, center), 1.0 / size);
    let cost = |surface: &Surface| points.iter().map(|&p| surface.distance(here(p)).0.powi(2)).sum::<f64>();
    let mut surface = start.placed(1.0 / size, scale(center, -1.0 / size));
    let (mut before, mut damping) = (cost(&surface), 0.0);
    for _ in 0..THROUGH.steps {
        let mut matrix = vec![vec![0.0; COUNT]; COUNT];
        let mut right = [0.0; COUNT];
        for &p in points {
            let (off, row) = surface.derivatives(here(p));
            for i in 0..COUNT {
                right[i] -= off * row[i];
                (0..COUNT).for_each(|j| matrix[i][j] += row[i] * row[j]);
            }
        }
        let mut step = [0.0; COUNT];
        step.copy_from_slice(&solved(matrix, &right, UNDETERMINED, damping));
        let next = surface.moved(&step);
        let after = cost(&next);
        if after.is_nan() || after >= before {
            if damping > DAMPING[0] {
                break;
            }
            damping = (10.0 * damping).max(LEAST_THROUGH);
            continue;
        }
        let gained = before - after;
        (surface, before) = (next, after);
        damping *= 0.1;
        if gained <= THROUGH.rest * after || after <= UNDETERMINED * UNDETERMINED {
            break;
        }
    }
    surface.placed(size, center)
}
