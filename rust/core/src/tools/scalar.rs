//! What denoising and interpolation have in common: one energy on a mesh, minimised under conditions.

use sprs::CsMat;

use super::options::{check_range, check_weights};
use super::sharpness::{block_norms, sharpened_weights};
use super::SolveOptions;
use crate::error::MeshError;
use crate::mesh::{triangle, Mesh};
use crate::operators::{Dual, Energy, EnergyForm};
use crate::progress::{Progress, Report};
use crate::solve::{quadratic, solve, Columns, Coupling, Problem, Settings, Solution, Solver};
use crate::{Error, Result};

/// Reweighted rounds after the first solution: the weights hardly change after the third.
const SHARPENING_ROUNDS: usize = 3;

/// What every scalar problem can be told.
#[derive(Debug, Clone, Default)]
pub struct ScalarOptions {
    /// What to minimise.
    pub energy: Energy,
    /// A weight for each face: smaller where ridges are welcome. See [`EnergyForm::new`] for energies that do not live on faces.
    pub face_weights: Option<Vec<f64>>,
    /// `A` (p × n) and `b` (p × k) of `A u = b`.
    pub linear_constraints: Option<(CsMat<f64>, Columns)>,
    /// Joint or separate norms of several columns; quadratic energies do not tell them apart.
    pub coupling: Coupling,
    /// Dual edges of the operator.
    pub dual: Dual,
    /// 0: the convex energy; towards 1: reweighted rounds with ever sharper ridges. For [`Energy::L1Hessian`] only.
    pub sharpness: f64,
    /// The solver.
    pub solve: SolveOptions,
}

/// Values to stay close to or to keep, and the options.
pub(super) struct ScalarProblem<'a> {
    pub mesh: &'a Mesh,
    pub options: &'a ScalarOptions,
    /// `α M`, one number a vertex; zero for interpolation.
    pub fidelity: Vec<f64>,
    pub target: Columns,
    pub fixed: Vec<bool>,
}

impl ScalarProblem<'_> {
    pub(super) fn run(self, progress: &Progress) -> Result<Solution> {
        let options = self.options;
        let settings = options.solve.settings()?;
        let connectivity = self.mesh.connectivity();
        check_range("sharpness", options.sharpness, 0.0, 1.0)?;
        check_weights("face_weights", options.face_weights.as_ref(), connectivity.n_faces(), "face")?;
        if options.sharpness > 0.0 && options.energy != Energy::L1Hessian {
            let name = options.energy.name();
            return Err(Error::argument(
                "sharpness",
                format!("works with the energy l1_hessian only, not {name}; pass 0"),
            ));
        }
        let form = EnergyForm::new(options.energy, self.mesh, options.face_weights.as_deref(), options.dual)?;
        refuse_empty(&form)?;
        let unseen = self.unseen(&form);
        let problem = Problem {
            operator: &form.operator,
            weights: form.weights.clone(),
            fidelity: self.fidelity,
            target: self.target,
            fixed: self.fixed,
            linear_constraints: options.linear_constraints.clone(),
            coupling: options.coupling,
        };
        options.solve.run(|| {
            let mut solution = if options.energy.is_quadratic() {
                quadratic_only(options.solve.solver, options.energy)?;
                quadratic::minimise(&problem, &settings, progress)?
            } else {
                let mut problem = problem;
                sharpened(&mut problem, self.mesh, options, &settings, progress)?
            };
            if let Some(unseen) = unseen {
                extend(self.mesh, &unseen, &mut solution.values, progress)?;
            }
            Ok(solution)
        })
    }

    /// The vertices of faces that no block of the energy touches and nothing else determines, if there are any: with the
    /// energies of Stein et al. 2018b, the tips of triangles with two boundary edges.
    fn unseen(&self, form: &EnergyForm) -> Option<Vec<bool>> {
        if self.options.linear_constraints.is_some() {
            return None;
        }
        let mut unseen = vec![false; self.fixed.len()];
        for &corner in self.mesh.connectivity().faces().iter().flatten() {
            unseen[corner as usize] = !self.fixed[corner as usize] && self.fidelity[corner as usize] == 0.0;
        }
        for (&column, value) in form.operator.columns.iter().zip(&form.operator.values) {
            if value.iter().any(|x| *x != 0.0) {
                unseen[column as usize] = false;
            }
        }
        unseen.contains(&true).then_some(unseen)
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
    let base = problem.weights.clone();
    let areas: Vec<f64> = mesh.edge_lengths().iter().map(|&l| triangle::area(l)).collect();
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
        let norms = block_norms(problem.operator, &solution.values, options.coupling);
        problem.weights = sharpened_weights(&norms, &areas, &base, options.sharpness);
        let (iterations, factorisations) = (solution.iterations, solution.factorisations);
        solution = solve(problem, options.solve.solver, settings, progress)?;
        solution.iterations += iterations;
        solution.factorisations += factorisations;
    }
    Ok(solution)
}

/// Sets the values of the `unseen` vertices so that the gradient jumps as little as possible there: linear extrapolation.
fn extend(mesh: &Mesh, unseen: &[bool], values: &mut Columns, progress: &Progress) -> Result<()> {
    let form = EnergyForm::new(Energy::L1EdgeLaplacian, mesh, None, Dual::default())?;
    let problem = Problem {
        operator: &form.operator,
        weights: form.weights,
        fidelity: vec![0.0; unseen.len()],
        target: values.clone(),
        fixed: unseen.iter().map(|unseen| !unseen).collect(),
        linear_constraints: None,
        coupling: Coupling::Separate,
    };
    *values = quadratic::minimise(&problem, &Settings::default(), progress)?.values;
    Ok(())
}

/// Refuses a solver by name for an energy that needs none.
pub(super) fn quadratic_only(solver: Solver, energy: Energy) -> Result<()> {
    match solver {
        Solver::Auto | Solver::Cholesky => Ok(()),
        _ => Err(Error::argument(
            "solver",
            format!("the energy {} is quadratic and solved by one factorisation; use auto", energy.name()),
        )),
    }
}

/// Refuses an operator without any entry: a mesh of loose or degenerate faces has no energy.
pub(super) fn refuse_empty(form: &EnergyForm) -> Result<()> {
    if form.operator.values.iter().any(|v| v.iter().any(|x| *x != 0.0)) {
        return Ok(());
    }
    if form.energy.is_extrinsic() {
        let problem =
            format!("{} needs vertices inside the surface, and this mesh has none; use another", form.energy.name());
        return Err(Error::argument("energy", problem));
    }
    Err(MeshError::NoFaces.into())
}
