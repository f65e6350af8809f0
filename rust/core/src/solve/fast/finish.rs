//! The end of a run by primal-dual steps, where alternating directions would take long.

use super::run::{Run, FACTORIZATION, RESIDUAL_GOAL};
use crate::error::SolveError;
use crate::linear::conjugate_gradients::{add, conjugate_gradients};
use crate::memory;
use crate::progress::Progress;
use crate::solve::certificate::spread;
use crate::solve::cones::Block;
use crate::solve::fast::sweep::Sweep;
use crate::solve::fast::system::Weighing;
use crate::solve::primal_dual::{clip, dual_point, follow, Model, Stiffness};
use crate::solve::problem::Settings;
use crate::{Error, Result};

/// The dual point that steps keep, and what the linear system holds.
struct Steps<const K: usize> {
    z: Vec<Block<K>>,
    /// The stiffness that was factored last; empty before the first.
    factored: Vec<Stiffness>,
    /// Whether that is still near enough.
    is_near: bool,
}

impl<const K: usize> Run<'_, '_, K> {
    /// Whether primal-dual steps cost less than the iterations that are `left`.
    pub(super) fn steps_pay(
        &self,
        settings: &Settings,
        iterations: usize,
        last_primal: f64,
        left: f64,
    ) -> bool {
        /// Factorizations' worth of steps that a run takes which begins with the objective still, and more
        /// for each digit that the objective has to fall (measured from 8k to 200k vertices; they are what
        /// decides, not what is done).
        const STEPS_WHEN_STILL: f64 = 3.0;
        const STEPS_A_DIGIT: f64 = 3.0;
        // A joint norm of several columns would couple them in the matrix.
        if self.reduced.n_columns != 1 || settings.tolerance.is_none() || iterations < self.next_steps {
            return false;
        }
        let digits = (self.first_aim(settings, last_primal) / least_aim(settings)).log10();
        left > FACTORIZATION * (STEPS_WHEN_STILL + STEPS_A_DIGIT * digits)
    }

    /// The relative gap of the point of the central path to start at:
    /// the objective is as far from its minimum there.
    fn first_aim(&self, settings: &Settings, last_primal: f64) -> f64 {
        /// What the objective fell since the last look, this many times over,
        /// is an estimate of what it has still to fall.
        const STILL_TO_FALL: f64 = 10.0;
        let fell = (last_primal - self.best.primal) / self.scale();
        let least = least_aim(settings);
        (STILL_TO_FALL * fell).clamp(least, self.gap().max(least))
    }

    /// Primal-dual steps as long as they gain; then back to alternating directions, with new penalties.
    pub(super) fn finish(
        &mut self,
        settings: &Settings,
        iterations: usize,
        last_primal: f64,
        progress: &Progress,
    ) -> Result<()> {
        /// The aim of the next step, in gaps reached so far.
        const NEXT_AIM: f64 = 0.1;
        /// A step that leaves more than this part of the gap is idle. Steps stop after this many idle ones in
        /// a row.
        const IDLE: f64 = 0.7;
        const MOST_IDLE: usize = 6;
        let multipliers = |b| self.sweep.split(&self.reduced.weights, &self.r, b).1;
        let z = memory::gathered((0..self.r.len()).map(multipliers))?;
        let mut steps = Steps { z, factored: Vec::new(), is_near: false };
        let n_cones = self.reduced.weights.iter().filter(|w| **w > 0.0).count().max(1) as f64;
        let mut aim = self.first_aim(settings, last_primal);
        self.u.clone_from(&self.best.u);
        let mut idle = 0;
        while idle < MOST_IDLE {
            progress.check()?;
            let before = self.gap();
            match self.step(settings, &mut steps, aim * self.scale() / n_cones, progress) {
                // Alternating directions have a tamer matrix.
                Ok(false) | Err(Error::Solve(SolveError::Factorization { .. })) => break,
                moved => moved?,
            };
            if self.is_certified(settings) || progress.is_finishing() {
                break;
            }
            if settings.announce {
                progress.report(self.report(settings, iterations));
            }
            idle = if self.gap() < IDLE * before { 0 } else { idle + 1 };
            aim = aim.min(NEXT_AIM * self.gap()).max(least_aim(settings));
        }
        let h = self.reduced.apply(&self.u)?;
        self.sweep = Sweep::new(&self.reduced, &self.r, &self.u, |b| (h[b], steps.z[b]))?;
        if self.is_certified(settings) || progress.is_finishing() {
            return Ok(());
        }
        self.next_steps = 2 * iterations;
        self.next_reweighting = self.next_reweighting.max(2 * iterations);
        self.reweight(progress)
    }

