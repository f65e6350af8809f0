//! The surface of a kind that fits points best: robust least squares by the method of Levenberg and
//! Marquardt.

use super::motion::COUNT;
use super::starts::starts;
use super::{Kind, Surface};
use crate::linear::small::symmetric_eigen;
use crate::mesh::vector::{add, dot, norm, scale, sub, Point};

/// The most that one point's misfit counts: noise is off by more than 3.5 standard deviations once in two
/// thousand points, and what is off by more belongs to something else.
pub const MOST_MISFIT: f64 = 6.0;

/// Steps at most; fits settle after five to fifteen.
const MOST_STEPS: usize = 30;

/// Starts that are followed to the end, the best of some twenty: the median distance that ranks them is blind
/// to which of two close ones has the better end.
const FOLLOWED: usize = 3;

/// A step that lowers the cost by less than this part of it is the last.
const SETTLED: f64 = 1e-10;

/// No radius is larger than this many times the size of what is fitted: beyond,
/// the surface is a plane as far as doubles tell.
const LARGEST: f64 = 1e4;

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

/// A fitted surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// The surface.
    pub surface: Surface,
    /// The sum of all points' [`misfit`]s.
    pub cost: f64,
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
    pub fn push(&mut self, point: Point, normal: Point, weight: f64) {
        self.points.push(point);
        self.normals.push(normal);
        self.weights.push(weight);
    }

    /// Every k-th point so that at most `most` are left, with the others' weight.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        let step = self.len().div_ceil(most.max(1)).max(1);
        if step == 1 {
            return self.clone();
        }
        let mut thin = Self::default();
        for i in (0..self.len()).step_by(step) {
            thin.push(self.points[i], self.normals[i], self.weights[i]);
        }
        let factor = self.total() / thin.total().max(f64::MIN_POSITIVE);
        thin.weights.iter_mut().for_each(|w| *w *= factor);
        thin
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
    fn normalized(&self) -> Option<(Self, Point, f64)> {
        let total = self.total();
        if total.is_nan() || total <= 0.0 {
            return None;
        }
        let each = || self.points.iter().zip(&self.weights);
        let center = scale(each().fold([0.0; 3], |sum, (&p, &w)| add(sum, scale(p, w))), 1.0 / total);
        let square: f64 = each().map(|(&p, w)| w * dot(sub(p, center), sub(p, center))).sum();
        let size = (square / total).sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let points = self.points.iter().map(|&p| scale(sub(p, center), 1.0 / size)).collect();
        Some((Self { points, normals: self.normals.clone(), weights: self.weights.clone() }, center, size))
    }
}

/// The surface of a `kind` with the least sum of [`misfit`]s to `samples`, whose noise has standard deviation
/// `sigma` along the normal. `None` where the points determine none.
///
/// Distances, not algebraic residuals, are minimized: radii have no bias to speak of. Several starts are made
/// of points and normals, the best followed with weights of Geman and McClure, whose scale falls from what
/// the start leaves to the noise.
#[must_use]
pub fn fit(kind: Kind, samples: &Samples, sigma: f64) -> Option<Fit> {
    let (here, center, size) = samples.normalized()?;
    let sigma = sigma / size;
    let mut begun: Vec<(f64, Surface)> = starts(kind, &here)
        .into_iter()
        .filter(is_sound)
        .map(|surface| (here.spread(&surface), surface))
        .filter(|(spread, _)| spread.is_finite())
        .collect();
    begun.sort_by(|a, b| a.0.total_cmp(&b.0));
    begun.truncate(FOLLOWED);
    let ends = begun.into_iter().map(|(_, start)| refined(start, &here, sigma)).filter(|(s, _)| is_sound(s));
    let (surface, cost) = ends.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Fit { surface: surface.placed(size, center), cost })
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

impl Samples {
    /// The median distance from a surface, of so many points that it is good enough for choosing and scaling.
    fn spread(&self, surface: &Surface) -> f64 {
        const ENOUGH: usize = 400;
        let step = self.len().div_ceil(ENOUGH).max(1);
        let mut distances: Vec<f64> =
            self.points.iter().step_by(step).map(|&p| surface.distance(p).0.abs()).collect();
        let middle = distances.len() / 2;
        *distances.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// A surface refined from a start, and what it costs.
fn refined(start: Surface, samples: &Samples, sigma: f64) -> (Surface, f64) {
    let (mut surface, mut damping) = (start, 1e-4);
    let (mut best, mut least) = (start, samples.cost(&start, sigma));
    // A normal distribution has its median distance at 0.674 standard deviations.
    let mut width = (samples.spread(&start) / 0.674).max(sigma);
    let mut before = soft_cost(samples, &surface, width);
    for _ in 0..MOST_STEPS {
        let (matrix, right) = normal_equations(samples, &surface, width);
        let step = damped(&matrix, &right, damping);
        let next = surface.moved(&step);
        let after = soft_cost(samples, &next, width);
        if after.is_nan() || after > before {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
            continue;
        }
        let gained = before - after;
        surface = next;
        damping = (damping * 0.1).max(1e-12);
        let cost = samples.cost(&surface, sigma);
        if cost < least {
            (best, least) = (surface, cost);
        }
        let narrower = (samples.spread(&surface) / 0.674).clamp(sigma, width);
        let is_still = gained <= SETTLED * after && narrower >= 0.9 * width;
        if is_still && (width <= sigma || narrower > 0.999 * width) {
            break;
        }
        width = narrower;
        before = soft_cost(samples, &surface, width);
    }
    (best, least)
}

/// Where the weights of Geman and McClure have fallen to a quarter, in standard deviations: as far as
/// [`MOST_MISFIT`] reaches.
const TAIL: f64 = 3.5;

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
    let (values, vectors) = symmetric_eigen(matrix.iter().map(|row| row.to_vec()).collect());
    let largest = values.last().copied().unwrap_or(0.0);
    let mut step = [0.0; COUNT];
    for (value, vector) in values.iter().zip(&vectors) {
        if *value <= 1e-13 * largest {
            continue;
        }
        let along: f64 = vector.iter().zip(right).map(|(v, r)| v * r).sum();
        let length = along / (value + damping * largest);
        step.iter_mut().zip(vector).for_each(|(s, v)| *s += length * v);
    }
    // No turn of more than half a radian at once, nor a shift of more than the size.
    let most =
        norm([step[3], step[4], step[5]]).max(step[7].abs()).max(0.5 * norm([step[0], step[1], step[2]]))
            / 0.5;
    if most > 1.0 {
        step.iter_mut().for_each(|s| *s /= most);
    }
    step
}
