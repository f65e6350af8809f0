//! Primal-dual interior-point steps: a few factorizations from a rough solution to a certified one, however
//! many iterations of alternating directions it would take.
//!
//! With the logarithmic barrier of the cones `‖(H u + c)_b‖ ≤ t_b` and its parameter `μ`, the best `t_b` are
//! known, `t_b = m_b + q_b`, `m_b = μ / w_b`, `q_b = √(m_b² + ‖(H u + c)_b‖²)`, and the points of the central
//! path solve `t_b z_b = w_b (H u + c)_b`, `Hᵀz + 2a (u − t) = 0`. A step is one of Newton's method on these
//! equations in `u` and `z` together (Andersen, Christiansen, Conn and Overton 2000; Chan, Golub and Mulet
//! 1999): its matrix has the pattern of `HᵀH`, and its dual point solves the dual equations exactly.

use crate::block_rows::BLOCK;
use crate::error::SolveError;
use crate::memory;
use crate::solve::certificate::DualPoint;
use crate::solve::cones::{combine, norm, scaled, Block};
use crate::solve::reduced::Reduced;

/// Halvings of a step before it counts as failed.
const HALVINGS: usize = 10;

/// The symmetric matrix `scale · I − drop · (z hᵀ + h zᵀ)` of one block, the same for every column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// The factor of the identity.
    pub scale: f64,
    /// The factor of the two products.
    pub drop: f64,
    /// `z`, not longer than the weight.
    pub dual: [f64; BLOCK],
    /// `h`.
    pub primal: [f64; BLOCK],
}

impl Stiffness {
    /// The matrix times `x`.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, x: &[f64; BLOCK]) -> [f64; BLOCK] {
        let (z, h) = (&self.dual, &self.primal);
        let along_dual = self.drop * (z[0] * x[0] + z[1] * x[1] + z[2] * x[2]);
        let along_primal = self.drop * (h[0] * x[0] + h[1] * x[1] + h[2] * x[2]);
        std::array::from_fn(|r| self.scale * x[r] - along_primal * z[r] - along_dual * h[r])
    }

    #[inline(always)]
    fn times_block<const K: usize>(&self, x: &Block<K>) -> Block<K> {
        let mut out = *x;
        for c in 0..K {
            let column = self.times(&std::array::from_fn(|r| x[r][c]));
            out.iter_mut().zip(column).for_each(|(row, value)| row[c] = value);
        }
        out
    }
}

/// A point and its objective.
type Point<const K: usize> = (Vec<[f64; K]>, f64);

/// The equations of the central path, linear around a point, for problems in one column.
#[derive(Debug)]
pub(super) struct Model<const K: usize> {
    /// `μ`.
    barrier: f64,
    /// `H u + c`.
    h: Vec<Block<K>>,
    /// `w (H u + c) / t`.
    slope: Vec<Block<K>>,
    /// `V`: how the dual point changes with `H u`.
    stiffness: Vec<Stiffness>,
}

