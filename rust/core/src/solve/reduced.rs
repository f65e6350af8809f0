//! The problem without its fixed rows: `min Σ w_b ‖(H u + c)_b‖ + Σ a_i ‖u_i − t_i‖²` subject to `A u = b`.

use std::borrow::Cow;

use crate::block_rows::BLOCK;
use crate::error::SolveError;
use crate::memory;
use crate::solve::cones::{norm, Block};
use crate::solve::constraints::LinearConstraints;
use crate::solve::free_operator::FreeOperator;
use crate::solve::problem::Problem;
use rayon::prelude::*;

/// Blocks or rows that one thread takes at least: below that the hand-over costs more than the work.
pub(super) const GRAIN: usize = 4096;

/// A transposed product has at most this many partial sums, each as long as the result.
const MOST_PARTS: usize = 4;

/// How the blocks are cut into parts that threads take, each with sums of its own: by the number of blocks
/// alone, so that results do not depend on the number of threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BlockRanges {
    /// Blocks in each part but the last.
    pub size: usize,
    /// Number of parts, at least one.
    pub count: usize,
}

impl BlockRanges {
    /// The parts of `m` blocks.
    #[must_use]
    pub(super) fn of(m: usize) -> Self {
        let size = m.div_ceil(MOST_PARTS).max(GRAIN);
        Self { size, count: m.div_ceil(size).max(1) }
    }

    /// The blocks of a part.
    fn range(self, part: usize, m: usize) -> std::ops::Range<usize> {
        part * self.size..((part + 1) * self.size).min(m)
    }
}

/// One convex problem in `K` columns with joint norms, free rows only (Rowe et al. 2024, eq. (21)).
#[derive(Debug)]
pub struct Reduced<'a, const K: usize> {
    /// `H` and who is free.
    pub free: &'a FreeOperator<'a>,
    /// How many of the `K` columns are in use; the others are zero.
    pub n_columns: usize,
    /// `c`: what the fixed rows contribute; empty where none is fixed.
    constant: Vec<Block<K>>,
    /// `Σ w ‖c‖` over the blocks that see fixed rows only: part of every objective and every bound.
    pub offset: f64,
    /// `w`.
    pub weights: Cow<'a, [f64]>,
    /// `a` on the free rows.
    pub fidelity: Vec<f64>,
    /// Whether every free row has some: then every dual point with blocks short enough gives a bound.
    pub has_fidelity_everywhere: bool,
    /// `t` on the free rows.
    pub target: Vec<[f64; K]>,
    /// `A` and `b` on the free rows.
    pub constraints: Option<LinearConstraints<K>>,
}

impl<'a, const K: usize> Reduced<'a, K> {
    /// Eliminates the fixed rows of the `columns` of `problem` (at most `K`; missing ones count as zero).
    ///
    /// # Errors
    /// [`SolveError::Infeasible`] when a linear constraint speaks of fixed rows only and contradicts them.
    pub fn new(
        problem: &'a Problem<'_>,
        free: &'a FreeOperator<'a>,
        columns: &[usize],
    ) -> Result<Self, SolveError> {
        let row_of = |i: usize| -> [f64; K] {
            std::array::from_fn(|c| columns.get(c).map_or(0.0, |&column| problem.target.column(column)[i]))
        };
        let target: Vec<[f64; K]> = memory::gathered(free.free.iter().map(|&i| row_of(i as usize)))?;
        let fidelity = memory::gathered(free.free.iter().map(|&i| problem.fidelity[i as usize]))?;
        let has_fidelity_everywhere = fidelity.iter().all(|a: &f64| *a > 0.0);
        let mut constant = Vec::new();
        let mut offset = 0.0;
        if let Some(blocks) = &free.blocks {
            constant = memory::room(blocks.len())?;
            let mut left = blocks.iter().peekable();
            for b in 0..problem.operator.n_blocks() {
                let mut sum = [[0.0; K]; BLOCK];
                let (block_columns, values) = problem.operator.block(b);
                for (&column, value) in block_columns.iter().zip(values) {
                    if free.place[column as usize].is_none() {
                        add_outer(&mut sum, value, &row_of(column as usize));
                    }
                }
                if left.next_if(|&&next| next as usize == b).is_some() {
                    constant.push(sum);
                } else {
                    offset += problem.weights[b] * norm(&sum);
                }
            }
        }
        let constraints = match &problem.linear_constraints {
            None => None,
            Some((matrix, right)) => Some(LinearConstraints::new(matrix, right, free, columns, &row_of)?),
        };
        let weights = free.of_blocks(&problem.weights)?;
        Ok(Self {
            free,
            n_columns: columns.len(),
            constant,
            offset,
            weights,
            fidelity,
            has_fidelity_everywhere,
            target,
            constraints,
        })
    }

    /// Number of free rows.
    #[must_use]
    pub fn n(&self) -> usize {
        self.target.len()
    }

    /// Number of blocks.
    #[must_use]
    pub fn n_blocks(&self) -> usize {
        self.free.operator.n_blocks()
    }

    /// `c` of block `b`: what the fixed rows contribute.
    #[inline(always)]
    #[must_use]
    pub fn constant(&self, b: usize) -> Block<K> {
        self.constant.get(b).copied().unwrap_or([[0.0; K]; BLOCK])
    }

