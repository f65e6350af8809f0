//! A problem on several connected pieces: each is solved by itself, and certificates add up.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::block_rows::BlockRows;
use crate::progress::Report;
use crate::solve::fast::MAX_ITERATIONS;
use crate::solve::pieces::{at, Pieces};
use crate::solve::problem::{Problem, Settings, Solution, Status};
use crate::solve::single::{Call, Single, Total};
use crate::{memory, Result};

/// After so many iterations of a piece, and twice as many, and so on, it is asked what the others have left
/// it of the gap.
///
/// Of the letters of a text two come to a gap of 1.2e-2 and 1.6e-3 in 3000 iterations, for slivers; the
/// others take 9 to 12 to 1e-3, and what they leave is enough for all. Houses under noise take 18 to 39.
const FIRST_ITERATIONS: usize = 60;

/// A problem and the operators of its pieces.
pub(super) struct Apart<'a> {
    pieces: &'a Pieces,
    problem: &'a Problem<'a>,
    operators: Vec<BlockRows>,
    call: &'a Call<'a>,
}

impl<'a> Apart<'a> {
    /// Divides `problem`, and where a limit of memory is set, analyzes the pieces for factors that keep it
    /// together.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`], or [`crate::Error::Cancelled`].
    pub(super) fn new(
        pieces: &'a Pieces,
        problem: &'a Problem<'a>,
        call: &'a Call<'a>,
        singles: &mut [Single],
    ) -> Result<Self> {
        let mut operators = memory::room(singles.len())?;
        let mut left = call.settings.memory_limit;
        for (p, single) in singles.iter_mut().enumerate() {
            call.progress.check()?;
            let operator = pieces.operator(problem.operator, p)?;
            if let Some(left) = &mut left {
                single.analyze(
                    &operator,
                    &at(&problem.fixed, pieces.rows(p))?,
                    Some(*left),
                    call.progress,
                )?;
                *left = left.saturating_sub(single.factor_bytes());
            }
            operators.push(operator);
        }
        Ok(Self { pieces, problem, operators, call })
    }

    /// Solves every piece by itself.
    ///
    /// Those that have not come far enough after [`FIRST_ITERATIONS`], and each time these have doubled, go
    /// on only if the whole has not either, and as far as the whole needs it.
    ///
    /// # Errors
    /// Those of the solver, or [`crate::Error::Cancelled`].
    pub(super) fn solve(&self, singles: &mut [Single]) -> Result<Solution> {
        let Settings { tolerance, max_iterations, .. } = *self.call.settings;
        let most = max_iterations.unwrap_or(MAX_ITERATIONS);
        // Without a gap to certify there is nothing to share.
        let mut made = if tolerance.is_some() { most.min(FIRST_ITERATIONS) } else { most };
        let settings = Settings { max_iterations: Some(made), announce: false, ..*self.call.settings };
        let done = AtomicUsize::new(0);
        let all = singles.par_iter_mut().enumerate().map(|(p, single)| {
            let solution = self.run(p, single, &settings, p > 0)?;
            let n_rows = self.pieces.rows(p).len();
            self.report(done.fetch_add(n_rows, Ordering::Relaxed) + n_rows);
            Ok(solution)
        });
        let mut solutions = memory::all(memory::joined(all)?)?;
        while let (Some(tolerance), true) = (what_is_left(&solutions, tolerance), made < most) {
            let further = made.min(most - made);
            made += further;
            let settings = Settings { tolerance: Some(tolerance), max_iterations: Some(further), ..settings };
            let rest = singles.par_iter_mut().zip(&mut solutions).enumerate();
            let rest = rest.map(|(p, (single, solution))| {
                if solution.status == Status::Inaccurate {
                    take(self.run(p, single, &settings, true)?, solution);
                }
                Ok(())
            });
            memory::all(memory::joined(rest)?)?;
        }
        let mut total = Total::new(self.problem, self.call.method)?;
        for (p, solution) in solutions.iter().enumerate() {
            total.add_piece(solution, self.pieces, p);
        }
        let mut solution = total.into_solution();
        if tolerance.is_some_and(|tolerance| solution.gap <= tolerance) {
            solution.status = Status::Solved;
        }
        Ok(solution)
    }

