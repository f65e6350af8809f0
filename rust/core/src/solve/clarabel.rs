//! The problem as a second-order cone program for Clarabel, an interior-point method: slow, exact,
//! and independent.
//!
//! Variables `(u, s)`, a cone `s_b ≥ ‖(H u + c)_b‖` of `1 + BLOCK·k` entries per block,
//! `2a` in the quadratic term.

use std::panic::resume_unwind;
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::thread::Builder;
use std::time::Duration;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolution, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
    SupportedConeT::SecondOrderConeT, SupportedConeT::ZeroConeT,
};

use crate::block_rows::BLOCK;
use crate::error::{SolveError, ThreadsError};
use crate::progress::Progress;
use crate::solve::certificate::{bound_along_ray, DualPoint};
use crate::solve::cones::{norm, scaled, Block};
use crate::solve::outcome::Outcome;
use crate::solve::problem::{Problem, Settings, Status};
use crate::solve::reduced::Reduced;
use crate::{memory, Error, Result};

/// Below this many rows `qdldl` is faster, above it `faer` (measured, see the benchmarks).
pub const QDLDL_BELOW: usize = 20_000;

/// Clarabel's tolerance as a part of the gap asked for. The certificate is made of exactly feasible points
/// and comes out up to 20 times larger than Clarabel's own gap (measured on a dozen problems).
const MARGIN: f64 = 0.01;

/// How long Clarabel is left alone between two looks at what the caller wishes.
const LISTENING: Duration = Duration::from_millis(50);

/// Solves the reduced problem, Rowe et al. 2024, eq. (21) as the cones of eq. (40), with Clarabel and the
/// factorization called `method`.
///
/// # Errors
/// [`SolveError`] when Clarabel cannot make anything of the problem; [`Error::Cancelled`].
pub fn minimize<const K: usize>(
    reduced: &Reduced<'_, K>,
    method: &str,
    settings: &Settings,
    progress: &Progress,
) -> Result<Outcome<K>> {
    let n_columns = reduced.n_columns;
    let program = Program::new(reduced)?;
    let tolerance = settings.tolerance.map_or(1e-9, |t| (MARGIN * t).clamp(1e-11, 1e-3));
    let options = DefaultSettings {
        verbose: false,
        direct_solve_method: method.to_string(),
        tol_gap_abs: tolerance * 1e-2,
        tol_gap_rel: tolerance,
        tol_feas: tolerance.min(1e-8),
        max_iter: settings.max_iterations.map_or(200, |n| u32::try_from(n).unwrap_or(u32::MAX)),
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let Some((program, found)) = solve_apart(program, options, reduced.constraints.is_none(), progress)?
    else {
        // Nothing was reached yet: the point to start from, and what is certain of it.
        let q = memory::repeated([[0.0; K]; BLOCK], reduced.n_blocks())?;
        return certified(reduced, memory::twin(&reduced.target)?, &q, &[], 0, Status::Stopped);
    };
    let status = match found.status {
        SolverStatus::Solved => Status::Solved,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            return Err(Error::Solve(SolveError::Infeasible {
                reason: "no values satisfy all linear constraints and fixed values".into(),
            }));
        }
        _ if progress.is_finishing() => Status::Stopped,
        _ => Status::Inaccurate,
    };
    let n = reduced.n();
    let row = |i: usize| std::array::from_fn(|c| if c < n_columns { found.x[c * n + i] } else { 0.0 });
    let u: Vec<[f64; K]> = memory::gathered((0..n).map(row))?;
    let (mut q, y) = program.multipliers(&found.z)?;
    for (q, w) in q.iter_mut().zip(reduced.weights.iter()) {
        if *w == 0.0 {
            // The interior point only comes near zero here;
            // any q that is longer than its weight proves nothing.
            *q = [[0.0; K]; BLOCK];
        }
    }
    let mut outcome = certified(reduced, u, &q, &y, found.iterations as usize, status)?;
    if let (Some(tolerance), true) = (settings.tolerance, status != Status::Stopped) {
        // What counts is the gap of the point that is returned, not Clarabel's own,
        // which allows for infeasibility.
        let scale = Problem::gap_scale(outcome.primal, outcome.floor);
        let reached = outcome.primal - outcome.dual <= tolerance * scale;
        outcome.status = if reached { Status::Solved } else { Status::Inaccurate };
    }
    Ok(outcome)
}

