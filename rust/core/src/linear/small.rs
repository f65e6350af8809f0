//! Small dense matrices.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, MatRef, Side};

/// The factorisation of a small dense matrix.
#[derive(Debug)]
pub struct DenseCholesky {
    factor: Llt<f64>,
}

impl DenseCholesky {
    /// Factors the lower triangle of a `p × p` matrix stored column by column; `None` when it is not clearly positive
    /// definite: a pivot under 1e-12 of its diagonal entry is lost to rounding.
    #[must_use]
    pub fn new(matrix: &[f64], p: usize) -> Option<Self> {
        let matrix = MatRef::from_column_major_slice(matrix, p, p);
        let factor = Llt::new(matrix, Side::Lower).ok()?;
        let lower = factor.L();
        let sound = (0..p).all(|i| lower[(i, i)] * lower[(i, i)] > 1e-12 * matrix[(i, i)]);
        sound.then_some(Self { factor })
    }

    /// Solves in place for `K` right sides stored row by row.
    pub fn solve<const K: usize>(&self, right: &mut [[f64; K]]) {
        let mut dense = Mat::from_fn(right.len(), K, |i, c| right[i][c]);
        self.factor.solve_in_place(&mut dense);
        for (i, row) in right.iter_mut().enumerate() {
            for (c, x) in row.iter_mut().enumerate() {
                *x = dense[(i, c)];
            }
        }
    }
}

/// The eigenvalues of a small symmetric matrix, ascending, and its eigenvectors: Jacobi's rotations, which give the same bits
/// on any number of threads.
#[must_use]
pub fn symmetric_eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut vectors: Vec<Vec<f64>> = (0..n).map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect()).collect();
    // Convergence is quadratic: some ten sweeps at most.
    for _ in 0..30 {
        let off: f64 = (0..n).map(|i| (0..i).map(|j| a[i][j] * a[i][j]).sum::<f64>()).sum();
        let whole: f64 = a.iter().flatten().map(|x| x * x).sum();
        if off <= 1e-32 * whole {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = c * t;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = a.split_at_mut(q);
                let pairs = upper[p].iter_mut().zip(&mut lower[0]);
                pairs.for_each(|(x, y)| (*x, *y) = (c * *x - s * *y, s * *x + c * *y));
                let (left, right) = vectors.split_at_mut(q);
                let pairs = left[p].iter_mut().zip(&mut right[0]);
                pairs.for_each(|(x, y)| (*x, *y) = (c * *x - s * *y, s * *x + c * *y));
            }
        }
    }
    let mut pairs: Vec<(f64, Vec<f64>)> = vectors.into_iter().enumerate().map(|(j, v)| (a[j][j], v)).collect();
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0));
    pairs.into_iter().unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(x: &[f64], y: &[f64]) -> f64 {
        x.iter().zip(y).map(|(x, y)| x * y).sum()
    }

    #[test]
    fn jacobi_diagonalises() {
        let a = vec![vec![2.0, -1.0, 0.0], vec![-1.0, 2.0, -1.0], vec![0.0, -1.0, 2.0]];
        let (values, vectors) = symmetric_eigen(a.clone());
        let root = 2.0_f64.sqrt();
        for (found, expected) in values.iter().zip([2.0 - root, 2.0, 2.0 + root]) {
            assert!((found - expected).abs() < 1e-14);
        }
        for (value, v) in values.iter().zip(&vectors) {
            for (row, x) in a.iter().zip(v) {
                assert!((dot(row, v) - value * x).abs() < 1e-14);
            }
        }
    }
}