    /// `H u + c`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn apply(&self, u: &[[f64; K]]) -> Result<Vec<Block<K>>, SolveError> {
        self.product(|b| self.constant(b), u)
    }

    /// `‖H u + c‖` of each block.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn lengths(&self, u: &[[f64; K]]) -> Result<Vec<f64>, SolveError> {
        let mut out = memory::room(self.n_blocks())?;
        let sums = (0..self.n_blocks()).into_par_iter().with_min_len(GRAIN);
        sums.map(|b| norm(&self.block_at(b, u))).collect_into_vec(&mut out);
        Ok(out)
    }

    /// `H u`, of a change of the point.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn apply_change(&self, u: &[[f64; K]]) -> Result<Vec<Block<K>>, SolveError> {
        self.product(|_| [[0.0; K]; BLOCK], u)
    }

    fn product(
        &self,
        to: impl Fn(usize) -> Block<K> + Sync,
        u: &[[f64; K]],
    ) -> Result<Vec<Block<K>>, SolveError> {
        let mut out = memory::room(self.n_blocks())?;
        let sums = (0..self.n_blocks()).into_par_iter().with_min_len(GRAIN);
        sums.map(|b| self.block_added(to(b), b, u)).collect_into_vec(&mut out);
        Ok(out)
    }

    /// Block `b` of `H u + c`.
    #[inline(always)]
    #[must_use]
    pub fn block_at(&self, b: usize, u: &[[f64; K]]) -> Block<K> {
        self.block_added(self.constant(b), b, u)
    }

    /// Block `b` of `H u`.
    #[inline(always)]
    #[must_use]
    pub fn block_times(&self, b: usize, u: &[[f64; K]]) -> Block<K> {
        self.block_added([[0.0; K]; BLOCK], b, u)
    }

    #[inline(always)]
    fn block_added(&self, mut sum: Block<K>, b: usize, u: &[[f64; K]]) -> Block<K> {
        let (columns, values) = self.free.operator.block(b);
        for (&column, value) in columns.iter().zip(values) {
            add_outer(&mut sum, value, &u[column as usize]);
        }
        sum
    }

    /// `Hᵀ y`, for a `y` given block by block.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn apply_transposed(
        &self,
        y: impl Fn(usize) -> Block<K> + Sync,
    ) -> Result<Vec<[f64; K]>, SolveError> {
        let parts = BlockRanges::of(self.n_blocks());
        let mut sums: Vec<Vec<[f64; K]>> = (0..parts.count)
            .into_par_iter()
            .map(|part| {
                let mut sum = memory::repeated([0.0; K], self.n())?;
                for b in parts.range(part, self.n_blocks()) {
                    let at = y(b);
                    let (columns, values) = self.free.operator.block(b);
                    for (&column, value) in columns.iter().zip(values) {
                        add_outer_transposed(&mut sum[column as usize], value, &at);
                    }
                }
                Ok(sum)
            })
            .collect::<Result<_, SolveError>>()?;
        gather(&mut sums, self.n());
        Ok(sums.swap_remove(0))
    }

    /// The objective at `u`, where the blocks of `H u + c` have these lengths.
    #[must_use]
    pub fn objective(&self, u: &[[f64; K]], lengths: impl Iterator<Item = f64>) -> f64 {
        let norms: f64 = lengths.zip(self.weights.iter()).map(|(x, w)| w * x).sum();
        self.offset + norms + self.fidelity_term(u)
    }

    /// Below this an objective counts as zero: a millionth of the objective at the target, or 1e-9 of what
    /// that would be if the terms of `H t + c` did not cancel, whichever is larger. The blocks of `H t + c`
    /// have these `lengths`.
    #[must_use]
    pub fn floor(&self, lengths: &[f64]) -> f64 {
        let operator = &self.free.operator;
        let mut without_cancelling = self.offset;
        for (b, w) in self.weights.iter().enumerate() {
            let (columns, values) = operator.block(b);
            let terms = columns.iter().zip(values).map(|(&j, v)| {
                let row = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                row * self.target[j as usize].iter().map(|x| x * x).sum::<f64>().sqrt()
            });
            without_cancelling += w * (norm(&self.constant(b)) + terms.sum::<f64>());
        }
        (1e-6 * self.objective(&self.target, lengths.iter().copied())).max(1e-9 * without_cancelling)
    }

    /// `Σ a_i ‖u_i − t_i‖²`.
    #[must_use]
    pub fn fidelity_term(&self, u: &[[f64; K]]) -> f64 {
        let mut sum = 0.0;
        for ((x, t), a) in u.iter().zip(&self.target).zip(&self.fidelity) {
            if *a > 0.0 {
                sum += a * x.iter().zip(t).map(|(p, q)| (p - q) * (p - q)).sum::<f64>();
            }
        }
        sum
    }
}

/// Adds all partial sums of `n` rows to the first, in their order; without blocks it is zero.
pub(super) fn gather<const K: usize>(parts: &mut [Vec<[f64; K]>], n: usize) {
    let Some((whole, rest)) = parts.split_first_mut() else {
        return;
    };
    whole.resize(n, [0.0; K]);
    for part in rest {
        for (sum, more) in whole.iter_mut().zip(part.iter()) {
            sum.iter_mut().zip(more).for_each(|(s, x)| *s += x);
        }
    }
}

/// `sum += value ⊗ x`.
#[inline(always)]
pub(super) fn add_outer<const K: usize>(sum: &mut Block<K>, value: &[f64; BLOCK], x: &[f64; K]) {
    for r in 0..BLOCK {
        for c in 0..K {
            sum[r][c] += value[r] * x[c];
        }
    }
}

/// `sum += valueᵀ x`.
#[inline(always)]
pub(super) fn add_outer_transposed<const K: usize>(sum: &mut [f64; K], value: &[f64; BLOCK], x: &Block<K>) {
    for r in 0..BLOCK {
        for c in 0..K {
            sum[c] += value[r] * x[r][c];
        }
    }
}