/// Runs Clarabel on a thread of its own: it hears wishes between iterations only, one of which takes seconds
/// on large problems. When the caller wishes to stop, this one is done; the thread ends with the iteration
/// that it is in.
///
/// `None` where the caller wishes to finish and there is nothing yet;
/// with `may_leave` that is not waited for.
fn solve_apart<const K: usize>(
    program: Program<K>,
    options: DefaultSettings<f64>,
    may_leave: bool,
    progress: &Progress,
) -> Result<Option<(Program<K>, DefaultSolution<f64>)>> {
    let failed = |reason: String| Error::Solve(SolveError::Factorization { reason });
    let watch = progress.clone();
    let (send, receive) = channel();
    let work = move || {
        let Program { quadratic, linear, rows, right, cones, .. } = &program;
        let found = DefaultSolver::new(quadratic, linear, rows, right, cones, options).map(|mut solver| {
            solver.set_termination_callback(move |_: &_| watch.is_cancelled() || watch.is_finishing());
            solver.solve();
            solver.solution
        });
        // Nobody listens any more after a wish to stop.
        let _ =
            send.send(found.map(|found| (program, found)).map_err(|e| format!("Clarabel refused it: {e:?}")));
    };
    let thread = Builder::new().name("clarabel".into()).spawn(work);
    let thread = thread.map_err(|e| Error::Threads(ThreadsError { reason: e.to_string() }))?;
    loop {
        match receive.recv_timeout(LISTENING) {
            Ok(found) => {
                progress.check()?;
                return found.map(Some).map_err(failed);
            }
            Err(RecvTimeoutError::Timeout) => {
                progress.check()?;
                if may_leave && progress.is_finishing() {
                    return Ok(None);
                }
            }
            Err(RecvTimeoutError::Disconnected) => match thread.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => return Err(failed("Clarabel ended without an answer".into())),
            },
        }
    }
}

fn certified<const K: usize>(
    reduced: &Reduced<'_, K>,
    u: Vec<[f64; K]>,
    q: &[Block<K>],
    y: &[[f64; K]],
    iterations: usize,
    status: Status,
) -> Result<Outcome<K>> {
    let primal = reduced.objective(&u, reduced.lengths(&u)?.into_iter());
    let floor = reduced.floor(&reduced.lengths(&reduced.target)?);
    let bound = |q: &[Block<K>]| -> Result<f64> {
        let mut dual_point = DualPoint::default();
        for (b, (q, w)) in q.iter().zip(reduced.weights.iter()).enumerate() {
            dual_point.add(q, *w, &reduced.constant(b));
        }
        let mut g = reduced.apply_transposed(|b| q[b])?;
        if let Some(constraints) = &reduced.constraints {
            constraints.add_transposed(y, &mut g);
        }
        Ok(bound_along_ray(reduced, &dual_point, y, &g, &u))
    };
    let mut dual = bound(q)?;
    if reduced.has_fidelity_everywhere {
        // No equations to keep: shortening each block by itself costs less than shortening all alike.
        let clip = |(q, w): (&Block<K>, &f64)| scaled((w / norm(q).max(f64::MIN_POSITIVE)).min(1.0), q);
        let clipped: Vec<Block<K>> = memory::gathered(q.iter().zip(reduced.weights.iter()).map(clip))?;
        dual = dual.max(bound(&clipped)?);
    }
    Ok(Outcome { u, primal, dual, floor, iterations, status, warm: None })
}

struct Program<const K: usize> {
    quadratic: CscMatrix<f64>,
    linear: Vec<f64>,
    rows: CscMatrix<f64>,
    right: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    n_columns: usize,
    n_equalities: usize,
}