    fn run(&self, p: usize, single: &mut Single, settings: &Settings, may_skip: bool) -> Result<Solution> {
        let (problem, rows) = (self.problem, self.pieces.rows(p));
        let of_piece = Problem {
            operator: &self.operators[p],
            weights: at(&problem.weights, self.pieces.blocks(p))?,
            fidelity: at(&problem.fidelity, rows)?,
            target: self.pieces.columns(&problem.target, p)?,
            fixed: at(&problem.fixed, rows)?,
            linear_constraints: None,
            coupling: problem.coupling,
        };
        single.run(&of_piece, &Call { settings, may_skip, ..*self.call })
    }

    fn report(&self, n_done: usize) {
        if self.call.settings.announce {
            let fraction = n_done as f64 / self.pieces.n_rows() as f64;
            self.call.progress.report(Report { fraction, stage: "solving".into(), ..Report::default() });
        }
    }
}

/// The tolerance for pieces that have not been solved: what the others leave of the gap that the whole may
/// have. Nothing where the whole is solved, or no piece is left that goes on.
fn what_is_left(solutions: &[Solution], tolerance: Option<f64>) -> Option<f64> {
    let tolerance = tolerance?;
    let is_open = |solution: &&Solution| solution.status == Status::Inaccurate;
    let gap = |solution: &Solution| solution.objective - solution.dual_objective;
    let sum = |of: fn(&Solution) -> f64| solutions.iter().map(of).sum::<f64>();
    // The objective can only fall to the bound.
    let allowed = tolerance * Problem::gap_scale(sum(|s| s.dual_objective), sum(|s| s.floor));
    let scale: f64 = solutions.iter().filter(is_open).map(|s| Problem::gap_scale(s.objective, s.floor)).sum();
    if scale <= 0.0 || sum(gap) <= allowed {
        return None;
    }
    let taken: f64 = solutions.iter().filter(|s| !is_open(s)).map(gap).sum();
    Some(tolerance.max((allowed - taken) / scale))
}

/// The better of a solution and a `further` one, with the better bound.
fn take(further: Solution, solution: &mut Solution) {
    solution.dual_objective = solution.dual_objective.max(further.dual_objective);
    if further.objective < solution.objective {
        (solution.values, solution.objective) = (further.values, further.objective);
    }
    let scale = Problem::gap_scale(solution.objective, solution.floor);
    solution.gap = ((solution.objective - solution.dual_objective) / scale).max(0.0);
    solution.status = further.status;
    solution.iterations += further.iterations;
    solution.factorisations += further.factorisations;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Columns;
    use crate::solve::Solver;

    fn solution(objective: f64, dual_objective: f64, status: Status) -> Solution {
        Solution {
            values: Columns::from_column(vec![objective]),
            objective,
            dual_objective,
            floor: 0.0,
            gap: (objective - dual_objective) / objective,
            iterations: 60,
            factorisations: 3,
            status,
            solver: Solver::Fast,
        }
    }

    #[test]
    fn a_piece_that_is_hard_to_bound_may_take_what_the_others_leave() {
        let solved = solution(100.0, 99.96, Status::Solved);
        let open = |bound| solution(2.0, bound, Status::Inaccurate);
        assert_eq!(what_is_left(std::slice::from_ref(&solved), Some(1e-3)), None);
        assert_eq!(what_is_left(&[solved.clone(), open(1.95)], Some(1e-3)), None);
        let left = what_is_left(&[solved.clone(), open(1.5)], Some(1e-3));
        assert!(left.is_some_and(|left| (left - (1e-3 * 101.46 - 0.04) / 2.0).abs() < 1e-12));
        assert_eq!(what_is_left(&[solved, open(1.5)], None), None);
    }

    #[test]
    fn the_better_point_and_the_better_bound_are_kept() {
        let mut found = solution(2.0, 1.5, Status::Inaccurate);
        take(solution(2.5, 1.75, Status::Stopped), &mut found);
        assert_eq!((found.objective, found.dual_objective, found.gap), (2.0, 1.75, 0.125));
        assert_eq!((found.values.data[0], found.iterations, found.status), (2.0, 120, Status::Stopped));
        take(solution(1.75, 1.25, Status::Solved), &mut found);
        assert_eq!((found.values.data[0], found.gap, found.status), (1.75, 0.0, Status::Solved));
    }
}
