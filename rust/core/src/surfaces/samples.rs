//! Points with normals, to which surfaces are fitted, and what their distances cost.

use super::constants::{ENOUGH, MOST_MISFIT};
use super::Surface;
use crate::error::SolveError;
use crate::memory;
use crate::mesh::vector::{add, dot, scale, sub, Point};

/// Points with normals, to which surfaces are fitted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    /// The points.
    pub points: Vec<Point>,
    /// Unit normals there, zero where none is known; only starts are made of them.
    pub normals: Vec<Point>,
    /// How much each counts, 1 for a whole observation.
    pub weights: Vec<f64>,
}

/// What a point at this distance costs where the noise has standard deviation `sigma`: half the square of
/// their ratio, the negative logarithm of the likelihood, and no more than [`MOST_MISFIT`].
#[must_use]
pub fn misfit(distance: f64, sigma: f64) -> f64 {
    let ratio = distance / sigma;
    (0.5 * ratio * ratio).min(MOST_MISFIT)
}

impl Samples {
    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// How many whole observations they are.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// Adds a point.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give that much.
    pub fn push(&mut self, point: Point, normal: Point, weight: f64) -> Result<(), SolveError> {
        memory::push(&mut self.points, point)?;
        memory::push(&mut self.normals, normal)?;
        memory::push(&mut self.weights, weight)
    }

    /// Every k-th point so that at most `most` are left, with the others' weight.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn thinned(&self, most: usize) -> Result<Self, SolveError> {
        let step = self.len().div_ceil(most.max(1)).max(1);
        if step == 1 {
            return Ok(Self {
                points: memory::twin(&self.points)?,
                normals: memory::twin(&self.normals)?,
                weights: memory::twin(&self.weights)?,
            });
        }
        let mut thin = Self::default();
        for i in (0..self.len()).step_by(step) {
            thin.push(self.points[i], self.normals[i], self.weights[i])?;
        }
        let factor = self.total() / thin.total().max(f64::MIN_POSITIVE);
        thin.weights.iter_mut().for_each(|w| *w *= factor);
        Ok(thin)
    }

    /// What the points cost on a surface.
    #[must_use]
    pub fn cost(&self, surface: &Surface, sigma: f64) -> f64 {
        let each = self.points.iter().zip(&self.weights);
        each.map(|(&p, w)| w * misfit(surface.distance(p).0, sigma)).sum()
    }

    /// The root mean square distance of the points from a surface.
    #[must_use]
    pub fn rms(&self, surface: &Surface) -> f64 {
        let each = self.points.iter().zip(&self.weights);
        let sum: f64 = each.map(|(&p, w)| w * surface.distance(p).0.powi(2)).sum();
        (sum / self.total().max(f64::MIN_POSITIVE)).sqrt()
    }

    /// 1 where the samples' normals point to where the surface's distance grows, −1 where to the other side.
    #[must_use]
    pub fn side(&self, surface: &Surface) -> f64 {
        let each = self.points.iter().zip(&self.normals).zip(&self.weights);
        let sum: f64 = each.map(|((&p, &n), w)| w * dot(surface.distance(p).1, n)).sum();
        if sum < 0.0 {
            -1.0
        } else {
            1.0
        }
    }

    /// The same about their center, in the unit of their size; with both.
    ///
    /// # Errors
    /// [`SolveError::Memory`], here and below.
    pub(super) fn normalized(&self) -> Result<Option<(Self, Point, f64)>, SolveError> {
        let total = self.total();
        if total.is_nan() || total <= 0.0 {
            return Ok(None);
        }
        let each = || self.points.iter().zip(&self.weights);
        let center = scale(each().fold([0.0; 3], |sum, (&p, &w)| add(sum, scale(p, w))), 1.0 / total);
        let square: f64 = each().map(|(&p, w)| w * dot(sub(p, center), sub(p, center))).sum();
        let size = (square / total).sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return Ok(None);
        }
        let points = memory::gathered(self.points.iter().map(|&p| scale(sub(p, center), 1.0 / size)))?;
        let (normals, weights) = (memory::twin(&self.normals)?, memory::twin(&self.weights)?);
        Ok(Some((Self { points, normals, weights }, center, size)))
    }

    /// The median distance from a surface, of so many points that it is good enough for choosing and scaling.
    pub(super) fn spread(&self, surface: &Surface) -> f64 {
        let step = self.len().div_ceil(ENOUGH).max(1);
        let mut distances: Vec<f64> =
            self.points.iter().step_by(step).map(|&p| surface.distance(p).0.abs()).collect();
        let middle = distances.len() / 2;
        *distances.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}
