//! Newton steps for the end of the fast solver: few iterations of alternating directions find out where the ridges are, and
//! from there on the dual bound follows quadratically instead of linearly.
//!
//! For multipliers `p` and penalties `R` the augmented Lagrangian without its split variable is smooth but for kinks:
//! `Φ(u) = Σ M_b(H u + c + p/R) + Σ a ‖u − t‖²`, where `M_b` is the Moreau envelope of `w‖·‖`. A step is one of a semismooth
//! Newton method on it (Li, Sun and Toh 2018 for the lasso; Chan, Golub and Mulet 1999 for total variation).

use crate::block_rows::BLOCK;
use crate::solve::certificate::DualPoint;
use crate::solve::cones::{combine, norm, scaled, Block};
use crate::solve::reduced::Reduced;
use crate::solve::sweep::Sweep;

/// What is left of the stiffness along the direction of a block: none would be Newton's own, and leaves matrices singular. At
/// 0.1 steps gain a factor of three, at 1e-3 of ten (measured on interpolation at 9k to 58k vertices).
const ALONG_DIRECTION: f64 = 1e-3;

/// Halvings of a step before it counts as failed.
const HALVINGS: usize = 6;

/// The symmetric matrix `scale · I − drop · d dᵀ` of one block, the same for every column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// The factor of the identity.
    pub scale: f64,
    /// The factor of `d dᵀ`.
    pub drop: f64,
    /// `d`, of length one.
    pub direction: [f64; BLOCK],
}

impl Stiffness {
    /// The matrix times `x`.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, x: &[f64; BLOCK]) -> [f64; BLOCK] {
        let d = &self.direction;
        let along = self.drop * (d[0] * x[0] + d[1] * x[1] + d[2] * x[2]);
        std::array::from_fn(|r| self.scale * x[r] - along * d[r])
    }

    fn times_block<const K: usize>(&self, x: &Block<K>) -> Block<K> {
        let mut out = *x;
        for c in 0..K {
            let column = self.times(&std::array::from_fn(|r| x[r][c]));
            out.iter_mut().zip(column).for_each(|(row, value)| row[c] = value);
        }
        out
    }
}

/// The model of `Φ` around a point `u`.
#[derive(Debug)]
pub struct Model<const K: usize> {
    /// `H u + c`.
    h: Vec<Block<K>>,
    /// `p`.
    multipliers: Vec<Block<K>>,
    /// The gradient of `M_b`: `p + R (H u + c)`, shortened to `w`.
    slope: Vec<Block<K>>,
    /// The curvature of `M_b`.
    pub stiffness: Vec<Stiffness>,
}

/// Where a step ended.
#[derive(Debug)]
pub struct Step<const K: usize> {
    /// The point.
    pub u: Vec<[f64; K]>,
    /// `H u + c` there.
    h: Vec<Block<K>>,
    /// The objective there.
    pub primal: f64,
}

impl<const K: usize> Model<K> {
    /// The model at `u`, with the multipliers of `sweep`. Columns in one joint norm keep the whole of their stiffness.
    #[must_use]
    pub fn new(reduced: &Reduced<'_, K>, r: &[f64], sweep: &Sweep<K>, u: &[[f64; K]]) -> Self {
        let mut model = Self { h: Vec::new(), multipliers: Vec::new(), slope: Vec::new(), stiffness: Vec::new() };
        reduced.apply(u, &mut model.h);
        for (b, h) in model.h.iter().enumerate() {
            let (_, p) = sweep.split(&reduced.weights, r, b);
            let (w, r) = (reduced.weights[b], r[b]);
            let v = combine(r, h, 1.0, &p);
            let length = norm(&v);
            let mut stiffness = Stiffness { scale: r, drop: 0.0, direction: [0.0; BLOCK] };
            if length > w {
                stiffness.scale = w * r / length;
                if reduced.n_columns == 1 {
                    stiffness.drop = (1.0 - ALONG_DIRECTION) * stiffness.scale;
                    stiffness.direction = v.map(|row| row[0] / length);
                }
            }
            model.slope.push(scaled((w / length).min(1.0), &v));
            model.stiffness.push(stiffness);
            model.multipliers.push(p);
        }
        model
    }

