//! Quadratic energies: `min ½ Σ_b w_b ‖(H u)_b‖² + Σ_i a_i ‖u_i − t_i‖²` with fixed rows and `A u = b`,
//! by one factorization.
//!
//! The factored matrix carries a shift where the energy alone may not determine `u`; conjugate gradients with
//! that factor as preconditioner (projected on `A u = 0`, Gould, Hribar and Nocedal 2001) take its effect out
//! again. Where there is no shift the first step is exact and the second one is iterative refinement.

use crate::block_rows::BlockRows;
use crate::error::SolveError;
use crate::linear::cholesky::Cholesky;
use crate::linear::conjugate_gradients::{descend, Quadratic, Step};
use crate::progress::Progress;
use crate::solve::constraints::LinearConstraints;
use crate::solve::free_operator::FreeOperator;
use crate::solve::normal_matrix::NormalMatrix;
use crate::solve::problem::{Problem, Settings, Solution, Solver, Status};
use crate::{memory, Error, Result};

/// Steps stop when one more would lower the objective by less than this part of it.
const ENOUGH: f64 = 1e-14;

/// What rounding leaves of a sum of squares whose terms cancel, as a part of their size: 1e-9 squared.
const ROUNDING: f64 = 1e-18;

/// Minimizes the quadratic reading of `problem`, column by column (its coupling does not matter).
///
/// The problem of Rowe et al. 2024, eq. (21) with squared norms.
///
/// The gap of the solution is the decrease of the objective that one more step with the factored matrix would
/// bring, relative like [`Solution::gap`]; without a shift it is the distance to the optimum up to rounding.
/// Weights may be negative as long as the problem stays convex. Rows of `u` that nothing determines keep
/// their target. So do columns that are not begun when the caller wishes to finish, if 0 is a bound of what
/// they cost.
///
/// # Errors
/// Arguments that do not fit, constraints that contradict or repeat each other, a problem that is not convex,
/// or [`Error::Cancelled`].
pub fn minimize(problem: &Problem<'_>, settings: &Settings, progress: &Progress) -> Result<Solution> {
    problem.check_shapes()?;
    let free = FreeOperator::new(problem.operator, &problem.fixed)?;
    let mut newton = Newton::new(problem, &free, settings, progress)?;
    let mut values = problem.target.copied()?;
    let (mut total, mut is_stopped) = (Totals::default(), false);
    for c in 0..values.n_columns {
        progress.check()?;
        if c > 0 && newton.may_stay && progress.is_finishing() {
            newton.leave(c, &mut total);
            is_stopped = true;
        } else {
            newton.column(c, values.column_mut(c), &mut total, progress)?;
        }
    }
    let gap = total.decrease / Problem::gap_scale(total.objective, total.floor);
    let reached = gap <= newton.goal;
    Ok(Solution {
        values,
        objective: total.objective,
        dual_objective: total.objective - total.decrease,
        floor: total.floor,
        gap,
        iterations: total.steps,
        factorisations: newton.cholesky.n_factorizations(),
        status: match (is_stopped, reached) {
            (true, _) => Status::Stopped,
            (false, true) => Status::Solved,
            (false, false) => Status::Inaccurate,
        },
        solver: Solver::Cholesky,
    })
}

/// The sums over columns.
#[derive(Default)]
struct Totals {
    objective: f64,
    floor: f64,
    decrease: f64,
    steps: usize,
}

/// The factored matrix on the free rows.
struct Newton<'a> {
    problem: &'a Problem<'a>,
    free: &'a FreeOperator<'a>,
    cholesky: Cholesky,
    shift: Shift,
    /// Whether the target is an answer, and costs 0 at least.
    may_stay: bool,
    /// The gap at which the problem counts as solved.
    goal: f64,
}

/// What the shift is a part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shift {
    /// The mean of the diagonal.
    Mean,
    /// Each entry of the diagonal: where these are many orders apart, as around slivers, a part of their mean
    /// outweighs the small ones, and the factor is that of another matrix.
    Each,
}

impl<'a> Newton<'a> {
    fn new(
        problem: &'a Problem<'a>,
        free: &'a FreeOperator<'a>,
        settings: &Settings,
        progress: &Progress,
    ) -> Result<Self> {
        let negative = problem.weights.iter().any(|w| *w < 0.0);
        let normal = normal_matrix(problem, free, progress)?;
        let mut newton = Self {
            problem,
            free,
            cholesky: Cholesky::analyze(normal.pattern(), settings.memory_limit, progress)?,
            shift: Shift::Mean,
            may_stay: !negative && problem.linear_constraints.is_none(),
            goal: settings.tolerance.unwrap_or(ENOUGH.sqrt()),
        };
        newton.factorize(&normal, Shift::Mean, progress)?;
        Ok(newton)
    }

