//! A run of the fast solver: where it is, the best point so far, and what is certain of it.

use crate::progress::{Progress, Report};
use crate::solve::certificate::{bound_along_ray, DualPoint};
use crate::solve::cones::norm;
use crate::solve::fast::penalty::reweighted;
use crate::solve::fast::sweep::Sweep;
use crate::solve::fast::system::{System, Weighing};
use crate::solve::outcome::{Outcome, Warm};
use crate::solve::problem::{Problem, Settings, Status};
use crate::solve::reduced::Reduced;
use crate::Result;

/// The true error that a run without a tolerance aims at.
pub(super) const RESIDUAL_GOAL: f64 = 1e-4;

/// Iterations that cost as much as one factorization (12 to 20 measured, from 9k to 200k vertices).
pub(super) const FACTORIZATION: f64 = 15.0;

/// Alternating directions go this far at least: the steps need few factorizations from where the ridges show.
pub(super) const FIRST_STEPS: usize = 20;

/// Where a run is.
pub(super) struct Run<'r, 's, const K: usize> {
    pub(super) reduced: Reduced<'r, K>,
    pub(super) system: &'s mut System,
    pub(super) r: Vec<f64>,
    pub(super) sweep: Sweep<K>,
    pub(super) u: Vec<[f64; K]>,
    pub(super) y: Vec<[f64; K]>,
    pub(super) floor: f64,
    pub(super) best: Best<K>,
    pub(super) next_reweighting: usize,
    pub(super) next_steps: usize,
}

/// The best point so far, and the largest lower bound.
pub(super) struct Best<const K: usize> {
    pub(super) u: Vec<[f64; K]>,
    pub(super) primal: f64,
    pub(super) dual: f64,
}

impl<const K: usize> Run<'_, '_, K> {
    /// New penalties from the lengths that the blocks have now; split variables and multipliers stay.
    pub(super) fn reweight(&mut self, progress: &Progress) -> Result<()> {
        let r = reweighted(&self.lengths()?, &self.reduced.weights)?;
        self.system.factorize(&mut self.reduced, Weighing::Penalties(&r), progress)?;
        self.sweep = self.under(&r)?;
        self.r = r;
        Ok(())
    }

    /// The same split variables and multipliers under other penalties.
    pub(super) fn under(&self, r: &[f64]) -> Result<Sweep<K>> {
        Ok(Sweep::new(&self.reduced, r, &self.u, |b| self.sweep.split(&self.reduced.weights, &self.r, b))?)
    }

    /// Takes the present point, of this objective, if it is the best so far.
    pub(super) fn offer(&mut self, primal: f64) {
        if primal < self.best.primal && self.u.iter().flatten().all(|x| x.is_finite()) {
            self.best.primal = primal;
            self.best.u.clone_from(&self.u);
        }
    }

    /// Adds `Aᵀy`.
    pub(super) fn add_constraints(&self, g: &mut [[f64; K]]) {
        if let Some(constraints) = &self.reduced.constraints {
            constraints.add_transposed(&self.y, g);
        }
    }

    pub(super) fn bound_from(&mut self, q: &DualPoint, g: &[[f64; K]]) {
        self.best.dual = self.best.dual.max(bound_along_ray(&self.reduced, q, &self.y, g, &self.u));
    }

    /// The relative gap of the best point.
    pub(super) fn gap(&self) -> f64 {
        (self.best.primal - self.best.dual) / Problem::gap_scale(self.best.primal, self.floor)
    }

    /// What the gap is relative to.
    pub(super) fn scale(&self) -> f64 {
        Problem::gap_scale(self.best.primal, self.floor)
    }

    pub(super) fn is_certified(&self, settings: &Settings) -> bool {
        settings.tolerance.is_some_and(|tolerance| self.gap() <= tolerance)
    }

    /// How far it is: digits of the gap won, out of the digits asked for.
    pub(super) fn report(&self, settings: &Settings, iterations: usize) -> Report {
        let gap = self.gap();
        // At least one digit, so that the logarithms are sound whatever was asked for.
        let wanted = settings.tolerance.unwrap_or(RESIDUAL_GOAL).min(0.1);
        Report {
            fraction: if gap > wanted { (gap.ln() / wanted.ln()).clamp(0.0, 1.0) } else { 1.0 },
            stage: "solving".into(),
            iteration: iterations,
            energy: Some(self.best.primal),
            gap: Some(gap),
        }
    }

    /// The typical length of `(H u + c)_b` and `z_b`.
    pub(super) fn lengths(&self) -> Result<Vec<f64>> {
        let mut lengths = self.reduced.lengths(&self.u)?;
        for (b, length) in lengths.iter_mut().enumerate() {
            let z = self.sweep.split(&self.reduced.weights, &self.r, b).0;
            *length = 0.5 * (*length + norm(&z));
        }
        Ok(lengths)
    }

    pub(super) fn outcome(self, iterations: usize, status: Status) -> Result<Outcome<K>> {
        let length = self.lengths()?;
        let (z, p) = self.sweep.into_split(&self.reduced.weights, &self.r)?;
        Ok(Outcome {
            u: self.best.u,
            primal: self.best.primal,
            dual: self.best.dual,
            floor: self.floor,
            iterations,
            status,
            warm: Some(Warm { z, p, length }),
        })
    }
}
