//! What holds of every answer before it is handed out: it is a number, near what went in,
//! and claims no more than is so.

use crate::error::{Error, SolveError};
use crate::linear::Columns;
use crate::solve::{Problem, Settings, Solution, Status};
use crate::unit::Unit;
use crate::Result;

/// No point of an answer is farther from the box around what went in than this many times the box's longest
/// side.
///
/// A step of the flow weighs moving against bending and stays within the box of sound meshes; where triangles
/// are so uneven that the factorization has no correct digit left, points end up anywhere (1e66 was seen on a
/// mesh of size 1e30).
const FARTHEST: f64 = 10.0;

/// The box around points that went in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings {
    low: [f64; 3],
    high: [f64; 3],
}

impl Surroundings {
    /// Around `points` as far as an answer may reach.
    pub(crate) fn of<'p>(points: impl IntoIterator<Item = &'p [f64; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
            }
        }
        let reach = (0..3).fold(0.0_f64, |side, c| side.max(high[c] - low[c])) * FARTHEST;
        Self { low: low.map(|x| x - reach), high: high.map(|x| x + reach) }
    }

    /// Whether all of `points` are there; what is not a number is nowhere.
    pub(crate) fn hold<'p>(&self, points: impl IntoIterator<Item = &'p [f64; 3]>) -> bool {
        points.into_iter().all(|p| (0..3).all(|c| p[c] >= self.low[c] && p[c] <= self.high[c]))
    }
}

/// The refusal of an answer that is no number or has left its surroundings.
pub(crate) fn refused() -> Error {
    Error::Solve(SolveError::Uneven)
}

/// Makes `solution` claim what is so: the objective is that of the values handed out,
/// and the gap and the status follow.
///
/// # Errors
/// [`SolveError::Uneven`] for values or an objective that are no numbers.
pub(super) fn settle(
    solution: &mut Solution,
    problem: &Problem<'_>,
    quadratic: bool,
    settings: &Settings,
) -> Result<()> {
    if !solution.values.data.iter().all(|x| x.is_finite()) {
        return Err(refused());
    }
    solution.objective = problem.objective(&solution.values, quadratic);
    let gap = (solution.objective - solution.dual_objective)
        / Problem::gap_scale(solution.objective, solution.floor);
    solution.gap = gap.max(0.0);
    if !(solution.objective.is_finite() && gap.is_finite()) {
        return Err(refused());
    }
    if solution.status == Status::Solved
        && settings.tolerance.is_some_and(|tolerance| solution.gap > tolerance)
    {
        solution.status = Status::Inaccurate;
    }
    Ok(())
}

/// Hands out `solution` in the unit of the `target` that went in; `fixed` values keep every bit.
///
/// # Errors
/// [`SolveError::NoNumber`] where an objective is past the largest number.
pub(super) fn restore(
    solution: &mut Solution,
    fixed: &[bool],
    target: &Columns,
    value: Unit,
    energy: Unit,
) -> Result<()> {
    for x in [&mut solution.objective, &mut solution.dual_objective, &mut solution.floor] {
        *x = energy.restore_finite("the objective", *x)?;
    }
    if value.is_one() {
        return Ok(());
    }
    for c in 0..target.n_columns {
        let kept = fixed.iter().zip(target.column(c));
        for (x, (fixed, target)) in solution.values.column_mut(c).iter_mut().zip(kept) {
            *x = if *fixed { *target } else { value.restore_finite("a value", *x)? };
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surroundings_reach_ten_sides_beyond_the_points() {
        let around = Surroundings::of(&[[0.0, 0.0, 5.0], [2.0, 1.0, 5.0]]);
        assert!(around.hold(&[[22.0, -20.0, -15.0]]));
        assert!(!around.hold(&[[22.1, 0.0, 5.0]]));
        assert!(!around.hold(&[[0.0, f64::NAN, 5.0]]));
    }
}