impl<const K: usize> Model<K> {
    /// The model at `u` and `z`, whose blocks are not longer than the weights, for the parameter `μ`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn new(
        reduced: &Reduced<'_, K>,
        u: &[[f64; K]],
        z: &[Block<K>],
        barrier: f64,
    ) -> Result<Self, SolveError> {
        let (h, m) = (reduced.apply(u)?, reduced.n_blocks());
        let mut model = Self { barrier, h, slope: memory::room(m)?, stiffness: memory::room(m)? };
        for ((h, z), &w) in model.h.iter().zip(z).zip(reduced.weights.iter()) {
            let (primal, dual) = (h.map(|row| row[0]), z.map(|row| row[0]));
            let (mut scale, mut drop) = (0.0, 0.0);
            if w > 0.0 {
                let (q, t) = cone(barrier / w, norm(h));
                scale = w / t;
                drop = 0.5 / (t * q);
            }
            model.slope.push(scaled(scale, h));
            model.stiffness.push(Stiffness { scale, drop, dual, primal });
        }
        Ok(model)
    }

    /// The dual point at which the equations begin, `s`.
    #[must_use]
    pub(super) fn slope(&self) -> &[Block<K>] {
        &self.slope
    }

    /// The stiffness `V` of every block.
    #[must_use]
    pub(super) fn stiffness(&self) -> &[Stiffness] {
        &self.stiffness
    }

    /// The stiffness `V` of every block.
    #[must_use]
    pub(super) fn into_stiffness(self) -> Vec<Stiffness> {
        self.stiffness
    }

    /// `(HᵀVH + 2a) x`: the matrix of the linear equations, never formed.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn times(
        &self,
        reduced: &Reduced<'_, K>,
        x: &[[f64; K]],
    ) -> Result<Vec<[f64; K]>, SolveError> {
        let product = |b: usize| self.stiffness[b].times_block(&reduced.block_times(b, x));
        let mut out = reduced.apply_transposed(product)?;
        for ((row, x), a) in out.iter_mut().zip(x).zip(&reduced.fidelity) {
            row.iter_mut().zip(x).for_each(|(row, x)| *row += 2.0 * a * x);
        }
        Ok(out)
    }

    /// The farthest of the points all the way, halfway, a quarter of the way, … along a `step` from `u` at
    /// which the barrier function is not larger than before, and the objective there; `change` is `H` times
    /// the step.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn descend(
        &self,
        reduced: &Reduced<'_, K>,
        u: &[[f64; K]],
        step: &[[f64; K]],
        change: &[Block<K>],
    ) -> Result<Option<Point<K>>, SolveError> {
        let before = self.value(reduced, u, &self.h);
        let mut part = 1.0;
        for _ in 0..=HALVINGS {
            let there = |(u, step): (&[f64; K], &[f64; K])| std::array::from_fn(|c| u[c] + part * step[c]);
            let u: Vec<[f64; K]> = memory::gathered(u.iter().zip(step).map(there))?;
            let moved = self.h.iter().zip(change).map(|(h, by)| combine(1.0, h, part, by));
            let h: Vec<Block<K>> = memory::gathered(moved)?;
            if self.value(reduced, &u, &h) <= before {
                let primal = reduced.objective(&u, h.iter().map(norm));
                return Ok(Some((u, primal)));
            }
            part *= 0.5;
        }
        Ok(None)
    }

    /// The barrier function `Σ w t − μ log(t² − ‖h‖²)`, with the best `t`, and the fidelity.
    fn value(&self, reduced: &Reduced<'_, K>, u: &[[f64; K]], h: &[Block<K>]) -> f64 {
        let one = |(h, &w): (&Block<K>, &f64)| {
            if w <= 0.0 {
                return 0.0;
            }
            let (_, t) = cone(self.barrier / w, norm(h));
            w * t - self.barrier * (2.0 * self.barrier / w * t).ln()
        };
        h.iter().zip(reduced.weights.iter()).map(one).sum::<f64>() + reduced.fidelity_term(u)
    }
}

/// `q = √(m² + ‖h‖²)` and `t = m + q`.
fn cone(m: f64, length: f64) -> (f64, f64) {
    let q = m.hypot(length);
    (q, m + q)
}

/// Shortens the blocks that are longer than their weights.
pub(super) fn clip<const K: usize>(reduced: &Reduced<'_, K>, z: &mut [Block<K>]) {
    for (z, &w) in z.iter_mut().zip(reduced.weights.iter()) {
        let length = norm(z);
        if length > w {
            *z = scaled(w / length, z);
        }
    }
}

/// What a bound needs to know of the dual point `z`.
#[must_use]
pub(super) fn dual_point<const K: usize>(reduced: &Reduced<'_, K>, z: &[Block<K>]) -> DualPoint {
    let mut point = DualPoint::default();
    for (b, z) in z.iter().enumerate() {
        point.add(z, reduced.weights[b], &reduced.constant(b));
    }
    point
}