    fn factorize(&mut self, normal: &NormalMatrix, kind: Shift, progress: &Progress) -> Result<()> {
        /// The shift as a part of the diagonal: above rounding in the factorization, below the smallest
        /// eigenvalue of well posed problems up to some 100k vertices.
        const SHIFT: f64 = 1e-13;
        /// The same with linear constraints that may have to hold the kernel of the energy: small dense
        /// pivots of the constraints are told from dependent ones down to 1e-12.
        const SHIFT_UNDER_CONSTRAINTS: f64 = 1e-9;
        /// How much larger a shift is tried when the factorization fails, and how large it gets.
        const SHIFT_GROWTH: f64 = 100.0;
        const LARGEST_SHIFT: f64 = 1e-6;
        self.shift = kind;
        let (problem, free) = (self.problem, self.free);
        if free.free.is_empty() {
            return Ok(());
        }
        // Negative weights tell of a matrix that may not be definite.
        let negative = problem.weights.iter().any(|w| *w < 0.0);
        let twice: Vec<f64> =
            memory::gathered(free.free.iter().map(|&i| 2.0 * problem.fidelity[i as usize]))?;
        let mut values = memory::room(normal.pattern().rows.len())?;
        normal.assemble(&free.operator, &free.of_blocks(&problem.weights)?, &twice, &mut values);
        let starts = &normal.pattern().starts[..twice.len()];
        let diagonal: Vec<f64> = memory::gathered(starts.iter().map(|&s| values[s]))?;
        let mean = diagonal.iter().map(|d| d.abs()).sum::<f64>() / diagonal.len() as f64;
        let scale = if mean > 0.0 { mean } else { 1.0 };
        let mut shift = match problem.linear_constraints {
            _ if twice.iter().all(|a| *a > 0.0) => 0.0,
            None => SHIFT,
            Some(_) => SHIFT_UNDER_CONSTRAINTS,
        };
        // With negative weights a matrix that is far from definite tells of a problem that is not convex.
        let largest = if negative && problem.linear_constraints.is_none() {
            SHIFT_GROWTH * SHIFT
        } else {
            LARGEST_SHIFT
        };
        loop {
            for (&s, d) in normal.pattern().starts.iter().zip(&diagonal) {
                let whole = if kind == Shift::Mean { scale } else { d.abs() };
                // A row without an entry would make the matrix singular; nothing pulls at it,
                // so it stays where it is.
                values[s] = if *d == 0.0 { scale } else { d + shift * whole };
            }
            match self.cholesky.factorize(&values, progress) {
                Ok(()) => return Ok(()),
                Err(error) if !matches!(error, Error::Solve(SolveError::Factorization { .. })) => {
                    return Err(error);
                }
                Err(_) if shift < largest => shift = (SHIFT_GROWTH * shift).max(SHIFT),
                Err(_) if negative => return Err(not_convex()),
                Err(error) => return Err(error),
            }
        }
    }

    /// Leaves column `c` at its target: it could cost less by all that it costs.
    fn leave(&self, c: usize, total: &mut Totals) {
        let target = self.problem.target.column(c);
        let at_target = self.objective(target, target);
        total.floor += (1e-6 * at_target).max(ROUNDING * self.without_cancelling(target));
        total.decrease += at_target;
        total.objective += at_target;
    }

