//! Denoising of functions on a surface (Rowe et al. 2024, eqs. (21) and (23)).

use sprs::CsMat;

use super::options::{check_range, check_weights};
use super::sharpness::{block_norms, sharpened_weights};
use super::SolveOptions;
use crate::block_rows::BlockRows;
use crate::mesh::{triangle, Mesh};
use crate::operators::{voronoi_mass, Dual, HessianPattern};
use crate::progress::{Progress, Report};
use crate::solve::{solve, Columns, Coupling, Problem, Solution};
use crate::{Error, Result};

/// Reweighted rounds after the first solution: the weights hardly change after the third.
const SHARPENING_ROUNDS: usize = 3;

/// How to denoise.
#[derive(Debug, Clone)]
pub struct DenoiseOptions {
    /// `α`: how close to stay to the data.
    pub fidelity: f64,
    /// Vertices that keep their values.
    pub fixed: Option<Vec<bool>>,
    /// A weight for each face: smaller where ridges are welcome.
    pub face_weights: Option<Vec<f64>>,
    /// `A` (p × n) and `b` (p × k) of `A u = b`.
    pub linear_constraints: Option<(CsMat<f64>, Columns)>,
    /// Joint or separate norms of several columns.
    pub coupling: Coupling,
    /// Dual edges of the operator.
    pub dual: Dual,
    /// 0: the convex energy; towards 1: reweighted rounds with ever sharper ridges.
    pub sharpness: f64,
    /// The solver.
    pub solve: SolveOptions,
}

impl Default for DenoiseOptions {
    fn default() -> Self {
        Self {
            fidelity: 1.0,
            fixed: None,
            face_weights: None,
            linear_constraints: None,
            coupling: Coupling::Joint,
            dual: Dual::Barycentric,
            sharpness: 0.0,
            solve: SolveOptions::default(),
        }
    }
}

/// `min_u Σ_f w_f A_f ‖H_f u‖ + α (u − u₀)ᵀ M (u − u₀)`, for the columns of `values` (n × k) on the vertices.
///
/// Source: Rowe et al. 2024, eqs. (21) and (23).
///
/// # Errors
/// Arguments of the wrong shape or range, a fidelity that is not positive, circumcentric duals that do not exist, and the
/// errors of [`solve`].
pub fn denoise(mesh: &Mesh, values: &Columns, options: &DenoiseOptions, progress: &Progress) -> Result<Solution> {
    if !(options.fidelity > 0.0 && options.fidelity.is_finite()) {
        return Err(Error::argument("fidelity", format!("is {}; it must be positive", options.fidelity)));
    }
    let n = mesh.connectivity().n_vertices();
    values.check("values", n)?;
    let mass = voronoi_mass(mesh.connectivity(), mesh.edge_lengths());
    let fixed = options.fixed.clone().unwrap_or_else(|| vec![false; n]);
    let problem = ScalarProblem {
        mesh,
        face_weights: options.face_weights.as_ref(),
        fidelity: mass.iter().map(|m| options.fidelity * m).collect(),
        target: values.clone(),
        fixed,
        linear_constraints: options.linear_constraints.clone(),
        coupling: options.coupling,
        dual: options.dual,
        sharpness: options.sharpness,
        solve: &options.solve,
    };
    problem.run(progress)
}

/// A problem (21) on a mesh, with sharpening rounds: what denoising and interpolation have in common.
pub(super) struct ScalarProblem<'a> {
    pub mesh: &'a Mesh,
    pub face_weights: Option<&'a Vec<f64>>,
    pub fidelity: Vec<f64>,
    pub target: Columns,
    pub fixed: Vec<bool>,
    pub linear_constraints: Option<(CsMat<f64>, Columns)>,
    pub coupling: Coupling,
    pub dual: Dual,
    pub sharpness: f64,
    pub solve: &'a SolveOptions,
}

impl ScalarProblem<'_> {
    pub(super) fn run(self, progress: &Progress) -> Result<Solution> {
        let settings = self.solve.settings()?;
        let (connectivity, lengths) = (self.mesh.connectivity(), self.mesh.edge_lengths());
        check_range("sharpness", self.sharpness, 0.0, 1.0)?;
        check_weights("face_weights", self.face_weights, connectivity.n_faces(), "face")?;
        let operator = HessianPattern::new(connectivity).assemble(connectivity, lengths, self.dual)?;
        refuse_empty(&operator)?;
        let areas: Vec<f64> = lengths.iter().map(|&l| triangle::area(l)).collect();
        let base = self.face_weights.cloned().unwrap_or_else(|| vec![1.0; areas.len()]);
        let mut problem = Problem {
            operator: &operator,
            weights: base.clone(),
            fidelity: self.fidelity,
            target: self.target,
            fixed: self.fixed,
            linear_constraints: self.linear_constraints,
            coupling: self.coupling,
        };
        let rounds = if self.sharpness > 0.0 { 1 + SHARPENING_ROUNDS } else { 1 };
        self.solve.run(|| {
            let mut solution = solve(&problem, self.solve.solver, &settings, progress)?;
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
                let norms = block_norms(&operator, &solution.values, self.coupling);
                problem.weights = sharpened_weights(&norms, &areas, &base, self.sharpness);
                let iterations = solution.iterations;
                solution = solve(&problem, self.solve.solver, &settings, progress)?;
                solution.iterations += iterations;
            }
            Ok(solution)
        })
    }
}

/// Refuses an operator without any entry: a mesh of loose or degenerate faces has no Hessian.
fn refuse_empty(operator: &BlockRows) -> Result<()> {
    if operator.values.iter().all(|v| v.iter().all(|x| *x == 0.0)) {
        return Err(crate::error::MeshError::NoFaces.into());
    }
    Ok(())
}