/// Takes the dual point `z` along with a change of `H u`, by the stiffness times it.
pub(super) fn follow<const K: usize>(stiffness: &[Stiffness], change: &[Block<K>], z: &mut [Block<K>]) {
    for ((z, stiffness), change) in z.iter_mut().zip(stiffness).zip(change) {
        *z = combine(1.0, z, 1.0, &stiffness.times_block(change));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::block_rows::BlockRows;
    use crate::linear::Columns;
    use crate::solve::fast::system::{System, Weighing};
    use crate::solve::{Coupling, FreeOperator, Problem};
    use crate::Progress;

    /// Blocks over three neighbors on a line, weights from nothing to two, fidelity on every other row,
    /// two ends known.
    fn problem(operator: &BlockRows) -> Problem<'_> {
        let n = operator.n_columns;
        let data = (0..n).map(|i| (0.7 * i as f64).sin() + 0.1 * i as f64).collect();
        Problem {
            operator,
            weights: (0..operator.n_blocks()).map(|b| 0.5 * (b % 5) as f64).collect(),
            fidelity: (0..n).map(|i| 0.3 * (i % 2) as f64).collect(),
            target: Columns { n_rows: n, n_columns: 1, data },
            fixed: (0..n).map(|i| i == 0 || i + 1 == n).collect(),
            linear_constraints: None,
            coupling: Coupling::Joint,
        }
    }

    fn operator() -> BlockRows {
        let mut rows = BlockRows::empty(24);
        for b in 0..44usize {
            let at = |k: usize| std::array::from_fn(|r| ((7 * b + 3 * k + 5 * r) as f64).sin());
            rows.push_block((0..3).map(|k| ((b / 2 + k) as u32, at(k))));
        }
        rows
    }

    /// What holds of that problem.
    fn with_reduced(check: impl FnOnce(Reduced<'_, 1>)) {
        let operator = operator();
        let problem = problem(&operator);
        let free = FreeOperator::new(&operator, &problem.fixed).unwrap();
        check(Reduced::<1>::new(&problem, &free, &[0]).unwrap());
    }

    /// What the dual equations lack.
    fn lacking(reduced: &Reduced<'_, 1>, u: &[[f64; 1]], z: &[Block<1>]) -> Vec<[f64; 1]> {
        let mut g = reduced.apply_transposed(|b| z[b]).unwrap();
        for (i, g) in g.iter_mut().enumerate() {
            g[0] = 2.0 * reduced.fidelity[i] * (reduced.target[i][0] - u[i][0]) - g[0];
        }
        g
    }

    /// Newton's method at one fixed parameter; the point, the dual point, and how far the last step went.
    fn center(
        reduced: &mut Reduced<'_, 1>,
        barrier: f64,
        n_steps: usize,
    ) -> (Vec<[f64; 1]>, Vec<Block<1>>, f64) {
        let mut system = System::new(reduced.free, None, &Progress::new()).unwrap();
        let mut u = reduced.target.clone();
        let mut z = vec![[[0.0; 1]; BLOCK]; reduced.n_blocks()];
        let mut far = f64::INFINITY;
        for _ in 0..n_steps {
            let model = Model::new(reduced, &u, &z, barrier).unwrap();
            system.factorize(reduced, Weighing::Stiffness(model.stiffness()), &Progress::new()).unwrap();
            z = model.slope().to_vec();
            let mut step = lacking(reduced, &u, &z);
            system.solve_change(reduced, &mut step).unwrap();
            let change = reduced.apply_change(&step).unwrap();
            follow(model.stiffness(), &change, &mut z);
            clip(reduced, &mut z);
            u = model.descend(reduced, &u, &step, &change).unwrap().unwrap().0;
            far = step.iter().map(|x| x[0].abs()).fold(0.0, f64::max);
        }
        (u, z, far)
    }

    #[test]
    fn the_matrix_is_the_derivative_of_the_slope_on_the_central_path() {
        with_reduced(|reduced| {
            let none = vec![[[0.0; 1]; BLOCK]; reduced.n_blocks()];
            // On the path z is the slope; there, and only there, the matrix is the derivative.
            let at = |u: &[[f64; 1]], z: &[Block<1>]| Model::new(&reduced, u, z, 0.1).unwrap();
            let model = |u: &[[f64; 1]]| at(u, at(u, &none).slope());
            let u = &reduced.target;
            let step: Vec<[f64; 1]> = (0..u.len()).map(|i| [(1.3 * i as f64).cos()]).collect();
            let moved = |far: f64| -> Vec<[f64; 1]> {
                u.iter().zip(&step).map(|(u, s)| [u[0] + far * s[0]]).collect()
            };
            let (ahead, behind) = (model(&moved(1e-5)), model(&moved(-1e-5)));
            let change = reduced.apply_change(&step).unwrap();
            let mut derivative = none.clone();
            follow(model(u).stiffness(), &change, &mut derivative);
            for (b, derivative) in derivative.iter().enumerate() {
                let difference = combine(5e4, &ahead.slope()[b], -5e4, &behind.slope()[b]);
                assert!(
                    norm(&combine(1.0, &difference, -1.0, derivative)) < 1e-6 * (1.0 + norm(derivative)),
                    "block {b}"
                );
            }
        });
    }

    #[test]
    fn steps_converge_to_the_central_path_from_afar() {
        with_reduced(|mut reduced| {
            let barrier = 1e-3;
            let (u, z, far) = center(&mut reduced, barrier, 25);
            assert!(far < 1e-9, "the last step goes {far}");
            let h = reduced.apply(&u).unwrap();
            for ((h, z), &w) in h.iter().zip(&z).zip(reduced.weights.iter()) {
                if w > 0.0 {
                    let (_, t) = cone(barrier / w, norm(h));
                    assert!(norm(&combine(t, z, -w, h)) < 1e-9, "t z = w h");
                } else {
                    assert_eq!(norm(z), 0.0);
                }
            }
            assert!(lacking(&reduced, &u, &z).iter().all(|g| g[0].abs() < 1e-8));
        });
    }

    #[test]
    fn the_path_ends_at_the_minimum() {
        with_reduced(|mut reduced| {
            let mut before = f64::INFINITY;
            for barrier in [1e-1, 1e-3, 1e-5] {
                let (u, z, _) = center(&mut reduced, barrier, 40);
                let h = reduced.apply(&u).unwrap();
                let primal = reduced.objective(&u, h.iter().map(norm));
                let along = h.iter().zip(&z).map(|(h, z)| crate::solve::cones::inner(h, z)).sum::<f64>();
                // What a cone leaves is at most twice μ.
                let left = primal - reduced.fidelity_term(&u) - reduced.offset - along;
                assert!(left > 0.0 && left < 2.0 * barrier * reduced.n_blocks() as f64, "{left}");
                assert!(primal <= before);
                before = primal;
            }
        });
    }
}
