//! The pass over the blocks between two linear solves: product with `H`, shrinkage, multipliers and the
//! product with `Hᵀ` of what comes next, block by block, so that every block is read once and nothing is
//! stored in between.
//!
//! Split variable and multipliers are kept as one, `v = z + p/R`, from which `z = shrink(v, w/R)` and
//! `p = R (v − z)` (the Douglas-Rachford form of alternating directions; Eckstein and Bertsekas 1992).

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::block_rows::BLOCK;
use crate::error::SolveError;
use crate::memory;
use crate::solve::certificate::DualPoint;
use crate::solve::cones::{combine, norm, scaled, shrink, Block};
use crate::solve::reduced::{add_outer, add_outer_transposed, gather, BlockRanges, Reduced};

/// Over-relaxation: 1.5 to 1.8 is usual for alternating directions; 1.7 was the best measured.
const RELAXATION: f64 = 1.7;

/// The split variables of all blocks, and the sums that a pass over them makes.
#[derive(Debug)]
pub struct Sweep<const K: usize> {
    state: Vec<Block<K>>,
    /// Partial sums of the right side; the first holds the whole after a pass.
    right: Vec<Vec<[f64; K]>>,
    /// Partial sums of `Hᵀq` for the two dual points of [`Sums`], likewise.
    from_equations: Vec<Vec<[f64; K]>>,
    multipliers: Vec<Vec<[f64; K]>>,
}

/// What a pass finds out about the point `u` it was given.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums {
    /// `Σ w ‖H u + c‖`.
    pub norms: f64,
    /// `Σ w ‖H u + c − z‖`; only when asked to check.
    pub split: f64,
    /// The dual point `p + R (H u + c − z)` with `z` and `p` before the pass; only when asked to check.
    pub from_equations: DualPoint,
    /// The dual point `p` after the pass; only when asked to check, and where there is fidelity everywhere.
    pub multipliers: DualPoint,
}

