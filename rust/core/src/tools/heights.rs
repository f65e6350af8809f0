//! Heights over a plane that are quadratic in the other two coordinates: how surfaces, and values on them,
//! go on nearby.

use crate::mesh::vector::{add, cross, dot, scale, sub, unit, Point};

/// Coefficients of `1, s, t, s², st, t²`.
pub(crate) const TERMS: usize = 6;

/// Coordinates over a plane, in units of a size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub origin: Point,
    /// Two unit vectors in the plane, and its normal.
    pub axes: [Point; 3],
    pub scale: f64,
}

impl Frame {
    /// The plane through `origin` with the unit `normal`.
    pub(crate) fn new(origin: Point, normal: Point, scale: f64) -> Self {
        Self { origin, axes: axes_along(normal), scale }
    }

    /// What the coefficients multiply at `p`, and its height.
    pub(crate) fn terms(&self, p: Point) -> ([f64; TERMS], f64) {
        let d = sub(p, self.origin);
        let [s, t, height] = self.axes.map(|axis| dot(axis, d) / self.scale);
        ([1.0, s, t, s * s, s * t, t * t], height)
    }

    /// The signed distance of `p` from the surface with the height `c`, to first order.
    pub(crate) fn distance(&self, c: &[f64; TERMS], p: Point) -> f64 {
        let (terms, height) = self.terms(p);
        let [s, t] = slope(c, &terms);
        self.scale * (height - value(c, &terms)) / (1.0 + s * s + t * t).sqrt()
    }

    /// The unit normal of that surface at `p`.
    pub(crate) fn normal(&self, c: &[f64; TERMS], p: Point) -> Point {
        let [s, t] = slope(c, &self.terms(p).0);
        let [first, second, up] = self.axes;
        unit(sub(up, add(scale(first, s), scale(second, t))))
    }
}

/// The function with the coefficients `c`.
pub(crate) fn value(c: &[f64; TERMS], terms: &[f64; TERMS]) -> f64 {
    terms.iter().zip(c).map(|(t, c)| t * c).sum()
}

fn slope(c: &[f64; TERMS], terms: &[f64; TERMS]) -> [f64; 2] {
    [c[1] + 2.0 * c[3] * terms[1] + c[4] * terms[2], c[2] + c[4] * terms[1] + 2.0 * c[5] * terms[2]]
}

/// The weighted least squares fit of functions to their values at the same points.
#[derive(Debug, Clone)]
pub(crate) struct LeastSquares {
    matrix: [[f64; TERMS]; TERMS],
    right: Vec<[f64; TERMS]>,
}

impl LeastSquares {
    /// No points yet, and so many functions.
    pub(crate) fn new(n_functions: usize) -> Self {
        Self { matrix: [[0.0; TERMS]; TERMS], right: vec![[0.0; TERMS]; n_functions] }
    }

    /// Adds a point by its terms and what the functions are there.
    pub(crate) fn add(&mut self, weight: f64, terms: &[f64; TERMS], value: impl Fn(usize) -> f64) {
        for i in 0..TERMS {
            (0..TERMS).for_each(|j| self.matrix[i][j] += weight * terms[i] * terms[j]);
            for (c, row) in self.right.iter_mut().enumerate() {
                row[i] += weight * terms[i] * value(c);
            }
        }
    }

    /// The coefficients of each function, with pulls to zero: `slight` on the constant and the slopes, which
    /// need it only where the points lie on a line, and `stiffness` on the quadratic terms.
    pub(crate) fn solve(mut self, slight: f64, stiffness: f64) -> Vec<[f64; TERMS]> {
        for (i, row) in self.matrix.iter_mut().enumerate() {
            row[i] += if i < 3 { slight } else { stiffness };
        }
        self.right.iter().map(|row| solve(self.matrix, *row)).collect()
    }
}

/// Two unit vectors in the plane of the unit `normal`, and the normal.
pub(crate) fn axes_along(normal: Point) -> [Point; 3] {
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = dot(axis, normal);
    let s = unit(sub(axis, scale(normal, across)));
    [s, cross(normal, s), normal]
}

/// Solves a small positive definite system by Cholesky's factorization.
fn solve(mut a: [[f64; TERMS]; TERMS], mut b: [f64; TERMS]) -> [f64; TERMS] {
    for j in 0..TERMS {
        for k in 0..j {
            let factor = a[j][k];
            (j..TERMS).for_each(|i| a[i][j] -= factor * a[i][k]);
        }
        let pivot = a[j][j].max(f64::MIN_POSITIVE).sqrt();
        (j..TERMS).for_each(|i| a[i][j] /= pivot);
    }
    for i in 0..TERMS {
        (0..i).for_each(|k| b[i] -= a[i][k] * b[k]);
        b[i] /= a[i][i];
    }
    for i in (0..TERMS).rev() {
        (i + 1..TERMS).for_each(|k| b[i] -= a[k][i] * b[k]);
        b[i] /= a[i][i];
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved() {
        let a: [[f64; TERMS]; TERMS] = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 8.0 } else { 1.0 / (1.0 + i as f64 + j as f64) })
        });
        let x: [f64; TERMS] = std::array::from_fn(|i| i as f64 - 2.5);
        let b = std::array::from_fn(|i| (0..TERMS).map(|j| a[i][j] * x[j]).sum());
        let found = solve(a, b);
        assert!(found.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
    }
}
