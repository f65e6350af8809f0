//! Small dense matrices.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, MatRef, Side};

/// The factorization of a small dense matrix.
#[derive(Debug)]
pub struct DenseCholesky {
    factor: Llt<f64>,
}

impl DenseCholesky {
    /// Factors the lower triangle of a `p × p` matrix stored column by column; `None` when it is not clearly
    /// positive definite: a pivot under 1e-12 of its diagonal entry is lost to rounding.
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

/// The eigenvalues of a small symmetric matrix, ascending, and its eigenvectors.
#[must_use]
pub fn symmetric_eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut vectors: Vec<Vec<f64>> =
        (0..n).map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect()).collect();
    diagonalize(&mut a, &mut vectors);
    let mut pairs: Vec<(f64, Vec<f64>)> =
        vectors.into_iter().enumerate().map(|(j, v)| (a[j][j], v)).collect();
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0));
    pairs.into_iter().unzip()
}

/// The eigenvalues of a symmetric 3 × 3 matrix, in no order, each with its unit eigenvector.
#[must_use]
pub fn eigen3(mut a: [[f64; 3]; 3]) -> [(f64, [f64; 3]); 3] {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    diagonalize(&mut a, &mut vectors);
    [0, 1, 2].map(|j| (a[j][j], vectors[j]))
}

/// The least eigenvalue of a symmetric 3 × 3 matrix, and its unit eigenvector: where the matrix is that of
/// [`scatter`], across the plane that the vectors are nearest to.
#[must_use]
pub fn least_eigen3(a: [[f64; 3]; 3]) -> (f64, [f64; 3]) {
    eigen3(a).into_iter().fold((f64::INFINITY, [0.0; 3]), |a, b| if b.0 < a.0 { b } else { a })
}

/// `Σ w v vᵀ` over vectors with weights.
pub fn scatter(vectors: impl Iterator<Item = ([f64; 3], f64)>) -> [[f64; 3]; 3] {
    let mut matrix = [[0.0; 3]; 3];
    for (v, weight) in vectors {
        for i in 0..3 {
            (0..3).for_each(|j| matrix[i][j] += weight * v[i] * v[j]);
        }
    }
    matrix
}

/// The shortest solution of `matrix · x = right` for a small symmetric positive semidefinite matrix, by the
/// pseudo-inverse: of eigenvalues above `drop` times the largest, to which `damping` times the largest is
/// added.
#[must_use]
pub fn solved(matrix: Vec<Vec<f64>>, right: &[f64], drop: f64, damping: f64) -> Vec<f64> {
    let (values, vectors) = symmetric_eigen(matrix);
    let largest = values.last().copied().unwrap_or(0.0);
    let mut x = vec![0.0; right.len()];
    for (value, vector) in values.iter().zip(&vectors).filter(|(value, _)| **value > drop * largest) {
        let along: f64 = vector.iter().zip(right).map(|(v, r)| v * r).sum();
        let length = along / (value + damping * largest);
        x.iter_mut().zip(vector).for_each(|(x, v)| *x += length * v);
    }
    x
}

/// Jacobi's rotations, which give the same bits on any number of threads: `a` becomes diagonal,
/// `vectors` one a row.
fn diagonalize<R: AsMut<[f64]> + AsRef<[f64]>>(a: &mut [R], vectors: &mut [R]) {
    let n = a.len();
    let turn = |c: f64, s: f64, x: &mut f64, y: &mut f64| (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    let turn_rows = |c: f64, s: f64, rows: &mut [R], p: usize, q: usize| {
        let (upper, lower) = rows.split_at_mut(q);
        upper[p].as_mut().iter_mut().zip(lower[0].as_mut()).for_each(|(x, y)| turn(c, s, x, y));
    };
    // Convergence is quadratic: some ten sweeps at most.
    for _ in 0..30 {
        let off: f64 = (0..n).flat_map(|p| &a[p].as_ref()[p + 1..]).fold(0.0, |sum, x| sum + x.abs());
        let on: f64 = (0..n).fold(0.0, |sum, p| sum + a[p].as_ref()[p].abs());
        if off <= 1e-300 || off <= 1e-15 * on {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                let beside = a[p].as_ref()[q];
                if beside == 0.0 {
                    continue;
                }
                let theta = (a[q].as_ref()[q] - a[p].as_ref()[p]) / (2.0 * beside);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = c * t;
                for row in a.iter_mut() {
                    let (left, right) = row.as_mut().split_at_mut(q);
                    turn(c, s, &mut left[p], &mut right[0]);
                }
                turn_rows(c, s, a, p, q);
                turn_rows(c, s, vectors, p, q);
            }
        }
    }
}

/// Planes that a point is to lie on, as least squares: the quadric of Garland and Heckbert 1997.
#[derive(Debug, Clone, Copy, Default)]
pub struct Quadric {
    matrix: [[f64; 3]; 3],
    right: [f64; 3],
    constant: f64,
}

