//! Second-order cones: the Frobenius norm of a block over `K` columns, and its shrinkage.

use crate::block_rows::BLOCK;

/// One block of the operator applied to `K` columns.
pub type Block<const K: usize> = [[f64; K]; BLOCK];

/// The Frobenius norm of a block.
#[must_use]
pub fn norm<const K: usize>(x: &Block<K>) -> f64 {
    inner(x, x).sqrt()
}

/// The Frobenius inner product of two blocks.
#[must_use]
pub fn inner<const K: usize>(x: &Block<K>, y: &Block<K>) -> f64 {
    let mut sum = 0.0;
    for (a, b) in x.iter().zip(y) {
        for (s, t) in a.iter().zip(b) {
            sum += s * t;
        }
    }
    sum
}

/// `a·x + b·y`.
#[must_use]
pub fn combine<const K: usize>(a: f64, x: &Block<K>, b: f64, y: &Block<K>) -> Block<K> {
    std::array::from_fn(|r| std::array::from_fn(|c| a * x[r][c] + b * y[r][c]))
}

/// `x` scaled by `a`.
#[must_use]
pub fn scaled<const K: usize>(a: f64, x: &Block<K>) -> Block<K> {
    x.map(|row| row.map(|v| a * v))
}

/// Shrinkage, the proximal map of `t·‖·‖`: shortens `x` by `t`, to zero where it is shorter than that.
#[must_use]
pub fn shrink<const K: usize>(x: &Block<K>, t: f64) -> Block<K> {
    let length = norm(x);
    if length <= t {
        [[0.0; K]; BLOCK]
    } else {
        scaled(1.0 - t / length, x)
    }
}
