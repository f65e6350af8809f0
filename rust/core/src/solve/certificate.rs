//! Lower bounds on the optimum, from dual points: what makes a gap computed and not estimated.
//!
//! For `q` with `‖q_b‖ ≤ w_b` and multipliers `y` of `A u = b`, with `g = Hᵀq + Aᵀy`, every feasible `u` has an
//! objective of at least `⟨q, c⟩ − ⟨y, b⟩ + ⟨g, t⟩ − Σ |g_i|² / 4a_i`, provided that `g_i = 0` wherever `a_i = 0`.

use crate::solve::cones::{inner, norm, Block};
use crate::solve::reduced::Reduced;

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
        Self { along_constant: self.along_constant + others.along_constant, longest: self.longest.max(others.longest) }
    }
}

/// The best lower bound along the ray `s·(q, y)`, `0 ≤ s ≤ 1 / max ‖q_b‖/w_b`, which is feasible for every `q`.
///
/// `g` must be `Hᵀq + Aᵀy`. Where there is no fidelity, `g_i` is zero up to rounding; its product with the point `u`
/// stands for its product with the minimiser.
#[must_use]
pub fn bound_along_ray<const K: usize>(
    reduced: &Reduced<'_, K>,
    q: &DualPoint,
    y: &[[f64; K]],
    g: &[[f64; K]],
    u: &[[f64; K]],
) -> f64 {
    let (mut linear, longest) = (q.along_constant, q.longest);
    if let Some(constraints) = &reduced.constraints {
        linear -= y.iter().flatten().zip(constraints.right.iter().flatten()).map(|(y, b)| y * b).sum::<f64>();
    }
    let mut quadratic = 0.0;
    for (i, g) in g.iter().enumerate() {
        let a = reduced.fidelity[i];
        let against = if a > 0.0 { &reduced.target[i] } else { &u[i] };
        linear += g.iter().zip(against).map(|(g, t)| g * t).sum::<f64>();
        if a > 0.0 {
            quadratic += g.iter().map(|g| g * g).sum::<f64>() / (4.0 * a);
        }
    }
    if !longest.is_finite() {
        return 0.0;
    }
    let best = if quadratic > 0.0 { linear / (2.0 * quadratic) } else { f64::INFINITY };
    let s = if linear > 0.0 { best.min(1.0 / longest) } else { 0.0 };
    let bound = s * linear - s * s * quadratic;
    if bound.is_finite() {
        bound.max(0.0)
    } else {
        0.0
    }
}
