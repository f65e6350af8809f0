//! The fast solver: alternating directions on `z = H u + c` with a penalty `R_b` per block.
//!
//! `(2a + HᵀRH) u = 2a·t + Hᵀ(R(z − c) − p)`, over-relaxation `h ← 1.7 (H u + c) − 0.7 z`, shrinkage
//! `z ← shrink(h + p/R, w/R)`, multipliers `p ← p + R (h − z)`. The point `p + R(Hu + c − z)` before the
//! shrinkage solves the dual equations exactly, which is what the certificate is made of.

mod finish;
pub mod penalty;
mod run;
mod sweep;
pub mod system;

pub use sweep::Sweep;

use run::{Best, Run, FACTORIZATION, FIRST_STEPS, RESIDUAL_GOAL};

use crate::block_rows::BLOCK;
use crate::progress::Progress;
use crate::solve::cones::scaled;
use crate::solve::fast::penalty::{reweighted, uniform};
use crate::solve::fast::sweep::Sums;
use crate::solve::fast::system::{System, Weighing};
use crate::solve::outcome::{Outcome, Warm};
use crate::solve::problem::{Problem, Settings, Status};
use crate::solve::reduced::Reduced;
use crate::{memory, Result};

/// Iterations between two looks at the certificate and the stopping rules.
const CHECK_EVERY: usize = 3;

/// Default bound on the iterations; a problem that needs more is better served by an interior-point method.
pub(super) const MAX_ITERATIONS: usize = 3000;

/// Without a tolerance the iteration stops when the objective falls by less than this part between two checks
/// and `H u + c` and `z` differ by less than [`SPLIT_RESIDUAL`]: the true error is then about
/// [`RESIDUAL_GOAL`].
const STILL: f64 = 6e-5;
const SPLIT_RESIDUAL: f64 = 2e-2;

/// A gap this small also means a true error of about 1e-4: the bound is the slower of the two by a factor of
/// ten (measured on the flow), so there is no need to wait for the residuals.
const GAP_ENOUGH: f64 = 1e-3;

/// The first new penalties come after this many iterations from nothing, when the ridges begin to show, and
/// then each time the iterations have tripled.
const REWEIGHT_COLD: usize = 10;

/// A warm start brings good penalties along.
const REWEIGHT_WARM: usize = 30;

/// Minimizes a reduced problem.
///
/// # Errors
/// A failed factorization, dependent constraints, or [`crate::Error::Cancelled`].
pub fn minimize<const K: usize>(
    reduced: Reduced<'_, K>,
    system: &mut System,
    warm: Option<Warm<K>>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Outcome<K>> {
    let lengths = reduced.lengths(&reduced.target)?;
    let floor = reduced.floor(&lengths);
    let primal = reduced.objective(&reduced.target, lengths.iter().copied());
    if primal <= settings.tolerance.unwrap_or(RESIDUAL_GOAL) * floor && reduced.constraints.is_none() {
        // The target is affine up to rounding: it is the solution, and zero is the bound.
        return Ok(Outcome {
            u: reduced.target,
            primal,
            dual: 0.0,
            floor,
            iterations: 0,
            status: Status::Solved,
            warm: None,
        });
    }
    Run::new(reduced, system, warm, &lengths, floor, progress)?.iterate(settings, progress)
}

/// The values that a run would start from, where there is no time for one: no norm is less than zero.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn untouched<const K: usize>(reduced: Reduced<'_, K>) -> Result<Outcome<K>> {
    let lengths = reduced.lengths(&reduced.target)?;
    let floor = reduced.floor(&lengths);
    let primal = reduced.objective(&reduced.target, lengths.into_iter());
    let (dual, status) = (reduced.offset, Status::Stopped);
    Ok(Outcome { u: reduced.target, primal, dual, floor, iterations: 0, status, warm: None })
}

/// What the last look at the certificate found.
struct Checked {
    primal: f64,
    gap: f64,
}