impl Quadric {
    /// Adds a plane by its unit `normal` and its signed distance `offset` from the origin along that.
    pub fn add(&mut self, weight: f64, normal: [f64; 3], offset: f64) {
        self.constant += weight * offset * offset;
        for i in 0..3 {
            self.right[i] += weight * offset * normal[i];
            (0..3).for_each(|j| self.matrix[i][j] += weight * normal[i] * normal[j]);
        }
    }

    /// Adds a point: three planes through it.
    pub fn add_point(&mut self, weight: f64, point: [f64; 3]) {
        for (i, x) in point.into_iter().enumerate() {
            self.matrix[i][i] += weight;
            self.right[i] += weight * x;
            self.constant += weight * x * x;
        }
    }

    /// The planes of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = *self;
        sum.constant += other.constant;
        for i in 0..3 {
            sum.right[i] += other.right[i];
            (0..3).for_each(|j| sum.matrix[i][j] += other.matrix[i][j]);
        }
        sum
    }

    /// The weighted sum of the squared distances of `point` from the planes; what rounding makes negative is
    /// 0.
    #[must_use]
    pub fn value(&self, point: [f64; 3]) -> f64 {
        let mut sum = self.constant;
        for i in 0..3 {
            let row: f64 = (0..3).map(|j| self.matrix[i][j] * point[j]).sum();
            sum += point[i] * (row - 2.0 * self.right[i]);
        }
        sum.max(0.0)
    }

    /// The sum of the weights of all planes and points, each of these counted three times.
    #[must_use]
    pub fn weight(&self) -> f64 {
        (0..3).map(|i| self.matrix[i][i]).sum()
    }

    /// The point of least value; `None` where the planes do not determine it.
    #[must_use]
    pub fn minimizer(&self) -> Option<[f64; 3]> {
        // Cramer's rule: three by three, millions of times.
        let [a, b, c] = self.matrix;
        let cross = |u: [f64; 3], v: [f64; 3]| {
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        };
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant: f64 = (0..3).map(|i| a[i] * columns[0][i]).sum();
        let trace = a[0] + b[1] + c[2];
        (determinant > 1e-12 * trace.powi(3)).then(|| {
            std::array::from_fn(|i| (0..3).map(|k| columns[k][i] * self.right[k]).sum::<f64>() / determinant)
        })
    }

    /// The directions that the planes determine, with how far the best point is along each: what the
    /// pseudo-inverse keeps, eigenvalues above `drop` times the largest.
    #[must_use]
    pub fn determined(&self, drop: f64) -> Vec<([f64; 3], f64)> {
        directions(self.matrix, self.right, drop)
    }

    /// The point nearest to the origin of those that lie best, the directions left out that the planes leave
    /// open.
    #[must_use]
    pub fn nearest(&self, drop: f64) -> [f64; 3] {
        determined(self.matrix, self.right, drop)
    }
}

/// The shortest solution of `matrix · x = right` for a symmetric positive semidefinite matrix, by the
/// pseudo-inverse: of eigenvalues above `drop` times the largest.
#[must_use]
pub fn determined(matrix: [[f64; 3]; 3], right: [f64; 3], drop: f64) -> [f64; 3] {
    let mut x = [0.0; 3];
    for (vector, length) in directions(matrix, right, drop) {
        x.iter_mut().zip(vector).for_each(|(x, v)| *x += length * v);
    }
    x
}

/// The directions that the pseudo-inverse keeps, with how far the solution is along each.
fn directions(matrix: [[f64; 3]; 3], right: [f64; 3], drop: f64) -> Vec<([f64; 3], f64)> {
    let pairs = eigen3(matrix);
    let largest = pairs.iter().fold(0.0, |most: f64, pair| most.max(pair.0));
    let along = |vector: [f64; 3]| (0..3).map(|i| vector[i] * right[i]).sum::<f64>();
    let kept = pairs.into_iter().filter(|(value, _)| *value > drop * largest);
    kept.map(|(value, vector)| (vector, along(vector) / value)).collect()
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

    #[test]
    fn eigenvectors_are_orthonormal_and_rebuild_the_matrix() {
        let matrices = [
            [[2.0, -1.0, 0.5], [-1.0, 3.0, 0.25], [0.5, 0.25, 1.0]],
            [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
            [[0.0; 3]; 3],
            [[1e-20, 0.0, 0.0], [0.0, 1e20, 1e5], [0.0, 1e5, 1.0]],
        ];
        for matrix in matrices {
            let (values, vectors): (Vec<f64>, Vec<[f64; 3]>) = eigen3(matrix).into_iter().unzip();
            let size = matrix.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
            for i in 0..3 {
                for j in 0..3 {
                    let identity = if i == j { 1.0 } else { 0.0 };
                    assert!((dot(&vectors[i], &vectors[j]) - identity).abs() < 1e-12);
                    let rebuilt: f64 = (0..3).map(|k| values[k] * vectors[k][i] * vectors[k][j]).sum();
                    assert!((rebuilt - matrix[i][j]).abs() <= 1e-12 * size, "{matrix:?}");
                }
            }
        }
    }
}
