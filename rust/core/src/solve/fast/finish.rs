//! The end of a run by Newton steps, where alternating directions would take long.

use super::{Run, FACTORISATION};
use crate::error::SolveError;
use crate::progress::Progress;
use crate::solve::newton::Model;
use crate::solve::penalty::stiff;
use crate::solve::problem::{Problem, Settings};
use crate::solve::sweep::Sweep;
use crate::{Error, Result};

/// Newton steps converge once the objective falls by less than this part between two checks (measured: at 1e-5 the first steps
/// are often lost, at 1e-6 hardly ever).
const NEWTON_STILL: f64 = 2e-6;

/// Where more iterations than this are left, steps that may be lost are worth a try the sooner: the bound grows with what is
/// left, to this many times. At a million vertices an interpolation otherwise went on for 300 iterations and more.
const MANY_LEFT: f64 = 60.0;
const MOST_IMPATIENCE: f64 = 10.0;

/// A Newton step that leaves more than this part of the gap is the last for a while: as many iterations as were made so far.
const NEWTON_GAIN: f64 = 0.5;

impl<const K: usize> Run<'_, '_, K> {
    /// Whether Newton steps would converge, and a factorisation for one costs less than the iterations that are `left`.
    pub(super) fn newton_pays(&self, settings: &Settings, iterations: usize, last_primal: f64, left: f64) -> bool {
        let scale = Problem::gap_scale(self.best.primal, self.floor);
        let impatience = (left / MANY_LEFT).clamp(1.0, MOST_IMPATIENCE);
        let is_still = last_primal - self.best.primal < NEWTON_STILL * impatience * scale;
        // A joint norm of several columns would couple them in the matrix.
        let is_possible = self.reduced.n_columns == 1 && settings.tolerance.is_some();
        is_possible && iterations >= self.next_newton && is_still && left > FACTORISATION
    }

    /// Newton steps as long as each gains enough; then back to alternating directions, with new penalties.
    pub(super) fn newton(&mut self, settings: &Settings, iterations: usize, progress: &Progress) -> Result<()> {
        loop {
            progress.check()?;
            let before = self.gap();
            let moved = match self.newton_step(settings) {
                // Alternating directions have a tamer matrix.
                Err(Error::Solve(SolveError::Factorisation { .. })) => false,
                moved => moved?,
            };
            if self.is_certified(settings) || progress.is_finishing() {
                return Ok(());
            }
            if !moved || self.gap() > NEWTON_GAIN * before {
                break;
            }
        }
        self.next_newton = 2 * iterations;
        self.next_reweighting = self.next_reweighting.max(2 * iterations);
        self.reweight()
    }

    /// One Newton step and the bounds that come with it; `false` when no step downwards was found.
    fn newton_step(&mut self, settings: &Settings) -> Result<bool> {
        let r = stiff(&self.lengths(), &self.reduced.weights);
        self.sweep = self.under(&r);
        self.r = r;
        let model = Model::new(&self.reduced, &self.r, &self.sweep, &self.u);
        self.system.factorise_stiff(&mut self.reduced, &model.stiffness)?;
        self.previous.clone_from(&self.u);
        self.y = self.system.solve(&self.reduced, &model.right(&self.reduced), &mut self.u);
        let mut h = Vec::new();
        self.reduced.apply(&self.u, &mut h);
        let (q, mut g) = model.dual_point(&self.reduced, &h, false);
        self.add_constraints(&mut g);
        self.refine_if_worth(&g, settings);
        self.bound_from(&q, &g);
        if self.reduced.has_fidelity_everywhere {
            let (q, mut g) = model.dual_point(&self.reduced, &h, true);
            self.add_constraints(&mut g);
            self.bound_from(&q, &g);
        }
        let Some(step) = model.descend(&self.reduced, &self.r, &self.previous, &self.u, &h) else {
            self.u.clone_from(&self.previous);
            return Ok(false);
        };
        self.sweep = Sweep::resume(&self.reduced, &self.r, |b| model.state(&step, &self.r, b));
        self.u = step.u;
        self.offer(step.primal);
        Ok(true)
    }
}