impl<const K: usize> Sweep<K> {
    /// Starts from `z` and `p` of each block, under the penalties `r`, and from the point `u`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn new(
        reduced: &Reduced<'_, K>,
        r: &[f64],
        u: &[[f64; K]],
        start: impl Fn(usize) -> (Block<K>, Block<K>),
    ) -> Result<Self, SolveError> {
        let join = |(b, &r): (usize, &f64)| {
            let (z, p) = start(b);
            if r > 0.0 {
                combine(1.0, &z, 1.0 / r, &p)
            } else {
                [[0.0; K]; BLOCK]
            }
        };
        Self::resume(reduced, r, u, |b| join((b, &r[b])))
    }

    /// Starts from `v = z + p/R` of each block, and takes all that later passes need.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn resume(
        reduced: &Reduced<'_, K>,
        r: &[f64],
        u: &[[f64; K]],
        state: impl Fn(usize) -> Block<K>,
    ) -> Result<Self, SolveError> {
        let n_multipliers = if reduced.has_fidelity_everywhere { reduced.n() } else { 0 };
        let parts =
            |n| (0..BlockRanges::of(r.len()).count).map(|_| memory::room(n)).collect::<Result<_, _>>();
        let mut sweep = Self {
            state: memory::gathered((0..r.len()).map(state))?,
            right: parts(reduced.n())?,
            from_equations: parts(reduced.n())?,
            multipliers: parts(n_multipliers)?,
        };
        let right = reduced.apply_transposed(|b| sweep.next_right(reduced, r, u, b))?;
        sweep.right[0].extend_from_slice(&right);
        Ok(sweep)
    }

    /// `R(z − H u − c) − p` of block `b`.
    fn next_right(&self, reduced: &Reduced<'_, K>, r: &[f64], u: &[[f64; K]], b: usize) -> Block<K> {
        let (z, p) = self.split(&reduced.weights, r, b);
        combine(1.0, &combine(r[b], &z, -r[b], &reduced.block_at(b, u)), -1.0, &p)
    }

    /// `z` and `p` of block `b`.
    #[must_use]
    pub fn split(&self, weights: &[f64], r: &[f64], b: usize) -> (Block<K>, Block<K>) {
        let v = &self.state[b];
        if r[b] <= 0.0 {
            return ([[0.0; K]; BLOCK], [[0.0; K]; BLOCK]);
        }
        let z = shrink(v, weights[b] / r[b]);
        (z, combine(r[b], v, -r[b], &z))
    }

    /// `z`, and `p` over the weight where there is one, of all blocks.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn into_split(
        mut self,
        weights: &[f64],
        r: &[f64],
    ) -> Result<(Vec<Block<K>>, Vec<Block<K>>), SolveError> {
        (self.right, self.from_equations, self.multipliers) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = memory::room(r.len())?;
        for (b, &w) in weights.iter().enumerate() {
            let (z, p) = self.split(weights, r, b);
            self.state[b] = z;
            all.push(if w > 0.0 { scaled(1.0 / w, &p) } else { p });
        }
        Ok((self.state, all))
    }

    /// `Hᵀ(R(z − H u − c) − p)`: what the next linear solve changes `u` for.
    #[must_use]
    pub fn right(&self) -> &[[f64; K]] {
        &self.right[0]
    }

    /// `Hᵀq` for [`Sums::from_equations`] after a pass that was asked to check.
    #[must_use]
    pub fn from_equations(&self) -> &[[f64; K]] {
        &self.from_equations[0]
    }

    /// `Hᵀp` for [`Sums::multipliers`] after a pass that was asked to check;
    /// only where there is fidelity everywhere.
    #[must_use]
    pub fn multipliers(&self) -> &[[f64; K]] {
        &self.multipliers[0]
    }

    /// Takes split variables and multipliers one iteration further,
    /// from the solution `u` of the linear system.
    pub fn advance(&mut self, reduced: &Reduced<'_, K>, r: &[f64], u: &[[f64; K]], check: bool) -> Sums {
        if check {
            self.pass::<true>(reduced, r, u)
        } else {
            self.pass::<false>(reduced, r, u)
        }
    }

    fn pass<const CHECK: bool>(&mut self, reduced: &Reduced<'_, K>, r: &[f64], u: &[[f64; K]]) -> Sums {
        let parts = BlockRanges::of(r.len());
        let n = reduced.n();
        let n_multipliers = if reduced.has_fidelity_everywhere { n } else { 0 };
        let sums: Vec<Sums> = self
            .state
            .par_chunks_mut(parts.size)
            .zip(self.right.par_iter_mut().zip(&mut self.from_equations).zip(&mut self.multipliers))
            .enumerate()
            .map(|(part, (state, ((right, from_equations), multipliers)))| {
                clear(right, n);
                if CHECK {
                    clear(from_equations, n);
                    clear(multipliers, n_multipliers);
                }
                let first = part * parts.size;
                let products = [from_equations, multipliers];
                Arch::new().dispatch(Pass::<K, CHECK> { reduced, r, u, first, state, right, products })
            })
            .collect();
        gather(&mut self.right, n);
        if CHECK {
            gather(&mut self.from_equations, n);
            gather(&mut self.multipliers, n_multipliers);
        }
        sums.into_iter().fold(Sums::default(), Sums::and)
    }
}

/// The pass over the blocks of one part, to be compiled for each set of vector instructions.
struct Pass<'p, const K: usize, const CHECK: bool> {
    reduced: &'p Reduced<'p, K>,
    r: &'p [f64],
    u: &'p [[f64; K]],
    first: usize,
    state: &'p mut [Block<K>],
    right: &'p mut [[f64; K]],
    products: [&'p mut Vec<[f64; K]>; 2],
}

