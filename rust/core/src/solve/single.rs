//! One problem, with fixed rows and joint or separate columns, by the fast solver or Clarabel, and what one
//! run leaves to the next.

use crate::block_rows::{BlockRows, BLOCK};
use crate::linear::Columns;
use crate::progress::Progress;
use crate::solve::clarabel;
use crate::solve::cones::norm;
use crate::solve::fast;
use crate::solve::fast::system::System;
use crate::solve::free_operator::FreeOperator;
use crate::solve::outcome::{Outcome, Warm};
use crate::solve::pieces::Pieces;
use crate::solve::problem::{Coupling, Problem, Settings, Solution, Solver, Status};
use crate::solve::reduced::Reduced;
use crate::{memory, Error, Result};

/// At most this many columns in one joint norm.
pub const MAX_JOINT_COLUMNS: usize = 16;

/// What [`super::Session`] keeps of one problem.
#[derive(Debug, Default)]
pub(super) struct Single {
    system: Option<System>,
    warm: Vec<StoredWarm>,
}

/// Who minimizes the reduced problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// [`crate::solve::fast`].
    Fast,
    /// [`crate::solve::clarabel`] with this factorization.
    Clarabel(Solver),
}

/// How to solve.
#[derive(Clone, Copy)]
pub(super) struct Call<'c> {
    pub method: Method,
    pub settings: &'c Settings,
    pub progress: &'c Progress,
    /// Whether the problem is left as it came where the caller wishes to finish: others have been solved.
    pub may_skip: bool,
}

/// The columns that share a norm.
fn groups(problem: &Problem<'_>) -> Result<Vec<Vec<usize>>> {
    let k = problem.target.n_columns;
    Ok(match problem.coupling {
        Coupling::Joint if k > MAX_JOINT_COLUMNS => {
            let problem = format!(
                "has {k} columns, one joint norm takes at most {MAX_JOINT_COLUMNS}; use separate coupling"
            );
            return Err(Error::argument("values", problem));
        }
        Coupling::Joint => vec![(0..k).collect()],
        Coupling::Separate => (0..k).map(|c| vec![c]).collect(),
    })
}

/// The columns of a problem that share a norm, on its free rows.
#[derive(Clone, Copy)]
struct Parts<'p> {
    problem: &'p Problem<'p>,
    free: &'p FreeOperator<'p>,
    columns: &'p [usize],
}

/// A [`Warm`] of any number of columns.
#[derive(Debug, Clone)]
struct StoredWarm {
    columns: usize,
    z: Vec<f64>,
    p: Vec<f64>,
    length: Vec<f64>,
}

impl Single {
    /// Forgets the last solution, but not the symbolic factorization.
    pub(super) fn forget(&mut self) {
        self.warm.clear();
    }

    /// Bytes of the factor.
    pub(super) fn factor_bytes(&self) -> usize {
        self.system.as_ref().map_or(0, System::factor_bytes)
    }

    /// Solves `problem`, starting from the last solution if it had as many blocks and columns.
    ///
    /// # Errors
    /// A failed factorization, contradicting constraints, or [`Error::Cancelled`].
    pub(super) fn run(&mut self, problem: &Problem<'_>, call: &Call<'_>) -> Result<Solution> {
        let groups = groups(problem)?;
        let free = FreeOperator::new(problem.operator, &problem.fixed)?;
        call.progress.check()?;
        self.keep_if_fitting(&free);
        let mut stored = std::mem::take(&mut self.warm);
        if stored.len() != groups.len() {
            stored.clear();
        }
        let mut stored = stored.into_iter();
        let mut total = Total::new(problem, call.method)?;
        for columns in &groups {
            call.progress.check()?;
            let (warm, total) = (stored.next(), &mut total);
            let parts = Parts { problem, free: &free, columns };
            match columns.len() {
                1 => self.group::<1>(parts, warm, call, total)?,
                2 => self.group::<2>(parts, warm, call, total)?,
                // Rows of four fill a vector register, and the solves leave the empty column out.
                3 | 4 => self.group::<4>(parts, warm, call, total)?,
                5..=8 => self.group::<8>(parts, warm, call, total)?,
                _ => self.group::<MAX_JOINT_COLUMNS>(parts, warm, call, total)?,
            }
        }
        Ok(total.into_solution())
    }

    /// Analyzes the pattern of the operator on its free rows, if it is another than before, for a factor of
    /// at most `memory_limit` bytes.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`], or [`Error::Cancelled`].
    pub(super) fn analyze(
        &mut self,
        operator: &BlockRows,
        fixed: &[bool],
        memory_limit: Option<usize>,
        progress: &Progress,
    ) -> Result<()> {
        let free = FreeOperator::new(operator, fixed)?;
        self.keep_if_fitting(&free);
        if self.system.is_none() && !free.free.is_empty() {
            self.system = Some(System::new(&free, memory_limit, progress)?);
        }
        Ok(())
    }

    /// Forgets the linear system of another pattern.
    fn keep_if_fitting(&mut self, free: &FreeOperator<'_>) {
        self.system = self.system.take().filter(|system| system.fits(&free.operator));
    }

