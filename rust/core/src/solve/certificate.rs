//! Lower bounds on the optimum, from dual points: what makes a gap computed and not estimated.
//!
//! For `q` with `‖q_b‖ ≤ w_b` and multipliers `y` of `A u = b`, with `g = Hᵀq + Aᵀy`, every feasible `u` has
//! an objective of at least `⟨q, c⟩ − ⟨y, b⟩ + ⟨g, t⟩ − Σ |g_i|² / 4a_i`, provided that `g_i = 0` wherever
//! `a_i = 0`.

use crate::solve::cones::{inner, norm, Block};
use crate::solve::reduced::Reduced;

/// What a term of a long sum loses to rounding, over the root of the number of terms.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// How far apart the values of each column are: no minimizer is farther from a point near it.
#[must_use]
pub fn spread<const K: usize>(u: &[[f64; K]]) -> [f64; K] {
    let (mut low, mut high) = ([f64::INFINITY; K], [f64::NEG_INFINITY; K]);
    for row in u {
        for c in 0..K {
            low[c] = low[c].min(row[c]);
            high[c] = high[c].max(row[c]);
        }
    }
    std::array::from_fn(|c| (high[c] - low[c]).max(0.0))
}

/// What a lower bound needs to know of the blocks of a dual point `q`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DualPoint {
    /// `⟨q, c⟩`.
    along_constant: f64,
    /// The longest `‖q_b‖ / w_b`, at least 1.
    longest: f64,
}

impl Default for DualPoint {
    fn default() -> Self {
        Self { along_constant: 0.0, longest: 1.0 }
    }
}

impl DualPoint {
    /// Takes in one block with its weight and its `c`.
    #[inline(always)]
    pub fn add<const K: usize>(&mut self, q: &Block<K>, w: f64, c: &Block<K>) {
        self.along_constant += inner(q, c);
        let length = norm(q);
        if length > w {
            self.longest = self.longest.max(length / w);
        }
    }

    /// The largest relative difference of what two points know.
    #[cfg(test)]
    pub fn difference(&self, other: &Self) -> f64 {
        let relative = |a: f64, b: f64| (a - b).abs() / a.abs().max(1.0);
        relative(self.along_constant, other.along_constant).max(relative(self.longest, other.longest))
    }

    /// The point of these blocks and `others`.
    #[must_use]
    pub fn and(self, others: Self) -> Self {
        Self {
            along_constant: self.along_constant + others.along_constant,
            longest: self.longest.max(others.longest),
        }
    }
}

/// The best lower bound along the ray `s·(q, y)`, `0 ≤ s ≤ 1 / max ‖q_b‖/w_b`,
/// which is feasible for every `q`.
///
/// `g` must be `Hᵀq + Aᵀy`, computed from `q` and `y`. Where there is no fidelity, `g_i` is zero up to
/// rounding; its product with the point `u` stands for its product with the minimizer, less an allowance for
/// the distance of the two.
#[must_use]
pub fn bound_along_ray<const K: usize>(
    reduced: &Reduced<'_, K>,
    q: &DualPoint,
    y: &[[f64; K]],
    g: &[[f64; K]],
    u: &[[f64; K]],
) -> f64 {
    let (mut linear, longest) = (q.along_constant, q.longest);
    // What rounding may have made of the sums, and a minimizer elsewhere of gradients that are not quite
    // zero.
    let mut terms = linear.abs();
    let mut allowance = 0.0;
    if let Some(constraints) = &reduced.constraints {
        for (y, b) in y.iter().flatten().zip(constraints.right.iter().flatten()) {
            linear -= y * b;
            terms += (y * b).abs();
        }
    }
    let mut quadratic = 0.0;
    let spread = spread(u);
    for (i, g) in g.iter().enumerate() {
        let a = reduced.fidelity[i];
        let against = if a > 0.0 { &reduced.target[i] } else { &u[i] };
        for c in 0..K {
            linear += g[c] * against[c];
            terms += (g[c] * against[c]).abs();
            if a > 0.0 {
                quadratic += g[c] * g[c] / (4.0 * a);
            } else {
                allowance += g[c].abs() * spread[c];
            }
        }
    }
    linear -= allowance + ROUNDING * (g.len() as f64).sqrt() * terms;
    if !longest.is_finite() {
        return reduced.offset;
    }
    let best = if quadratic > 0.0 { linear / (2.0 * quadratic) } else { f64::INFINITY };
    let s = if linear > 0.0 { best.min(1.0 / longest) } else { 0.0 };
    let bound = s * linear - s * s * quadratic;
    if bound.is_finite() {
        reduced.offset + bound.max(0.0)
    } else {
        reduced.offset
    }
}