    /// Minimizes over the free rows of column `c`; `u` holds the target before.
    fn column(&mut self, c: usize, u: &mut [f64], total: &mut Totals, progress: &Progress) -> Result<()> {
        /// Steps at most after the first; well posed problems take one or two, those with a large shift some
        /// ten.
        const MOST_STEPS: usize = 299;
        /// Steps that go for all digits with a shift that is the same everywhere, where another may help.
        const FIRST_STEPS: usize = 20;
        /// After these, the part of the gap that counts as solved which is left.
        const CLEARLY: f64 = 0.1;
        let target = self.problem.target.column(c);
        let at_target = self.objective(u, target);
        let rounding = ROUNDING * self.without_cancelling(target);
        total.floor += (1e-6 * at_target).max(rounding);
        let scale = Problem::gap_scale(at_target, rounding);
        let mut constraints = self.constraints(c)?;
        if let Some(constraints) = &mut constraints {
            constraints.prepare(&mut self.cholesky, self.free.free.len())?;
        }
        // One step from the target, corrected to satisfy the constraints.
        let mut point = self.descent(u, target)?;
        self.cholesky.solve(&mut point)?;
        point.iter_mut().zip(&self.free.free).for_each(|(x, &i)| x[0] += u[i as usize]);
        if let Some(constraints) = &mut constraints {
            constraints.correct(&mut point);
            constraints.right.fill([0.0]);
        }
        point.iter().zip(&self.free.free).for_each(|(x, &i)| u[i as usize] = x[0]);
        total.steps += 1;

        let residual = self.descent(u, target)?;
        let (enough, most) = (2.0 * ENOUGH * ENOUGH.sqrt() * scale, [MOST_STEPS, FIRST_STEPS]);
        let most = most[usize::from(self.may_stay)];
        let mut descending = Descending { newton: self, u, target, constraints, progress };
        let mut run = descend(&mut descending, residual, |_| enough, most)?;
        if run.iterations == FIRST_STEPS && most == FIRST_STEPS && run.length > enough {
            total.steps += run.iterations;
            if self.shift == Shift::Mean {
                let normal = normal_matrix(self.problem, self.free, progress)?;
                self.factorize(&normal, Shift::Each, progress)?;
            }
            let scale = Problem::gap_scale(self.objective(u, target), rounding);
            let (residual, enough) = (self.descent(u, target)?, 2.0 * CLEARLY * self.goal * scale);
            let mut descending = Descending { newton: self, u, target, constraints: None, progress };
            run = descend(&mut descending, residual, |_| enough, MOST_STEPS - FIRST_STEPS)?;
        }
        // In the kernel up to rounding there is nothing to gain; clearly below it, everything.
        if run.flat.is_some_and(|cosine| cosine < -1e-6) {
            return Err(not_convex());
        }
        total.steps += run.iterations;
        total.decrease += 0.5 * run.length.max(0.0);
        total.objective += self.objective(u, target);
        Ok(())
    }

    fn constraints(&self, c: usize) -> Result<Option<LinearConstraints<1>>> {
        let target = self.problem.target.column(c);
        let Some((matrix, right)) = &self.problem.linear_constraints else { return Ok(None) };
        Ok(Some(LinearConstraints::new(matrix, right, self.free, &[c], &|i| [target[i]])?))
    }

    /// What leads down, the gradient with the other sign, on the free rows.
    fn descent(&self, u: &[f64], target: &[f64]) -> Result<Vec<[f64; 1]>> {
        let mut all = self.problem.operator.normal_times(&self.problem.weights, u)?;
        for (i, g) in all.iter_mut().enumerate() {
            *g += 2.0 * self.problem.fidelity[i] * (u[i] - target[i]);
        }
        Ok(memory::gathered(self.free.free.iter().map(|&i| [-all[i as usize]]))?)
    }

    fn objective(&self, u: &[f64], target: &[f64]) -> f64 {
        let term = |(b, w): (usize, &f64)| 0.5 * w * squared(self.problem.operator.block_times(b, u));
        let energy: f64 = self.problem.weights.iter().enumerate().map(term).sum();
        let distances = u.iter().zip(target).zip(&self.problem.fidelity);
        energy + distances.map(|((x, t), a)| a * (x - t) * (x - t)).sum::<f64>()
    }

    /// The energy at `u` if no two terms of `H u` had opposite signs: what rounding is measured against.
    fn without_cancelling(&self, u: &[f64]) -> f64 {
        let size = |operator: &BlockRows, b: usize| {
            let (columns, values) = operator.block(b);
            let terms = columns.iter().zip(values).map(|(&j, v)| squared(*v).sqrt() * u[j as usize].abs());
            terms.sum::<f64>().powi(2)
        };
        let weights = self.problem.weights.iter().enumerate();
        weights.map(|(b, w)| 0.5 * w.abs() * size(self.problem.operator, b)).sum()
    }
}

/// Where conjugate gradients are on one column.
struct Descending<'a, 'b> {
    newton: &'a mut Newton<'b>,
    u: &'a mut [f64],
    target: &'a [f64],
    constraints: Option<LinearConstraints<1>>,
    progress: &'a Progress,
}

impl Quadratic<1> for Descending<'_, '_> {
    /// The second derivative times a direction, both on the free rows.
    fn times(&mut self, direction: &[[f64; 1]]) -> Result<Vec<[f64; 1]>> {
        self.progress.check()?;
        let (problem, free) = (self.newton.problem, &self.newton.free.free);
        let mut whole = memory::repeated(0.0, self.u.len())?;
        direction.iter().zip(free).for_each(|(d, &i)| whole[i as usize] = d[0]);
        let product = problem.operator.normal_times(&problem.weights, &whole)?;
        let entry = |&i: &u32| product[i as usize] + 2.0 * problem.fidelity[i as usize] * whole[i as usize];
        Ok(memory::gathered(free.iter().map(|i| [entry(i)]))?)
    }

