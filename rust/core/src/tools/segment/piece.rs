//! A connected piece of the surface: a functional (41) of its own, but for the fidelity, minimized to its own
//! end.

use super::constants::{LEAST_WEIGHT, MOST_ALTERNATIONS};
use super::indicator_step::IndicatorStep;
use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::progress::Progress;
use crate::solve::{solve, Coupling, Problem, Session, Settings, Solution, Solver, Status};
use crate::tools::sharpness::block_norms;
use crate::{memory, Result};

/// A piece, and where its minimization is.
pub(super) struct Piece {
    /// Its vertices in the mesh.
    pub rows: Vec<u32>,
    /// Its faces in the mesh.
    pub faces: Vec<u32>,
    /// `u`
    pub values: Columns,
    /// `v`
    pub indicator: Vec<f64>,
    /// Alternations so far.
    pub alternations: usize,
    /// Whether the caller has asked to finish early.
    pub is_stopped: bool,
    /// Its area.
    pub total: f64,
    operator: BlockRows,
    mass: Vec<f64>,
    fixed: Vec<bool>,
    areas: Vec<f64>,
    /// `u₀`
    start: Columns,
    solver: Session,
    step: IndicatorStep,
}

/// How the values are solved for.
pub(super) struct Solving<'a> {
    /// `α`
    pub fidelity: f64,
    pub solver: Solver,
    pub settings: &'a Settings,
    pub progress: &'a Progress,
}

impl Piece {
    /// These rows and faces, with what belongs to them and without a border.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(
        [rows, faces]: [Vec<u32>; 2],
        operator: BlockRows,
        mass: Vec<f64>,
        areas: Vec<f64>,
        start: Columns,
        step: IndicatorStep,
    ) -> Result<Self> {
        Ok(Self {
            values: start.copied()?,
            indicator: memory::repeated(1.0, faces.len())?,
            alternations: 0,
            is_stopped: false,
            total: mass.iter().sum(),
            fixed: memory::gathered(mass.iter().map(|m| *m <= 0.0))?,
            solver: Session::new(),
            rows,
            faces,
            operator,
            mass,
            areas,
            start,
            step,
        })
    }

    /// Both minimizations in turns for one `ε`, until `v` changes by less than `enough` in the square;
    /// `report` hears how far that is, the alternations, and the energy after each.
    ///
    /// # Errors
    /// A failed factorization, or [`crate::Error::Cancelled`].
    pub(super) fn alternate(
        &mut self,
        epsilon: f64,
        enough: f64,
        solving: &Solving<'_>,
        report: impl Fn(f64, usize, f64),
    ) -> Result<()> {
        self.step.prepare(epsilon);
        for alternation in 0..MOST_ALTERNATIONS {
            solving.progress.check()?;
            if solving.progress.is_finishing() && self.alternations > 0 {
                self.is_stopped = true;
                return Ok(());
            }
            let norms = block_norms(&self.operator, &self.values, Coupling::Joint)?;
            let v = self.step.minimize(&norms, solving.progress)?;
            let change = self.mean_squared_change(&v);
            self.indicator = v;
            let energy = self.update_values(solving)?;
            self.alternations += 1;
            report(1.0 - 0.5_f64.powi(alternation as i32 + 1), self.alternations, energy);
            if change <= enough {
                break;
            }
        }
        Ok(())
    }

    fn mean_squared_change(&self, v: &[f64]) -> f64 {
        let sum: f64 = v
            .iter()
            .zip(&self.indicator)
            .zip(&self.areas)
            .map(|((a, b), area)| area * (a - b) * (a - b))
            .sum();
        sum / self.total.max(f64::MIN_POSITIVE)
    }

    /// The square of `u − u₀`, integrated, all columns together.
    pub(super) fn squared_residual(&self) -> f64 {
        let (u, start) = (&self.values, &self.start);
        (0..u.n_columns)
            .map(|c| {
                let pairs = u.column(c).iter().zip(start.column(c)).zip(&self.mass);
                pairs.map(|((x, y), m)| m * (x - y) * (x - y)).sum::<f64>()
            })
            .sum()
    }

    /// `u ← argmin α (u − u₀)ᵀ M (u − u₀) + Σ v_f² ‖(H u)_f‖`; returns the energy there.
    ///
    /// # Errors
    /// A failed factorization, or [`crate::Error::Cancelled`].
    pub(super) fn update_values(&mut self, solving: &Solving<'_>) -> Result<f64> {
        let problem = Problem {
            operator: &self.operator,
            weights: memory::gathered(self.indicator.iter().map(|v| (v * v).max(LEAST_WEIGHT)))?,
            fidelity: memory::gathered(self.mass.iter().map(|m| solving.fidelity * m))?,
            target: self.start.copied()?,
            fixed: memory::twin(&self.fixed)?,
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let Solving { settings, progress, .. } = *solving;
        let solution: Solution = match solving.solver {
            Solver::Auto | Solver::Fast => self.solver.solve(&problem, settings, progress)?,
            solver => solve(&problem, solver, settings, progress)?,
        };
        self.is_stopped |= solution.status == Status::Stopped;
        self.values = solution.values;
        Ok(solution.objective)
    }
}