impl<'r, 's, const K: usize> Run<'r, 's, K> {
    /// `lengths` are those of the operator applied to the target, `floor` what counts as zero.
    fn new(
        mut reduced: Reduced<'r, K>,
        system: &'s mut System,
        warm: Option<Warm<K>>,
        lengths: &[f64],
        floor: f64,
        progress: &Progress,
    ) -> Result<Self> {
        progress.check()?;
        let (r, next_reweighting) = match &warm {
            Some(warm) => (reweighted(&warm.length, &reduced.weights)?, REWEIGHT_WARM),
            None => (uniform(&mut reduced, system, lengths, progress)?, REWEIGHT_COLD),
        };
        if warm.is_some() {
            system.factorize(&mut reduced, Weighing::Penalties(&r), progress)?;
        }
        progress.check()?;
        let sweep = Sweep::new(&reduced, &r, &reduced.target, |b| match &warm {
            Some(warm) => (warm.z[b], scaled(reduced.weights[b], &warm.p[b])),
            None => ([[0.0; K]; BLOCK], [[0.0; K]; BLOCK]),
        })?;
        let best = Best { u: memory::twin(&reduced.target)?, primal: f64::INFINITY, dual: 0.0 };
        let u = memory::twin(&reduced.target)?;
        Ok(Self {
            reduced,
            system,
            r,
            sweep,
            u,
            y: Vec::new(),
            floor,
            best,
            next_reweighting,
            next_steps: FIRST_STEPS,
        })
    }

    fn iterate(mut self, settings: &Settings, progress: &Progress) -> Result<Outcome<K>> {
        let max = settings.max_iterations.unwrap_or(MAX_ITERATIONS).max(1);
        let mut status = Status::Inaccurate;
        let mut iterations = 0;
        let mut left = f64::INFINITY;
        let mut last_check = Checked { primal: f64::INFINITY, gap: f64::INFINITY };
        while iterations < max {
            progress.check()?;
            if progress.is_finishing() && iterations > 0 {
                status = Status::Stopped;
                break;
            }
            iterations += 1;
            self.y = self.system.solve(&self.reduced, self.sweep.right(), &mut self.u)?;
            let check = iterations % CHECK_EVERY == 0 || iterations == max;
            let sums = self.sweep.advance(&self.reduced, &self.r, &self.u, check);
            let primal = self.reduced.offset + sums.norms + self.reduced.fidelity_term(&self.u);
            self.offer(primal);
            if check {
                self.bound(&sums)?;
                if self.is_done(settings, last_check.primal, &sums) {
                    status = Status::Solved;
                    break;
                }
                if settings.announce {
                    progress.report(self.report(settings, iterations));
                }
                left = self.iterations_left(settings, last_check.gap);
                if self.steps_pay(settings, iterations, last_check.primal, left) {
                    self.finish(settings, iterations, last_check.primal, progress)?;
                    if self.is_certified(settings) {
                        status = Status::Solved;
                        break;
                    }
                }
                last_check = Checked { primal: self.best.primal, gap: self.gap() };
            }
            if iterations == self.next_reweighting {
                self.next_reweighting *= 3;
                // The first new penalties always pay: the ones to start with are alike everywhere.
                if iterations == REWEIGHT_COLD || left > FACTORIZATION {
                    self.reweight(progress)?;
                }
            }
        }
        self.outcome(iterations, status)
    }

    /// Lower bounds from `p + R (H u + c − z)` and, where there is fidelity everywhere, from the multipliers
    /// themselves, which are never too long.
    fn bound(&mut self, sums: &Sums) -> Result<()> {
        let mut g = memory::twin(self.sweep.from_equations())?;
        self.add_constraints(&mut g);
        self.bound_from(&sums.from_equations, &g);
        if self.reduced.has_fidelity_everywhere {
            let mut g = memory::twin(self.sweep.multipliers())?;
            self.add_constraints(&mut g);
            self.bound_from(&sums.multipliers, &g);
        }
        Ok(())
    }

    fn is_done(&self, settings: &Settings, last_check: f64, sums: &Sums) -> bool {
        let scale = Problem::gap_scale(self.best.primal, self.floor);
        match settings.tolerance {
            Some(tolerance) => self.gap() <= tolerance,
            None => {
                self.gap() <= GAP_ENOUGH
                    || (last_check - self.best.primal < STILL * scale
                        && sums.split < SPLIT_RESIDUAL * sums.norms)
            }
        }
    }

    /// Iterations until the gap asked for, at the rate since the last check;
    /// infinitely many where none is asked for.
    fn iterations_left(&self, settings: &Settings, last_gap: f64) -> f64 {
        let digits = |from: f64, to: f64| (from / to).ln();
        match settings.tolerance {
            Some(tolerance) if self.gap() < last_gap => {
                CHECK_EVERY as f64 * digits(self.gap(), tolerance) / digits(last_gap, self.gap())
            }
            _ => f64::INFINITY,
        }
    }
}
