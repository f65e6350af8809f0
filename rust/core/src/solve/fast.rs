//! The fast solver: alternating directions on `z = H u + c` with a penalty `R_b` per block.
//!
//! `(2a + HᵀRH) u = 2a·t + Hᵀ(R(z − c) − p)`, over-relaxation `h ← 1.7 (H u + c) − 0.7 z`, shrinkage
//! `z ← shrink(h + p/R, w/R)`, multipliers `p ← p + R (h − z)`. The point `p + R(Hu + c − z)` before the shrinkage solves
//! the dual equations exactly, which is what the certificate is made of.

use rayon::prelude::*;

use crate::block_rows::BLOCK;
use crate::progress::{Progress, Report};
use crate::solve::certificate::bound_along_ray;
use crate::solve::cones::{combine, norm, scaled, shrink, Block};
use crate::solve::penalty::{reweighted, uniform_scale};
use crate::solve::problem::{Problem, Settings, Status};
use crate::solve::reduced::{Reduced, GRAIN};
use crate::solve::system::System;
use crate::Result;

/// Over-relaxation: 1.5 to 1.8 is usual for alternating directions; 1.7 was the best measured.
const RELAXATION: f64 = 1.7;

/// Iterations between two looks at the certificate and the stopping rules.
const CHECK_EVERY: usize = 5;

/// Default bound on the iterations; a problem that needs more is better served by an interior-point method.
const MAX_ITERATIONS: usize = 3000;

/// Without a tolerance the iteration stops when the objective falls by less than this part between two checks and
/// `H u + c` and `z` differ by less than [`SPLIT_RESIDUAL`]: the true error is then about this part.
const RESIDUAL_GOAL: f64 = 1e-4;
const SPLIT_RESIDUAL: f64 = 2e-2;

/// A gap this small also means a true error of about 1e-4: the bound is the slower of the two by a factor of ten (measured
/// on the flow), so there is no need to wait for the residuals.
const GAP_ENOUGH: f64 = 1e-3;

/// The first new penalties come after this many iterations from nothing, when the ridges begin to show, and then each
/// time the iterations have tripled.
const REWEIGHT_COLD: usize = 8;

/// A warm start brings good penalties along.
const REWEIGHT_WARM: usize = 30;

/// What a finished run leaves to the next, similar problem, in units that survive new weights and a new operator.
#[derive(Debug, Clone)]
pub struct Warm<const K: usize> {
    /// The split variable.
    pub z: Vec<Block<K>>,
    /// The multipliers, divided by the weights.
    pub p: Vec<Block<K>>,
    /// The typical length of `(H u + c)_b` and `z_b`.
    pub length: Vec<f64>,
}

/// The result of a run, free rows only.
#[derive(Debug)]
pub struct Outcome<const K: usize> {
    /// The best point found.
    pub u: Vec<[f64; K]>,
    /// Its objective.
    pub primal: f64,
    /// The best lower bound found.
    pub dual: f64,
    /// What counts as an objective of zero, see [`Reduced::floor`].
    pub floor: f64,
    /// Iterations made.
    pub iterations: usize,
    /// Why it stopped.
    pub status: Status,
    /// For the next problem, from solvers that can use it.
    pub warm: Option<Warm<K>>,
}

