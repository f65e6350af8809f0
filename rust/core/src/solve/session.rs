//! A session of solving: whole problems, each connected piece by itself, and what one run leaves to the next.

use crate::progress::Progress;
use crate::solve::apart::Apart;
use crate::solve::pieces::Pieces;
use crate::solve::problem::{Problem, Settings, Solution};
use crate::solve::single::{Call, Method, Single};
use crate::{memory, Result};

/// A solver that keeps the symbolic factorization while the operator's pattern stays, and starts each run
/// from the multipliers of the last one while the problems stay alike.
///
/// Connected pieces of the operator are problems of their own: each has its own penalties, and ends when its
/// own gap is small enough.
#[derive(Debug, Default)]
pub struct Session {
    pieces: Option<Pieces>,
    /// A solver for each piece.
    singles: Vec<Single>,
}

impl Session {
    /// A solver that knows nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets the last solution, but not the symbolic factorization.
    pub fn forget(&mut self) {
        self.singles.iter_mut().for_each(Single::forget);
    }

    /// Solves `problem`, starting from the last solution if it had as many blocks and columns.
    ///
    /// # Errors
    /// Arguments that do not fit, a failed factorization, contradicting constraints, or
    /// [`crate::Error::Cancelled`].
    pub fn solve(
        &mut self,
        problem: &Problem<'_>,
        settings: &Settings,
        progress: &Progress,
    ) -> Result<Solution> {
        self.run(problem, Method::Fast, settings, progress)
    }

    pub(super) fn run(
        &mut self,
        problem: &Problem<'_>,
        method: Method,
        settings: &Settings,
        progress: &Progress,
    ) -> Result<Solution> {
        problem.check()?;
        // Constraints speak of the whole; Clarabel is there to compare with, and is given the whole.
        let is_divided = method == Method::Fast && problem.linear_constraints.is_none();
        let pieces = if is_divided { Pieces::of(problem.operator, None)? } else { None };
        if pieces != self.pieces || self.singles.is_empty() {
            let count = pieces.as_ref().map_or(1, Pieces::count);
            self.singles = memory::gathered((0..count).map(|_| Single::default()))?;
            self.pieces = pieces;
        }
        let call = Call { method, settings, progress, may_skip: false };
        match &self.pieces {
            None => self.singles[0].run(problem, &call),
            Some(pieces) => Apart::new(pieces, problem, &call, &mut self.singles)?.solve(&mut self.singles),
        }
    }
}