impl<const K: usize> Program<K> {
    fn new(reduced: &Reduced<'_, K>) -> Result<Self> {
        let (n, m, k) = (reduced.n(), reduced.n_blocks(), reduced.n_columns);
        let n_variables = k * n + m;
        let mut linear = memory::repeated(0.0, n_variables)?;
        let (mut at, mut values) = (memory::room(k * n)?, memory::room(k * n)?);
        for c in 0..k {
            for (i, a) in reduced.fidelity.iter().enumerate() {
                linear[c * n + i] = -2.0 * a * reduced.target[i][c];
                if *a > 0.0 {
                    at.push(c * n + i);
                    values.push(2.0 * a);
                }
            }
        }
        linear[k * n..].copy_from_slice(&reduced.weights);
        let twice = memory::twin(&at)?;
        let quadratic = CscMatrix::new_from_triplets(n_variables, n_variables, twice, at, values);

        // Clarabel's rows are `A x + s = b, s in cones`: equalities first,
        // then (s_b, H u + c) of every block.
        let of_constraints = |rows: &[Vec<(u32, f64)>]| rows.iter().map(|row| k * row.len()).sum::<usize>();
        let n_equal = reduced.constraints.as_ref().map_or(0, |constraints| k * constraints.len());
        let n_entries = reduced.constraints.as_ref().map_or(0, |c| of_constraints(c.rows()))
            + m
            + BLOCK * k * reduced.free.operator.columns.len();
        let (mut row, mut column) = (memory::room(n_entries)?, memory::room(n_entries)?);
        let (mut value, mut right) = (memory::room(n_entries)?, memory::room(n_equal + m * (1 + BLOCK * k))?);
        let mut cones = memory::room(m + 1)?;
        let mut n_equalities = 0;
        if let Some(constraints) = &reduced.constraints {
            for (entries, b) in constraints.rows().iter().zip(&constraints.right) {
                for (c, b) in b.iter().take(k).enumerate() {
                    for &(i, v) in entries {
                        row.push(n_equalities);
                        column.push(c * n + i as usize);
                        value.push(v);
                    }
                    right.push(*b);
                    n_equalities += 1;
                }
            }
            cones.push(ZeroConeT(n_equalities));
        }
        for b in 0..m {
            let constant = reduced.constant(b);
            row.push(right.len());
            column.push(k * n + b);
            value.push(-1.0);
            right.push(0.0);
            let (block_columns, entries) = reduced.free.operator.block(b);
            for (r, constant) in constant.iter().enumerate() {
                for (c, constant) in constant.iter().take(k).enumerate() {
                    for (&i, entry) in block_columns.iter().zip(entries) {
                        row.push(right.len());
                        column.push(c * n + i as usize);
                        value.push(-entry[r]);
                    }
                    right.push(*constant);
                }
            }
            cones.push(SecondOrderConeT(1 + BLOCK * k));
        }
        let rows = CscMatrix::new_from_triplets(right.len(), n_variables, row, column, value);
        Ok(Self { quadratic, linear, rows, right, cones, n_columns: k, n_equalities })
    }

    /// Clarabel's dual variables as `q` (one block each) and `y` (one row per constraint).
    fn multipliers(&self, z: &[f64]) -> Result<(Vec<Block<K>>, Vec<[f64; K]>)> {
        let k = self.n_columns;
        let entry = |row: &[f64], c: usize| if c < k { row[c] } else { 0.0 };
        let y = z[..self.n_equalities]
            .chunks_exact(k)
            .map(|row| std::array::from_fn(|c| entry(row, c)))
            .collect();
        let block = |cone: &[f64]| {
            std::array::from_fn(|r| std::array::from_fn(|c| -entry(&cone[1 + r * k..1 + (r + 1) * k], c)))
        };
        let q = memory::gathered(z[self.n_equalities..].chunks_exact(1 + BLOCK * k).map(block))?;
        Ok((q, y))
    }
}