impl<const K: usize, const CHECK: bool> WithSimd for Pass<'_, K, CHECK> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sums {
        let mut sums = Sums::default();
        let [from_equations, multipliers] = self.products;
        for (b, v) in (self.first..).zip(self.state) {
            let (columns, values) = self.reduced.free.operator.block(b);
            let (c, w, r) = (self.reduced.constant(b), self.reduced.weights[b], self.r[b]);
            let mut h = c;
            for (&column, value) in columns.iter().zip(values) {
                add_outer(&mut h, value, &self.u[column as usize]);
            }
            sums.norms += w * norm(&h);
            if r <= 0.0 {
                continue;
            }
            let z = shrink(v, w / r);
            let apart = combine(1.0, &h, -1.0, &z);
            if CHECK {
                let p = combine(1.0, v, -1.0, &z);
                let q = combine(r, &p, r, &apart);
                sums.from_equations.add(&q, w, &c);
                for (&column, value) in columns.iter().zip(values) {
                    add_outer_transposed(&mut from_equations[column as usize], value, &q);
                }
            }
            *v = combine(1.0, v, RELAXATION, &apart);
            let z = shrink(v, w / r);
            if CHECK {
                let p = combine(r, v, -r, &z);
                sums.split += w * norm(&combine(1.0, &h, -1.0, &z));
                if !multipliers.is_empty() {
                    sums.multipliers.add(&p, w, &c);
                    for (&column, value) in columns.iter().zip(values) {
                        add_outer_transposed(&mut multipliers[column as usize], value, &p);
                    }
                }
            }
            // R(z − H u − c) − p
            let next = combine(2.0 * r, &z, -r, &combine(1.0, v, 1.0, &h));
            for (&column, value) in columns.iter().zip(values) {
                add_outer_transposed(&mut self.right[column as usize], value, &next);
            }
        }
        sums
    }
}

impl Sums {
    fn and(self, other: Self) -> Self {
        Self {
            norms: self.norms + other.norms,
            split: self.split + other.split,
            from_equations: self.from_equations.and(other.from_equations),
            multipliers: self.multipliers.and(other.multipliers),
        }
    }
}