    fn group<const K: usize>(
        &mut self,
        Parts { problem, free, columns }: Parts<'_>,
        warm: Option<StoredWarm>,
        call: &Call<'_>,
        total: &mut Total,
    ) -> Result<()> {
        let reduced = Reduced::<K>::new(problem, free, columns)?;
        if reduced.n() == 0 {
            total.add_fixed(&reduced)?;
            return Ok(());
        }
        let may_skip = call.may_skip || columns.first() != Some(&0);
        if call.progress.is_finishing() && may_skip && reduced.constraints.is_none() {
            // Each column takes some factorizations to come anywhere.
            total.add(&fast::untouched(reduced)?, &free.free, columns);
            return Ok(());
        }
        call.progress.check()?;
        let outcome = match call.method {
            Method::Clarabel(solver) => {
                let method = if solver == Solver::ClarabelFaer { "faer" } else { "qdldl" };
                clarabel::minimize(&reduced, method, call.settings, call.progress)?
            }
            Method::Fast => {
                let system = match &mut self.system {
                    Some(system) => system,
                    empty => empty.insert(System::new(free, call.settings.memory_limit, call.progress)?),
                };
                let before = system.n_factorizations();
                let warm = warm.map(|w| w.restore(free.operator.n_blocks())).transpose()?.flatten();
                let outcome = fast::minimize(reduced, system, warm, call.settings, call.progress)?;
                total.factorisations += system.n_factorizations() - before;
                outcome
            }
        };
        total.add(&outcome, &free.free, columns);
        self.warm.extend(outcome.warm.map(StoredWarm::new));
        Ok(())
    }
}

impl StoredWarm {
    fn new<const K: usize>(warm: Warm<K>) -> Self {
        let flat = |blocks: Vec<[[f64; K]; BLOCK]>| blocks.into_flattened().into_flattened();
        Self { columns: K, z: flat(warm.z), p: flat(warm.p), length: warm.length }
    }

    fn restore<const K: usize>(self, n_blocks: usize) -> Result<Option<Warm<K>>> {
        if self.columns != K || self.length.len() != n_blocks {
            return Ok(None);
        }
        let block = |b: &[f64]| std::array::from_fn(|r| std::array::from_fn(|c| b[r * K + c]));
        let blocks = |flat: &[f64]| memory::gathered(flat.chunks_exact(BLOCK * K).map(block));
        Ok(Some(Warm { z: blocks(&self.z)?, p: blocks(&self.p)?, length: self.length }))
    }
}

/// The sums over groups of columns, or pieces.
pub(super) struct Total {
    values: Columns,
    primal: f64,
    dual: f64,
    floor: f64,
    iterations: usize,
    factorisations: usize,
    status: Status,
    solver: Solver,
}

impl Total {
    pub(super) fn new(problem: &Problem<'_>, method: Method) -> Result<Self> {
        Ok(Self {
            values: problem.target.copied()?,
            primal: 0.0,
            dual: 0.0,
            floor: 0.0,
            iterations: 0,
            factorisations: 0,
            status: Status::Solved,
            solver: match method {
                Method::Fast => Solver::Fast,
                Method::Clarabel(solver) => solver,
            },
        })
    }

    fn add<const K: usize>(&mut self, outcome: &Outcome<K>, free: &[u32], columns: &[usize]) {
        for (c, &column) in columns.iter().enumerate() {
            let values = self.values.column_mut(column);
            for (&i, x) in free.iter().zip(&outcome.u) {
                values[i as usize] = x[c];
            }
        }
        self.primal += outcome.primal;
        self.dual += outcome.dual;
        self.floor += outcome.floor;
        self.iterations += outcome.iterations;
        self.status = self.status.worse(outcome.status);
    }

    /// Everything is fixed: the objective is a constant and its own bound.
    fn add_fixed<const K: usize>(&mut self, reduced: &Reduced<'_, K>) -> Result<()> {
        let constant = (0..reduced.n_blocks()).map(|b| norm(&reduced.constant(b)));
        let objective = reduced.objective(&[], constant);
        self.primal += objective;
        self.dual += objective;
        Ok(())
    }

    /// The solution of a piece of the problem: iterations are those of the piece that takes most of them.
    pub(super) fn add_piece(&mut self, solution: &Solution, pieces: &Pieces, p: usize) {
        pieces.put(&solution.values, p, &mut self.values);
        self.primal += solution.objective;
        self.dual += solution.dual_objective;
        self.floor += solution.floor;
        self.iterations = self.iterations.max(solution.iterations);
        self.factorisations = self.factorisations.max(solution.factorisations);
        self.status = self.status.worse(solution.status);
    }

    pub(super) fn into_solution(self) -> Solution {
        Solution {
            gap: ((self.primal - self.dual) / Problem::gap_scale(self.primal, self.floor)).max(0.0),
            values: self.values,
            objective: self.primal,
            dual_objective: self.dual,
            floor: self.floor,
            iterations: self.iterations,
            factorisations: self.factorisations,
            status: self.status,
            solver: self.solver,
        }
    }
}
