//! A session of solving: whole problems, with fixed rows and joint or separate columns, by the fast solver
//! or Clarabel, and what one run leaves to the next.

use crate::block_rows::BLOCK;
use crate::linear::Columns;
use crate::progress::Progress;
use crate::solve::clarabel;
use crate::solve::fast;
use crate::solve::fast::system::System;
use crate::solve::free_operator::FreeOperator;
use crate::solve::outcome::{Outcome, Warm};
use crate::solve::problem::{Coupling, Problem, Settings, Solution, Solver, Status};
use crate::solve::reduced::Reduced;
use crate::{memory, Error, Result};

/// At most this many columns in one joint norm.
pub const MAX_JOINT_COLUMNS: usize = 16;

/// A solver that keeps the symbolic factorization while the operator's pattern stays, and starts each run
/// from the multipliers of the last one while the problems stay alike.
#[derive(Debug, Default)]
pub struct Session {
    structure: Option<Structure>,
    warm: Vec<StoredWarm>,
}

#[derive(Debug)]
struct Structure {
    free: FreeOperator,
    system: Option<System>,
}

/// Who minimizes the reduced problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// [`crate::solve::fast`].
    Fast,
    /// [`crate::solve::clarabel`] with this factorization.
    Clarabel(Solver),
}

struct Call<'c> {
    method: Method,
    settings: &'c Settings,
    progress: &'c Progress,
}

/// A [`Warm`] of any number of columns.
#[derive(Debug, Clone)]
struct StoredWarm {
    columns: usize,
    z: Vec<f64>,
    p: Vec<f64>,
    length: Vec<f64>,
}

impl Session {
    /// A solver that knows nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets the last solution, but not the symbolic factorization.
    pub fn forget(&mut self) {
        self.warm.clear();
    }

    /// Solves `problem`, starting from the last solution if it had as many blocks and columns.
    ///
    /// # Errors
    /// Arguments that do not fit, a failed factorization, contradicting constraints, or [`Error::Cancelled`].
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
        let k = problem.target.n_columns;
        let groups: Vec<Vec<usize>> =
            match problem.coupling {
                Coupling::Joint if k > MAX_JOINT_COLUMNS => {
                    return Err(Error::argument(
                    "values",
                    format!("has {k} columns, one joint norm takes at most {MAX_JOINT_COLUMNS}; use separate \
                    coupling"),
                ));
                }
                Coupling::Joint => vec![(0..k).collect()],
                Coupling::Separate => (0..k).map(|c| vec![c]).collect(),
            };
        self.prepare(problem)?;
        let stored = std::mem::take(&mut self.warm);
        let fits = stored.len() == groups.len();
        let mut total = Total::new(problem, method)?;
        let call = Call { method, settings, progress };
        for (g, columns) in groups.iter().enumerate() {
            progress.check()?;
            let warm = if fits { stored.get(g) } else { None };
            match columns.len() {
                1 => self.group::<1>(problem, columns, warm, &call, &mut total)?,
                2 => self.group::<2>(problem, columns, warm, &call, &mut total)?,
                // Rows of four fill a vector register, and the solves leave the empty column out.
                3 | 4 => self.group::<4>(problem, columns, warm, &call, &mut total)?,
                5..=8 => self.group::<8>(problem, columns, warm, &call, &mut total)?,
                _ => self.group::<MAX_JOINT_COLUMNS>(problem, columns, warm, &call, &mut total)?,
            }
        }
        Ok(total.into_solution())
    }

    fn prepare(&mut self, problem: &Problem<'_>) -> Result<()> {
        let free = FreeOperator::new(problem.operator, &problem.fixed)?;
        match &mut self.structure {
            Some(s)
                if s.free.free == free.free
                    && s.free.operator.starts == free.operator.starts
                    && s.free.operator.columns == free.operator.columns
                    && s.system.as_ref().is_none_or(|system| system.fits(&free.operator)) =>
            {
                s.free = free;
            }
            structure => {
                *structure = Some(Structure { free, system: None });
            }
        }
        Ok(())
    }

    fn group<const K: usize>(
        &mut self,
        problem: &Problem<'_>,
        columns: &[usize],
        warm: Option<&StoredWarm>,
        call: &Call<'_>,
        total: &mut Total,
    ) -> Result<()> {
        let Some(structure) = &mut self.structure else {
            return Ok(());
        };
        let reduced = Reduced::<K>::new(problem, &structure.free, columns)?;
        if reduced.n() == 0 {
            total.add_fixed(&reduced)?;
            return Ok(());
        }
        let is_first = columns.first() == Some(&0);
        if call.progress.is_finishing() && !is_first && reduced.constraints.is_none() {
            // Each column takes some factorizations to come anywhere.
            total.add(&fast::untouched(reduced)?, &structure.free.free, columns);
            return Ok(());
        }
        let outcome = match call.method {
            Method::Clarabel(solver) => {
                let method = if solver == Solver::ClarabelFaer { "faer" } else { "qdldl" };
                clarabel::minimize(&reduced, method, call.settings, call.progress)?
            }
            Method::Fast => {
                let system = match &mut structure.system {
                    Some(system) => system,
                    empty => empty.insert(System::new(&structure.free, call.settings.memory_limit)?),
                };
                let before = system.n_factorizations();
                let n_blocks = structure.free.operator.n_blocks();
                let warm = warm.map(|w| w.restore(n_blocks)).transpose()?.flatten();
                let outcome = fast::minimize(reduced, system, warm, call.settings, call.progress)?;
                total.factorisations += system.n_factorizations() - before;
                outcome
            }
        };
        total.add(&outcome, &structure.free.free, columns);
        self.warm.extend(outcome.warm.map(StoredWarm::new));
        Ok(())
    }
}

impl StoredWarm {
    fn new<const K: usize>(warm: Warm<K>) -> Self {
        let flat = |blocks: Vec<[[f64; K]; BLOCK]>| blocks.into_flattened().into_flattened();
        Self { columns: K, z: flat(warm.z), p: flat(warm.p), length: warm.length }
    }

    fn restore<const K: usize>(&self, n_blocks: usize) -> Result<Option<Warm<K>>> {
        if self.columns != K || self.length.len() != n_blocks {
            return Ok(None);
        }
        let block = |b: &[f64]| std::array::from_fn(|r| std::array::from_fn(|c| b[r * K + c]));
        let blocks = |flat: &[f64]| memory::gathered(flat.chunks_exact(BLOCK * K).map(block));
        Ok(Some(Warm { z: blocks(&self.z)?, p: blocks(&self.p)?, length: memory::twin(&self.length)? }))
    }
}

/// The sums over groups of columns.
struct Total {
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
    fn new(problem: &Problem<'_>, method: Method) -> Result<Self> {
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
        let constant: Vec<_> = memory::gathered((0..reduced.n_blocks()).map(|b| reduced.constant(b)))?;
        let objective = reduced.objective(&[], &constant);
        self.primal += objective;
        self.dual += objective;
        Ok(())
    }

    fn into_solution(self) -> Solution {
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
