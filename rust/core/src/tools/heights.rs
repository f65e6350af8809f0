//! What fits of a height over a plane share: a frame, and a small system.

use crate::mesh::vector::{cross, dot, scale, sub, unit, Point};

/// Coefficients of `1, s, t, s², st, t²`.
pub(super) const TERMS: usize = 6;

/// Two unit vectors in the plane of the unit `normal`, and the normal.
pub(super) fn frame(normal: Point) -> [Point; 3] {
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = dot(axis, normal);
    let s = unit(sub(axis, scale(normal, across)));
    [s, cross(normal, s), normal]
}

/// Solves a small positive definite system by Cholesky's factorisation.
pub(super) fn solve(mut a: [[f64; TERMS]; TERMS], mut b: [f64; TERMS]) -> [f64; TERMS] {
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
