//! How a part of the surface around a hole goes on: as a plane, or as a quadratic height over one.

use super::constants::{AS_GOOD, BENT_STIFFNESS, FLAT};
use crate::mesh::vector::{add, dot, scale, sub, Point};
use crate::tools::heights::{Frame, LeastSquares, TERMS};

/// A surface that goes on as the points do that it was fitted to.
#[derive(Debug, Clone)]
pub(super) struct Model {
    frame: Frame,
    coefficients: [f64; TERMS],
    /// Whether it is a plane.
    pub is_flat: bool,
    /// Root mean square of what it misses the points by.
    pub misfit: f64,
}

impl Model {
    /// The fit to weighted points of a surface that looks along the unit `normal`, where edges are about
    /// `edge` long; nothing where there are fewer than three points with weight.
    pub(super) fn fit(points: &[(Point, f64)], normal: Point, edge: f64) -> Option<Self> {
        let total: f64 = points.iter().map(|(_, weight)| weight).sum();
        if points.len() < 3 || total <= 0.0 {
            return None;
        }
        let origin = points.iter().fold([0.0; 3], |sum, &(p, weight)| add(sum, scale(p, weight / total)));
        let spread: f64 =
            points.iter().map(|&(p, weight)| weight / total * dot(sub(p, origin), sub(p, origin))).sum();
        let mut flat = Self {
            frame: Frame::new(origin, normal, spread.sqrt().max(f64::MIN_POSITIVE)),
            coefficients: [0.0; TERMS],
            is_flat: true,
            misfit: 0.0,
        };
        flat.solve(points, total, 1e12);
        // Heights are measured along the normal of the plane that the first fit found.
        flat.frame = Frame::new(origin, flat.at(origin).1, flat.frame.scale);
        flat.solve(points, total, 1e12);
        let mut bent = Self { is_flat: false, ..flat.clone() };
        bent.solve(points, total, BENT_STIFFNESS);
        let is_flat = points.len() <= TERMS || flat.misfit <= (FLAT * edge).max(AS_GOOD * bent.misfit);
        Some(if is_flat { flat } else { bent })
    }

    fn solve(&mut self, points: &[(Point, f64)], total: f64, stiffness: f64) {
        let mut squares = LeastSquares::new(1);
        for &(p, weight) in points {
            let (terms, height) = self.frame.terms(p);
            squares.add(weight / total, &terms, |_| height);
        }
        self.coefficients = squares.solve(1e-12, stiffness)[0];
        if self.is_flat {
            self.coefficients[3..].fill(0.0);
        }
        let squares: f64 = points.iter().map(|&(p, weight)| weight / total * self.at(p).0.powi(2)).sum();
        self.misfit = squares.sqrt();
    }

    /// The signed distance of `p`, to first order, and the unit normal of the surface there.
    pub(super) fn at(&self, p: Point) -> (f64, Point) {
        (self.frame.distance(&self.coefficients, p), self.frame.normal(&self.coefficients, p))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::vector::unit;
    use crate::shapes::Random;
    use crate::tools::heights::axes_along as frame;

    /// Points of a height over a plane, which lies askew.
    fn points(height: impl Fn(f64, f64) -> f64) -> Vec<(Point, f64)> {
        let [s, t, n] = frame(unit([1.0, 2.0, -0.5]));
        let mut random = Random::new(7);
        (0..200)
            .map(|_| {
                let (x, y) = (random.symmetric(), random.symmetric());
                let p = add(add(scale(s, x), scale(t, y)), scale(n, height(x, y)));
                (add(p, [3.0, 1.0, 2.0]), 1.0 + random.uniform())
            })
            .collect()
    }

    #[test]
    fn a_plane_is_found_exactly_from_a_normal_that_is_off() {
        let model = Model::fit(&points(|_, _| 0.0), unit([1.2, 2.0, -0.2]), 0.1).unwrap();
        assert!(model.is_flat && model.misfit < 1e-12, "{model:?}");
        let (off, normal) = model.at(add([3.0, 1.0, 2.0], scale(unit([1.0, 2.0, -0.5]), 0.7)));
        assert!((off - 0.7).abs() < 1e-12);
        assert!(dot(normal, unit([1.0, 2.0, -0.5])) > 1.0 - 1e-12);
    }

    #[test]
    fn noise_is_no_curvature() {
        let random = std::cell::RefCell::new(Random::new(3));
        let model =
            Model::fit(&points(|_, _| 0.03 * random.borrow_mut().symmetric()), unit([1.0, 2.0, -0.5]), 0.1);
        assert!(model.unwrap().is_flat);
    }

    #[test]
    fn a_bent_surface_goes_on_bent() {
        let model =
            Model::fit(&points(|x, y| 0.3 * x * x - 0.1 * x * y), unit([1.0, 2.0, -0.5]), 0.1).unwrap();
        assert!(!model.is_flat && model.misfit < 1e-3, "{model:?}");
        assert!(points(|x, y| 0.3 * x * x - 0.1 * x * y).iter().all(|&(p, _)| model.at(p).0.abs() < 3e-3));
    }

    #[test]
    fn two_points_are_no_surface() {
        assert!(Model::fit(&points(|_, _| 0.0)[..2], [0.0, 0.0, 1.0], 0.1).is_none());
    }
}
