//! Second-order cones: the Frobenius norm of a block over `K` columns, and its shrinkage.

use crate::block_rows::BLOCK;

/// One block of the operator applied to `K` columns.
pub type Block<const K: usize> = [[f64; K]; BLOCK];

/// The Frobenius norm of a block.
#[inline(always)]
#[must_use]
pub fn norm<const K: usize>(x: &Block<K>) -> f64 {
    inner(x, x).sqrt()
}

/// The Frobenius inner product of two blocks.
#[inline(always)]
#[must_use]
pub fn inner<const K: usize>(x: &Block<K>, y: &Block<K>) -> f64 {
    // A sum for each column: they fit a vector register, one sum of all would wait for itself.
    let mut sums = [0.0; K];
    for r in 0..BLOCK {
        for c in 0..K {
            sums[c] += x[r][c] * y[r][c];
        }
    }
    sums.iter().sum()
}

/// `a·x + b·y`.
#[inline(always)]
#[must_use]
pub fn combine<const K: usize>(a: f64, x: &Block<K>, b: f64, y: &Block<K>) -> Block<K> {
    let mut out = *x;
    for r in 0..BLOCK {
        for c in 0..K {
            out[r][c] = a * x[r][c] + b * y[r][c];
        }
    }
    out
}

/// `x` scaled by `a`.
#[inline(always)]
#[must_use]
pub fn scaled<const K: usize>(a: f64, x: &Block<K>) -> Block<K> {
    let mut out = *x;
    for row in &mut out {
        for v in row {
            *v *= a;
        }
    }
    out
}

/// Shrinkage, the proximal map of `t·‖·‖`: shortens `x` by `t`, to zero where it is shorter than that.
#[inline(always)]
#[must_use]
pub fn shrink<const K: usize>(x: &Block<K>, t: f64) -> Block<K> {
    let length = norm(x);
    scaled(if length <= t { 0.0 } else { 1.0 - t / length }, x)
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Block<2> = [[3.0, 0.0], [0.0, 4.0], [0.0, 12.0]];

    #[test]
    fn norms_and_combinations() {
        assert_eq!(norm(&X), 13.0);
        assert_eq!(norm(&combine(2.0, &X, -1.0, &X)), 13.0);
        assert_eq!(inner(&X, &scaled(2.0, &X)), 338.0);
    }

    #[test]
    fn shrinkage_shortens_to_zero_and_no_further() {
        assert!((norm(&shrink(&X, 3.0)) - 10.0).abs() < 1e-14);
        assert_eq!(shrink(&X, 13.0), [[0.0; 2]; BLOCK]);
        assert_eq!(shrink(&X, 0.0), X);
    }

    #[test]
    fn shrinkage_is_the_proximal_map() {
        // The minimizer of t‖y‖ + ½‖y − x‖² is better than every nearby point.
        let cost = |y: &Block<2>| {
            let gap = combine(1.0, y, -1.0, &X);
            5.0 * norm(y) + 0.5 * inner(&gap, &gap)
        };
        let best = shrink(&X, 5.0);
        for r in 0..BLOCK {
            for c in 0..2 {
                for step in [1e-3, -1e-3] {
                    let mut near = best;
                    near[r][c] += step;
                    assert!(cost(&near) > cost(&best));
                }
            }
        }
    }
}