fn clear<const K: usize>(sum: &mut Vec<[f64; K]>, n: usize) {
    sum.clear();
    sum.resize(n, [0.0; K]);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::block_rows::BlockRows;
    use crate::linear::Columns;
    use crate::solve::{Coupling, FreeOperator, Problem};

    /// Enough blocks for several parts, over columns of a ring; the first column is fixed.
    fn operator(m: usize) -> BlockRows {
        let n = m / 2;
        let entry = |b: usize, j: usize| std::array::from_fn(|r| ((5 * b + 3 * j + 7 * r) as f64).sin());
        let mut rows = BlockRows { n_columns: n, starts: vec![0], columns: vec![], values: vec![] };
        for b in 0..m {
            let mut columns: Vec<usize> = (0..4).map(|k| (b / 2 + k * k) % n).collect();
            columns.sort_unstable();
            for &j in &columns {
                rows.columns.push(j as u32);
                rows.values.push(entry(b, j));
            }
            rows.starts.push(rows.columns.len());
        }
        rows
    }

    /// Free rows may be seen by no block at all, and constraints add to the sums nevertheless.
    #[test]
    fn without_blocks_all_sums_are_zero_and_as_long_as_the_rows() {
        let operator = BlockRows::empty(3);
        let problem = Problem {
            operator: &operator,
            weights: Vec::new(),
            fidelity: vec![1.0; 3],
            target: Columns { n_rows: 3, n_columns: 1, data: vec![1.0; 3] },
            fixed: vec![false; 3],
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let free = FreeOperator::new(&operator, &problem.fixed).unwrap();
        let reduced = Reduced::<1>::new(&problem, &free, &[0]).unwrap();
        let mut sweep = Sweep::resume(&reduced, &[], &reduced.target, |_| [[0.0]; BLOCK]).unwrap();
        sweep.advance(&reduced, &[], &reduced.target, true);
        for sums in [sweep.right(), sweep.from_equations(), sweep.multipliers()] {
            assert_eq!(sums, [[0.0]; 3]);
        }
    }

    /// One iteration as it stands in the textbook, on whole vectors.
    #[test]
    fn a_pass_is_the_iteration_block_by_block() {
        let m = 20_000;
        let operator = operator(m);
        let n = operator.n_columns;
        let target =
            Columns { n_rows: n, n_columns: 2, data: (0..2 * n).map(|i| (i as f64).cos()).collect() };
        let problem = Problem {
            operator: &operator,
            weights: (0..m).map(|b| if b % 7 == 0 { 0.0 } else { 1.0 + (b % 3) as f64 }).collect(),
            fidelity: vec![1.0; n],
            target,
            fixed: (0..n).map(|i| i == 0).collect(),
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let free = FreeOperator::new(&operator, &problem.fixed).unwrap();
        let reduced = Reduced::<2>::new(&problem, &free, &[0, 1]).unwrap();
        let w = &problem.weights;
        let r: Vec<f64> = w.iter().enumerate().map(|(b, w)| w * (0.5 + (b % 5) as f64)).collect();
        let at = |b: usize, s: f64| -> Block<2> {
            std::array::from_fn(|i| std::array::from_fn(|c| (s * (b + 10 * i + 100 * c) as f64).sin()))
        };
        // Any z, and a p in the subdifferential of w‖·‖ there.
        let z: Vec<Block<2>> =
            (0..m).map(|b| if w[b] > 0.0 { at(b, 0.7) } else { [[0.0; 2]; BLOCK] }).collect();
        let p: Vec<Block<2>> = z.iter().zip(w).map(|(z, w)| scaled(w / norm(z).max(1e-300), z)).collect();
        let u: Vec<[f64; 2]> = (0..reduced.n()).map(|i| [(i as f64).sin(), (2.0 * i as f64).cos()]).collect();

        let mut sweep = Sweep::new(&reduced, &r, &u, |b| (z[b], p[b])).unwrap();
        let h = reduced.apply(&u).unwrap();
        let next =
            |z: &Block<2>, p: &Block<2>, b: usize| combine(1.0, &combine(r[b], z, -r[b], &h[b]), -1.0, p);
        let expected = reduced.apply_transposed(|b| next(&z[b], &p[b], b)).unwrap();
        let close = |a: &[[f64; 2]], b: &[[f64; 2]]| {
            a.iter().flatten().zip(b.iter().flatten()).all(|(x, y)| (x - y).abs() < 1e-9)
        };
        assert!(close(sweep.right(), &expected));

        let sums = sweep.advance(&reduced, &r, &u, true);
        let (mut q, mut apart) = (DualPoint::default(), 0.0);
        let mut q_at = vec![[[0.0; 2]; BLOCK]; m];
        let after: Vec<(Block<2>, Block<2>)> = (0..m)
            .map(|b| {
                if w[b] == 0.0 {
                    return ([[0.0; 2]; BLOCK], [[0.0; 2]; BLOCK]);
                }
                q_at[b] = combine(1.0, &p[b], r[b], &combine(1.0, &h[b], -1.0, &z[b]));
                q.add(&q_at[b], w[b], &reduced.constant(b));
                let relaxed = combine(RELAXATION, &h[b], 1.0 - RELAXATION, &z[b]);
                let new = shrink(&combine(1.0, &relaxed, 1.0 / r[b], &p[b]), w[b] / r[b]);
                apart += w[b] * norm(&combine(1.0, &h[b], -1.0, &new));
                (new, combine(1.0, &p[b], r[b], &combine(1.0, &relaxed, -1.0, &new)))
            })
            .collect();
        for (b, (z, p)) in after.iter().enumerate() {
            let (found_z, found_p) = sweep.split(w, &r, b);
            assert!(norm(&combine(1.0, &found_z, -1.0, z)) < 1e-12, "z of block {b}");
            assert!(norm(&combine(1.0, &found_p, -1.0, p)) < 1e-11, "p of block {b}");
        }
        let expected = reduced.apply_transposed(|b| next(&after[b].0, &after[b].1, b)).unwrap();
        assert!(close(sweep.right(), &expected));
        let expected = reduced.apply_transposed(|b| after[b].1).unwrap();
        assert!(close(sweep.multipliers(), &expected));
        let expected = reduced.apply_transposed(|b| q_at[b]).unwrap();
        assert!(close(sweep.from_equations(), &expected));
        let norms: f64 = h.iter().zip(w).map(|(h, w)| w * norm(h)).sum();
        assert!((sums.norms - norms).abs() < 1e-9 * norms);
        assert!((sums.split - apart).abs() < 1e-9 * apart);
        let difference = sums.from_equations.difference(&q);
        assert!(difference < 1e-9, "{difference}");
    }
}