/// Minimises a reduced problem.
///
/// # Errors
/// A failed factorisation, dependent constraints, or [`crate::Error::Cancelled`].
pub fn minimise<const K: usize>(
    reduced: Reduced<'_, K>,
    system: &mut System,
    warm: Option<Warm<K>>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Outcome<K>> {
    let mut h = Vec::new();
    reduced.apply(&reduced.target, &mut h);
    let floor = reduced.floor(&h);
    let primal = reduced.objective(&reduced.target, &h);
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
    Run::new(reduced, system, warm, h, floor, progress)?.iterate(settings, progress)
}

struct Run<'r, 's, const K: usize> {
    reduced: Reduced<'r, K>,
    system: &'s mut System,
    r: Vec<f64>,
    z: Vec<Block<K>>,
    p: Vec<Block<K>>,
    u: Vec<[f64; K]>,
    previous: Vec<[f64; K]>,
    h: Vec<Block<K>>,
    /// `R(z − c) − p` of the last step.
    split: Vec<Block<K>>,
    right: Vec<[f64; K]>,
    y: Vec<[f64; K]>,
    floor: f64,
    best: Best<K>,
    next_reweighting: usize,
}

struct Best<const K: usize> {
    u: Vec<[f64; K]>,
    primal: f64,
    dual: f64,
}

impl<'r, 's, const K: usize> Run<'r, 's, K> {
    /// `h` is the operator applied to the target, `floor` what counts as zero.
    fn new(
        mut reduced: Reduced<'r, K>,
        system: &'s mut System,
        warm: Option<Warm<K>>,
        h: Vec<Block<K>>,
        floor: f64,
        progress: &Progress,
    ) -> Result<Self> {
        let m = reduced.constant.len();
        let (r, z, p, next_reweighting) = match warm {
            Some(warm) => {
                let p = warm.p.iter().zip(reduced.weights).map(|(p, w)| scaled(*w, p)).collect();
                (reweighted(&warm.length, reduced.weights), warm.z, p, REWEIGHT_WARM)
            }
            None => {
                let scale = uniform_scale(&mut reduced, system, &h, progress)?;
                let zero = vec![[[0.0; K]; BLOCK]; m];
                (reduced.weights.iter().map(|w| scale * w).collect(), zero.clone(), zero, REWEIGHT_COLD)
            }
        };
        system.factorise(&mut reduced, &r)?;
        let best = Best { u: reduced.target.clone(), primal: f64::INFINITY, dual: 0.0 };
        let (u, previous) = (reduced.target.clone(), Vec::new());
        Ok(Self {
            reduced,
            system,
            r,
            z,
            p,
            u,
            previous,
            h,
            split: Vec::new(),
            right: Vec::new(),
            y: Vec::new(),
            floor,
            best,
            next_reweighting,
        })
    }

    fn iterate(mut self, settings: &Settings, progress: &Progress) -> Result<Outcome<K>> {
        let max = settings.max_iterations.unwrap_or(MAX_ITERATIONS).max(1);
        let mut status = Status::Inaccurate;
        let mut iterations = 0;
        let mut last_check = f64::INFINITY;
        while iterations < max {
            progress.check()?;
            if progress.is_finishing() && iterations > 0 {
                status = Status::Stopped;
                break;
            }
            iterations += 1;
            self.step_u();
            let primal = self.reduced.objective(&self.u, &self.h);
            if primal < self.best.primal && self.is_feasible() {
                self.best.primal = primal;
                self.best.u.clone_from(&self.u);
            }
            let check = iterations % CHECK_EVERY == 0 || iterations == max;
            if check {
                self.bound_from_equations();
            }
            self.step_z();
            if check {
                self.bound_from_multipliers();
                if self.is_done(settings, last_check) {
                    status = Status::Solved;
                    break;
                }
                last_check = self.best.primal;
                if settings.announce {
                    progress.report(self.report(settings, iterations));
                }
            }
            if iterations == self.next_reweighting {
                self.next_reweighting *= 3;
                self.r = reweighted(&self.lengths(), self.reduced.weights);
                self.system.factorise(&mut self.reduced, &self.r)?;
            }
        }
        Ok(self.outcome(iterations, status))
    }

    fn step_u(&mut self) {
        let (r, z, p, c) = (&self.r, &self.z, &self.p, &self.reduced.constant);
        (0..z.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|b| {
                let split = combine(r[b], &z[b], -r[b], &c[b]);
                combine(1.0, &split, -1.0, &p[b])
            })
            .collect_into_vec(&mut self.split);
        self.reduced.apply_transposed(&self.split, &mut self.right);
        self.previous.clone_from(&self.u);
        self.y = self.system.solve(&self.reduced, &self.right, &mut self.u);
        self.reduced.apply(&self.u, &mut self.h);
    }

    /// Shrinkage and multipliers.
    fn step_z(&mut self) {
        let (r, w, h) = (&self.r, self.reduced.weights, &self.h);
        self.z.par_iter_mut().zip(self.p.par_iter_mut()).enumerate().with_min_len(GRAIN).for_each(|(b, (z, p))| {
            if r[b] > 0.0 {
                let relaxed = combine(RELAXATION, &h[b], 1.0 - RELAXATION, z);
                let moved = combine(1.0, &relaxed, 1.0 / r[b], p);
                *z = shrink(&moved, w[b] / r[b]);
                *p = combine(r[b], &moved, -r[b], z);
            }
        });
    }

    /// `Σ w ‖H u + c − z‖` over `Σ w ‖H u + c‖`.
    fn residual(&self) -> f64 {
        let (mut off, mut all) = (0.0, 0.0);
        for ((h, z), w) in self.h.iter().zip(&self.z).zip(self.reduced.weights) {
            off += w * norm(&combine(1.0, h, -1.0, z));
            all += w * norm(h);
        }
        off / all.max(f64::MIN_POSITIVE)
    }

    /// The lower bound from `p + R (H u + c − z)`, whose `Hᵀq + Aᵀy` the linear system has already computed.
    fn bound_from_equations(&mut self) {
        let q: Vec<Block<K>> = (0..self.h.len())
            .map(|b| {
                let gap = combine(1.0, &self.h[b], -1.0, &self.z[b]);
                combine(1.0, &self.p[b], self.r[b], &gap)
            })
            .collect();
        let g: Vec<[f64; K]> = (0..self.u.len())
            .map(|i| {
                let (a, proximal) = (2.0 * self.reduced.fidelity[i], self.system.proximal()[i]);
                let (t, u, before) = (&self.reduced.target[i], &self.u[i], &self.previous[i]);
                std::array::from_fn(|c| a * (t[c] - u[c]) + proximal * (before[c] - u[c]))
            })
            .collect();
        self.best.dual = self.best.dual.max(bound_along_ray(&self.reduced, &q, &self.y, &g, &self.u));
    }

    /// The lower bound from the multipliers themselves, which are never too long; needs fidelity everywhere.
    fn bound_from_multipliers(&mut self) {
        if self.reduced.fidelity.iter().any(|a| *a <= 0.0) {
            return;
        }
        let mut g = Vec::new();
        self.reduced.apply_transposed(&self.p, &mut g);
        if let Some(constraints) = &self.reduced.constraints {
            constraints.add_transposed(&self.y, &mut g);
        }
        self.best.dual = self.best.dual.max(bound_along_ray(&self.reduced, &self.p, &self.y, &g, &self.u));
    }

    fn is_feasible(&self) -> bool {
        self.u.iter().flatten().all(|x| x.is_finite())
    }

    fn is_done(&self, settings: &Settings, last_check: f64) -> bool {
        let scale = Problem::gap_scale(self.best.primal, self.floor);
        match settings.tolerance {
            Some(tolerance) => self.best.primal - self.best.dual <= tolerance * scale,
            None => {
                self.best.primal - self.best.dual <= GAP_ENOUGH * scale
                    || (last_check - self.best.primal < RESIDUAL_GOAL * scale && self.residual() < SPLIT_RESIDUAL)
            }
        }
    }

    /// How far it is: digits of the gap won, out of the digits asked for.
    fn report(&self, settings: &Settings, iterations: usize) -> Report {
        let gap = (self.best.primal - self.best.dual) / Problem::gap_scale(self.best.primal, self.floor);
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

    fn lengths(&self) -> Vec<f64> {
        self.h.iter().zip(&self.z).map(|(h, z)| 0.5 * (norm(h) + norm(z))).collect()
    }

    fn outcome(self, iterations: usize, status: Status) -> Outcome<K> {
        let length = self.lengths();
        let p = self.p.iter().zip(self.reduced.weights);
        let p = p.map(|(p, w)| if *w > 0.0 { scaled(1.0 / w, p) } else { *p }).collect();
        Outcome {
            u: self.best.u,
            primal: self.best.primal,
            dual: self.best.dual,
            floor: self.floor,
            iterations,
            status,
            warm: Some(Warm { z: self.z, p, length }),
        }
    }
}
