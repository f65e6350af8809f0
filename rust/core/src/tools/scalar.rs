//! What denoising and interpolation have in common: one energy on a mesh, minimized under conditions.

use std::borrow::Cow;

use sprs::CsMat;

use super::answer;
use super::options::check_range;
use super::sharpness::{block_norms, sharpened_weights};
use super::unseen::{extend, unseen};
use super::{EnergyOptions, SolveOptions};
use crate::linear::Columns;
use crate::memory::{Demand, Tool};
use crate::mesh::{triangle, Mesh};
use crate::operators::{voronoi_mass, Energy};
use crate::progress::{Progress, Report};
use crate::solve::{quadratic, solve, Coupling, Problem, Settings, Solution};
use crate::unit::Unit;
use crate::{memory, Error, Result};

/// Reweighted rounds after the first solution: the weights hardly change after the third.
const SHARPENING_ROUNDS: usize = 3;

/// What every scalar problem can be told.
#[derive(Debug, Clone, Default)]
pub struct ScalarOptions {
    /// What to minimize.
    pub energy: EnergyOptions,
    /// `A` (p × n) and `b` (p × k) of `A u = b`.
    pub linear_constraints: Option<(CsMat<f64>, Columns)>,
    /// Joint or separate norms of several columns; quadratic energies do not tell them apart.
    pub coupling: Coupling,
    /// 0: the convex energy; toward 1: reweighted rounds with ever sharper ridges.
    /// For [`Energy::L1Hessian`] only.
    pub sharpness: f64,
    /// The solver.
    pub solve: SolveOptions,
}

/// Values to stay close to or to keep, and the options: Rowe et al. 2024, eq. (21) on a mesh.
pub(super) struct ScalarProblem<'a> {
    pub mesh: &'a Mesh,
    pub options: &'a ScalarOptions,
    /// `α`; zero for interpolation.
    pub fidelity: f64,
    pub target: Columns,
    pub fixed: Vec<bool>,
}

impl ScalarProblem<'_> {
    fn demand(&self) -> Demand {
        let tool = match self.options.energy.kind.is_quadratic() {
            true => Tool::Quadratic,
            false if self.fidelity > 0.0 => Tool::Denoise,
            false => Tool::Interpolate,
        };
        let is_joint = self.options.coupling == Coupling::Joint;
        let n_columns = if is_joint { self.target.n_columns } else { 1 };
        self.mesh.demand(tool).with_columns(n_columns, self.options.solve.solver.is_clarabel())
    }

    pub(super) fn run(self, progress: &Progress) -> Result<Solution> {
        let options = self.options;
        let settings = options.solve.settings()?;
        let kind = options.energy.kind;
        check_range("sharpness", options.sharpness, 0.0, 1.0)?;
        if options.sharpness > 0.0 && kind != Energy::L1Hessian {
            let problem = format!("works with the energy l1_hessian only, not {}; pass 0", kind.name());
            return Err(Error::argument("sharpness", problem));
        }
        options.energy.check_solver(options.solve.solver)?;
        let demand = self.demand();
        // Once before anything is made, and once on the threads that compute.
        demand.admit(options.solve.memory_limit)?;
        let right = options.linear_constraints.iter().flat_map(|(_, right)| &right.data);
        let value = Unit::of(self.target.data.iter().chain(right).copied());
        let length = self.mesh.unit();
        let energy = kind.unit(length, value);
        let fidelity = value.power(2).times(length.power(2)).times(energy.power(-1)).restore(self.fidelity);
        if self.fidelity > 0.0 && !fidelity.is_normal() {
            let problem = format!(
                "is {:e}; on a mesh and with values of this size that weighs {}; scale them to a size around \
                1",
                self.fidelity,
                if fidelity > 1.0 { "all there is" } else { "nothing" }
            );
            return Err(Error::argument("fidelity", problem));
        }
        let measured = self.mesh.measured(length)?;
        let (mesh, form) = options.energy.on(&measured)?;
        let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths())?;
        // With a fidelity or constraints, what the energy does not see is theirs.
        let mut open =
            unseen(&mesh, &form).filter(|_| fidelity == 0.0 && options.linear_constraints.is_none());
        if let Some(open) = &mut open {
            open.iter_mut().zip(&self.fixed).for_each(|(open, fixed)| *open &= !fixed);
        }
        let mut problem = Problem {
            operator: &form.operator,
            weights: memory::twin(&form.weights)?,
            fidelity: memory::gathered(mass.iter().map(|m| fidelity * m))?,
            target: match self.target.measured(value) {
                Cow::Borrowed(target) => target.copied()?,
                Cow::Owned(target) => target,
            },
            fixed: self.fixed,
            linear_constraints: options
                .linear_constraints
                .as_ref()
                .map(|(a, b)| (a.clone(), b.measured(value).into_owned())),
            coupling: options.coupling,
        };
        options.solve.run(|| {
            demand.admit(options.solve.memory_limit)?;
            let mut solution = if kind.is_quadratic() {
                quadratic::minimize(&problem, &settings, progress)?
            } else {
                sharpened(&mut problem, &mesh, options, &settings, progress)?
            };
            if let Some(open) = open {
                extend(&mesh, &open, &mut solution.values, progress)?;
            }
            answer::settle(&mut solution, &problem, kind.is_quadratic(), &settings)?;
            answer::restore(&mut solution, &problem.fixed, &self.target, value, energy)?;
            Ok(solution)
        })
    }
}

/// Solves an L1 problem, with reweighted rounds where sharpness asks for them.
fn sharpened(
    problem: &mut Problem<'_>,
    mesh: &Mesh,
    options: &ScalarOptions,
    settings: &Settings,
    progress: &Progress,
) -> Result<Solution> {
    let base = memory::twin(&problem.weights)?;
    let areas: Vec<f64> = memory::gathered(mesh.edge_lengths().iter().map(|&l| triangle::area(l)))?;
    let rounds = if options.sharpness > 0.0 { 1 + SHARPENING_ROUNDS } else { 1 };
    let mut solution = solve(problem, options.solve.solver, settings, progress)?;
    for round in 1..rounds {
        progress.report(Report {
            fraction: round as f64 / rounds as f64,
            stage: "sharpening".into(),
            iteration: round,
            energy: Some(solution.objective),
            gap: Some(solution.gap),
        });
        if progress.is_finishing() {
            break;
        }
        let norms = block_norms(problem.operator, &solution.values, options.coupling)?;
        problem.weights = sharpened_weights(&norms, &areas, &base, options.sharpness)?;
        let (iterations, factorisations) = (solution.iterations, solution.factorisations);
        solution = solve(problem, options.solve.solver, settings, progress)?;
        solution.iterations += iterations;
        solution.factorisations += factorisations;
    }
    Ok(solution)
}