    /// One step and the bounds that come with it; `false` when no step downwards was found.
    fn step(
        &mut self,
        settings: &Settings,
        steps: &mut Steps<K>,
        barrier: f64,
        progress: &Progress,
    ) -> Result<bool> {
        /// Iterations of conjugate gradients for a step with an older factor, and the part of the residual
        /// that is enough. They cost as much as the factorization they save; a run longer than [`LONG`] says
        /// that the factor is too old for the next step.
        const MOST_GRADIENTS: usize = 10;
        const LONG: usize = 7;
        const GRADIENT_GOAL: f64 = 0.05;
        let model = Model::new(&self.reduced, &self.u, &steps.z, barrier)?;
        let mut z = memory::twin(model.slope())?;
        let is_new = !steps.is_near;
        if is_new {
            self.system.factorize(&mut self.reduced, Weighing::Stiffness(model.stiffness()), progress)?;
        }
        self.y.clear();
        let mut step = self.lacking(&z, None)?;
        if is_new {
            self.system.solve_change(&self.reduced, &mut step)?;
            steps.is_near = true;
        } else {
            let found = conjugate_gradients(
                |x| Ok(model.times(&self.reduced, x)?),
                |x| Ok(self.system.solve_change(&self.reduced, x).map(drop)?),
                step,
                GRADIENT_GOAL,
                MOST_GRADIENTS,
            )?;
            step = found.solution;
            steps.is_near = found.iterations < LONG;
        }
        self.keep_constraints(&mut step)?;
        let change = self.reduced.apply_change(&step)?;
        follow(model.stiffness(), &change, &mut z);
        self.correct(settings, if is_new { model.stiffness() } else { &steps.factored }, &step, &mut z)?;
        self.bound_at(&z)?;
        clip(&self.reduced, &mut z);
        if self.reduced.has_fidelity_everywhere {
            self.bound_at(&z)?;
        }
        steps.z = z;
        let found = model.descend(&self.reduced, &self.u, &step, &change)?;
        if is_new {
            steps.factored = model.into_stiffness();
        }
        let Some((u, primal)) = found else { return Ok(false) };
        self.u = u;
        self.offer(primal);
        Ok(true)
    }

    /// Corrects a step so that the linear constraints hold at its end, whatever rounding made of them before.
    fn keep_constraints(&self, step: &mut [[f64; K]]) -> Result<()> {
        let Some(constraints) = &self.reduced.constraints else { return Ok(()) };
        let mut end = memory::twin(&self.u)?;
        add(1.0, step, &mut end);
        let before = memory::twin(&end)?;
        constraints.correct(&mut end);
        add(-1.0, &before, &mut end);
        add(1.0, &end, step);
        Ok(())
    }

    /// Corrects a dual point for what its equations lack, with the stiffness that is `factored`.
    fn correct(
        &mut self,
        settings: &Settings,
        factored: &[Stiffness],
        step: &[[f64; K]],
        z: &mut [Block<K>],
    ) -> Result<()> {
        /// How often the dual point is corrected for what rounding and inexact steps leave over of its
        /// equations, and the part of the gap asked for that needs no correction.
        const MOST_CORRECTIONS: usize = 2;
        const NEGLIGIBLE: f64 = 0.1;
        let spread = spread(&self.u);
        let negligible = NEGLIGIBLE * settings.tolerance.unwrap_or(RESIDUAL_GOAL) * self.scale();
        for _ in 0..MOST_CORRECTIONS {
            let mut rest = self.lacking(z, Some(step))?;
            let left: f64 =
                rest.iter().map(|row| row.iter().zip(spread).map(|(x, s)| x.abs() * s).sum::<f64>()).sum();
            if left <= negligible {
                break;
            }
            let y = self.system.solve_change(&self.reduced, &mut rest)?;
            if self.y.is_empty() {
                self.y = y;
            } else {
                add(1.0, &y, &mut self.y);
            }
            let change = self.reduced.apply_change(&rest)?;
            follow(factored, &change, z);
        }
        Ok(())
    }

    /// What the dual equations lack: `2a(t − u − step) − Hᵀz − Aᵀy`.
    fn lacking(&self, z: &[Block<K>], step: Option<&[[f64; K]]>) -> Result<Vec<[f64; K]>> {
        let mut out = self.reduced.apply_transposed(|b| z[b])?;
        self.add_constraints(&mut out);
        for (i, row) in out.iter_mut().enumerate() {
            let twice = 2.0 * self.reduced.fidelity[i];
            for (c, g) in row.iter_mut().enumerate() {
                let at = self.u[i][c] + step.map_or(0.0, |step| step[i][c]);
                *g = twice * (self.reduced.target[i][c] - at) - *g;
            }
        }
        Ok(out)
    }

    fn bound_at(&mut self, z: &[Block<K>]) -> Result<()> {
        let mut g = self.reduced.apply_transposed(|b| z[b])?;
        self.add_constraints(&mut g);
        self.bound_from(&dual_point(&self.reduced, z), &g);
        Ok(())
    }
}

/// The relative gap at which the central path ends for a run.
fn least_aim(settings: &Settings) -> f64 {
    /// The part of the gap asked for that the central path aims at: the rest is for the distance from the
    /// path.
    const AIM: f64 = 0.8;
    AIM * settings.tolerance.unwrap_or(RESIDUAL_GOAL)
}