    /// The factored matrix's inverse times the residual, projected on the kernel of the constraints,
    /// whose right side is zero.
    ///
    /// What the constraints hold is taken out of the residual first: left in, its rounding would outgrow the
    /// rest (Gould, Hribar and Nocedal 2001, section 6).
    fn precondition(&mut self, residual: &mut [[f64; 1]]) -> Result<Vec<[f64; 1]>> {
        /// Times that the multipliers of the constraints are taken out of a gradient: the second leaves
        /// rounding.
        const PROJECTIONS: usize = 2;
        let mut z = memory::twin(residual)?;
        self.newton.cholesky.solve(&mut z)?;
        if let Some(constraints) = &self.constraints {
            for _ in 0..PROJECTIONS {
                let held: Vec<[f64; 1]> = constraints.correct(&mut z).into_iter().map(|y| [-y[0]]).collect();
                constraints.add_transposed(&held, residual);
                z.copy_from_slice(residual);
                self.newton.cholesky.solve(&mut z)?;
            }
            constraints.correct(&mut z);
        }
        Ok(z)
    }

    /// The residual is computed anew: that is iterative refinement. A step up is rounding,
    /// which has the last word.
    fn go(&mut self, step: &Step<'_, 1>, residual: &mut [[f64; 1]]) -> Result<bool> {
        let free = &self.newton.free.free;
        let before = self.newton.objective(self.u, self.target);
        let old: Vec<f64> = memory::gathered(free.iter().map(|&i| self.u[i as usize]))?;
        step.direction.iter().zip(free).for_each(|(d, &i)| self.u[i as usize] += step.far * d[0]);
        if self.newton.objective(self.u, self.target) > before {
            old.iter().zip(free).for_each(|(x, &i)| self.u[i as usize] = *x);
            return Ok(false);
        }
        residual.copy_from_slice(&self.newton.descent(self.u, self.target)?);
        Ok(true)
    }
}

/// The matrix of the free rows. A cut block with a negative weight makes any that is not definite.
fn normal_matrix(
    problem: &Problem<'_>,
    free: &FreeOperator<'_>,
    progress: &Progress,
) -> Result<NormalMatrix> {
    if problem.weights.iter().any(|w| *w < 0.0) {
        return NormalMatrix::new(&free.operator);
    }
    NormalMatrix::stretched(&free.operator, progress)
}

fn squared(x: [f64; 3]) -> f64 {
    x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
}

fn not_convex() -> Error {
    Error::Solve(SolveError::Infeasible {
        reason: concat!(
            "this energy is not convex on this mesh with these fixed values; fix more vertices, raise the ",
            "fidelity, or use another energy"
        )
        .into(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::linear::Columns;
    use crate::solve::Coupling;

    /// A soft chain, beside ends of stiff springs: the mean of the diagonal is theirs.
    #[test]
    fn what_is_twenty_orders_apart_takes_few_steps() {
        let (n_soft, n) = (2000, 2010);
        let spring = |a, b| [(a, [-1.0, 0.0, 0.0]), (b, [1.0, 0.0, 0.0])];
        let mut operator = BlockRows::with_room(n, n, 2 * n).unwrap();
        (1..n_soft as u32).for_each(|i| operator.push_block(spring(i - 1, i)));
        (n_soft as u32..n as u32).for_each(|i| operator.push_block(spring(0, i)));
        let last = n_soft - 1;
        let problem = Problem {
            operator: &operator,
            weights: (1..n).map(|i| if i < n_soft { 1.0 } else { 1e20 }).collect(),
            fidelity: vec![0.0; n],
            target: Columns::from_column((0..n).map(|i| if i == last { 1.0 } else { 0.0 }).collect()),
            fixed: (0..n).map(|i| i == 0 || i == last).collect(),
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let solution = minimize(&problem, &Settings::default(), &Progress::new()).unwrap();
        assert!(solution.iterations < 40, "{}", solution.iterations);
        let expected = |i: usize| if i < n_soft { i as f64 / last as f64 } else { 0.0 };
        let off = |(i, x): (usize, &f64)| (x - expected(i)).abs();
        let worst = solution.values.data.iter().enumerate().map(off).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst}");
    }
}