    /// `Hᵀ(V (H u) − q)` at the point of the model, for slopes `q` and stiffness `V`: the right side of the linear system
    /// whose solution is the minimiser of the model.
    #[must_use]
    pub fn right(&self, reduced: &Reduced<'_, K>) -> Vec<[f64; K]> {
        let mut right = Vec::new();
        let at = |b: usize| {
            let free = combine(1.0, &self.h[b], -1.0, &reduced.constant(b));
            combine(1.0, &self.stiffness[b].times_block(&free), -1.0, &self.slope[b])
        };
        reduced.apply_transposed(at, &mut right);
        right
    }

    /// The dual point `q + V (H u' − H u)` that the minimiser `u'` of the model solves the dual equations with, and `Hᵀ` of
    /// it. Its blocks are too long by the square of the step only, and none is where `clipped`.
    #[must_use]
    pub fn dual_point(&self, reduced: &Reduced<'_, K>, h: &[Block<K>], clipped: bool) -> (DualPoint, Vec<[f64; K]>) {
        let at = |b: usize| {
            let q = combine(
                1.0,
                &self.slope[b],
                1.0,
                &self.stiffness[b].times_block(&combine(1.0, &h[b], -1.0, &self.h[b])),
            );
            let length = norm(&q);
            let too_long = clipped && length > reduced.weights[b];
            scaled(if too_long { reduced.weights[b] / length } else { 1.0 }, &q)
        };
        let mut point = DualPoint::default();
        for b in 0..h.len() {
            point.add(&at(b), reduced.weights[b], &reduced.constant(b));
        }
        let mut g = Vec::new();
        reduced.apply_transposed(at, &mut g);
        (point, g)
    }

    /// The farthest of the points halfway, a quarter of the way, … from `from` to the minimiser `to` of the model at which `Φ`
    /// is not larger than before; `h` is the operator at `to`.
    #[must_use]
    pub fn descend(
        &self,
        reduced: &Reduced<'_, K>,
        r: &[f64],
        from: &[[f64; K]],
        to: &[[f64; K]],
        h: &[Block<K>],
    ) -> Option<Step<K>> {
        let before = self.lagrangian(reduced, r, from, &self.h);
        let mut part = 1.0;
        for _ in 0..=HALVINGS {
            let between = |a: &[f64; K], b: &[f64; K]| std::array::from_fn(|c| a[c] + part * (b[c] - a[c]));
            let u: Vec<[f64; K]> = from.iter().zip(to).map(|(a, b)| between(a, b)).collect();
            let h: Vec<Block<K>> = self.h.iter().zip(h).map(|(a, b)| combine(1.0 - part, a, part, b)).collect();
            if self.lagrangian(reduced, r, &u, &h) <= before {
                let primal = reduced.objective(&u, &h);
                return Some(Step { u, h, primal });
            }
            part *= 0.5;
        }
        None
    }

    /// `Φ`, up to a constant.
    fn lagrangian(&self, reduced: &Reduced<'_, K>, r: &[f64], u: &[[f64; K]], h: &[Block<K>]) -> f64 {
        let envelope = |b: usize| {
            let (w, r) = (reduced.weights[b], r[b]);
            if r <= 0.0 {
                return 0.0;
            }
            let length = norm(&combine(1.0, &h[b], 1.0 / r, &self.multipliers[b]));
            if length * r <= w {
                0.5 * r * length * length
            } else {
                w * length - 0.5 * w * w / r
            }
        };
        (0..h.len()).map(envelope).sum::<f64>() + reduced.fidelity_term(u)
    }

    /// The split variables and new multipliers at the end of a step, as one: `H u + c + p/R`.
    #[must_use]
    pub fn state(&self, step: &Step<K>, r: &[f64], b: usize) -> Block<K> {
        if r[b] > 0.0 {
            combine(1.0, &step.h[b], 1.0 / r[b], &self.multipliers[b])
        } else {
            step.h[b]
        }
    }
}
