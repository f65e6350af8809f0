//! The alternating minimization of the Ambrosio-Tortorelli functional with the L1 Hessian (Rowe et al. 2024,
//! eq. (41)).

use super::constants::{LEAST_WEIGHT, MOST_ALTERNATIONS, NOISE_POWER, NOISE_SEARCH};
use super::indicator_step::IndicatorStep;
use super::surface::Surface;
use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::operators::{voronoi_mass, Dual, HessianPattern};
use crate::progress::{Progress, Report};
use crate::solve::{solve, Coupling, Problem, Session, Settings, Solution, Solver, Status};
use crate::tools::sharpness::block_norms;
use crate::{memory, Result};

/// How the functional is minimized.
pub(super) struct Functional<'a> {
    pub surface: &'a Surface<'a>,
    /// `u₀`, in the unit of the segmentation.
    pub values: &'a Columns,
    /// `λ` times a factor for each face.
    pub length_weight: f64,
    pub face_costs: &'a [f64],
    /// `α` to start with.
    pub fidelity: f64,
    /// The noise that the fidelity follows: it falls until `u` differs from `u₀` by as much.
    /// `None` keeps the fidelity.
    pub noise: Option<f64>,
    /// The values of `ε`, one after the other.
    pub epsilons: Vec<f64>,
    /// The mean squared change of `v` under which an alternation was the last for its `ε`.
    pub inner_tolerance: f64,
    pub solver: Solver,
    pub settings: Settings,
}

/// Where the minimization ended.
pub(super) struct Minimizer {
    /// `u`
    pub values: Columns,
    /// `v`, one for each face.
    pub indicator: Vec<f64>,
    /// `α` at the end.
    pub fidelity: f64,
    /// Alternations, all `ε` together.
    pub alternations: usize,
    /// `Stopped` if the caller asked to finish early.
    pub status: Status,
}

impl Functional<'_> {
    /// Minimizes Rowe et al. 2024, eq. (25), in matrices eq. (41), for every `ε` in turn,
    /// starting each from the last.
    ///
    /// # Errors
    /// A failed factorization, or [`crate::Error::Cancelled`].
    pub(super) fn minimize(&self, progress: &Progress) -> Result<Minimizer> {
        let surface = self.surface;
        let operator = self.operator()?;
        let mass = voronoi_mass(surface.connectivity, &surface.lengths)?;
        let mut run = Run {
            functional: self,
            operator: &operator,
            total: mass.iter().sum(),
            fixed: memory::gathered(mass.iter().map(|m| *m <= 0.0))?,
            mass,
            solver: Session::new(),
            step: IndicatorStep::new(surface, self.length_weight, self.face_costs)?,
            progress,
            reached: Minimizer {
                values: self.values.copied()?,
                indicator: memory::repeated(1.0, surface.n_faces())?,
                fidelity: self.fidelity,
                alternations: 0,
                status: Status::Solved,
            },
        };
        if self.noise.is_some() {
            run.follow_noise()?;
        }
        for (level, &epsilon) in self.epsilons.iter().enumerate() {
            run.alternate(level, epsilon)?;
            if run.reached.status == Status::Stopped {
                break;
            }
        }
        Ok(run.reached)
    }

    /// The Hessian of the surface.
    fn operator(&self) -> Result<BlockRows> {
        let (connectivity, lengths) = (self.surface.connectivity, &self.surface.lengths);
        HessianPattern::new(connectivity)?.assemble(connectivity, lengths, Dual::Barycentric)
    }

    /// The minimizer over `v` alone, for the last `ε` and the values as they are:
    /// where nothing is to be smoothed.
    ///
    /// # Errors
    /// A failed factorization, or [`crate::Error::Cancelled`].
    pub(super) fn indicate(&self, progress: &Progress) -> Result<Minimizer> {
        progress.check()?;
        let surface = self.surface;
        let operator = self.operator()?;
        let mut step = IndicatorStep::new(surface, self.length_weight, self.face_costs)?;
        if let Some(epsilon) = self.epsilons.last() {
            step.prepare(*epsilon);
        }
        Ok(Minimizer {
            values: self.values.copied()?,
            indicator: step.minimize(&block_norms(&operator, self.values, Coupling::Joint)?)?,
            fidelity: self.fidelity,
            alternations: 1,
            status: Status::Solved,
        })
    }
}

struct Run<'a> {
    functional: &'a Functional<'a>,
    operator: &'a BlockRows,
    mass: Vec<f64>,
    total: f64,
    fixed: Vec<bool>,
    solver: Session,
    step: IndicatorStep,
    progress: &'a Progress,
    reached: Minimizer,
}

impl Run<'_> {
    /// Lowers the fidelity, still without any border, until `u` differs from `u₀` by the noise (Morozov's
    /// principle). Without it the first `v` would take the noise for borders and keep it.
    fn follow_noise(&mut self) -> Result<()> {
        let Some(noise) = self.functional.noise else { return Ok(()) };
        for attempt in 0..NOISE_SEARCH.steps {
            self.report(0.1 * attempt as f64 / NOISE_SEARCH.steps as f64, "noise", attempt, None);
            self.update_values()?;
            let left = self.residual();
            if left >= noise * (1.0 - NOISE_SEARCH.rest) || self.reached.status == Status::Stopped {
                break;
            }
            let factor = (left / noise).max(0.05).powf(NOISE_POWER).max(1e-3);
            self.reached.fidelity *= factor;
        }
        Ok(())
    }

    /// Root mean square of `u − u₀` over the surface, all columns together.
    fn residual(&self) -> f64 {
        let (u, start) = (&self.reached.values, self.functional.values);
        let sum: f64 = (0..u.n_columns)
            .map(|c| {
                let pairs = u.column(c).iter().zip(start.column(c)).zip(&self.mass);
                pairs.map(|((x, y), m)| m * (x - y) * (x - y)).sum::<f64>()
            })
            .sum();
        (sum / self.total.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Both minimizations in turns for one `ε`.
    fn alternate(&mut self, level: usize, epsilon: f64) -> Result<()> {
        self.step.prepare(epsilon);
        let levels = self.functional.epsilons.len();
        for alternation in 0..MOST_ALTERNATIONS {
            self.progress.check()?;
            if self.progress.is_finishing() && self.reached.alternations > 0 {
                self.reached.status = Status::Stopped;
                return Ok(());
            }
            let norms = block_norms(self.operator, &self.reached.values, Coupling::Joint)?;
            let v = self.step.minimize(&norms)?;
            let change = self.mean_squared_change(&v);
            self.reached.indicator = v;
            let energy = self.update_values()?;
            self.reached.alternations += 1;
            let inner = 1.0 - 0.5_f64.powi(alternation as i32 + 1);
            let fraction = 0.1 + 0.8 * (level as f64 + inner) / levels as f64;
            self.report(fraction, "borders", self.reached.alternations, Some(energy));
            if change <= self.functional.inner_tolerance {
                break;
            }
        }
        Ok(())
    }

    fn mean_squared_change(&self, v: &[f64]) -> f64 {
        let areas = &self.functional.surface.areas;
        let sum: f64 = v
            .iter()
            .zip(&self.reached.indicator)
            .zip(areas)
            .map(|((a, b), area)| area * (a - b) * (a - b))
            .sum();
        sum / self.total.max(f64::MIN_POSITIVE)
    }

    /// `u ← argmin α (u − u₀)ᵀ M (u − u₀) + Σ v_f² ‖(H u)_f‖`; returns the energy there.
    fn update_values(&mut self) -> Result<f64> {
        let alpha = self.reached.fidelity;
        let problem = Problem {
            operator: self.operator,
            weights: memory::gathered(self.reached.indicator.iter().map(|v| (v * v).max(LEAST_WEIGHT)))?,
            fidelity: memory::gathered(self.mass.iter().map(|m| alpha * m))?,
            target: self.functional.values.copied()?,
            fixed: memory::twin(&self.fixed)?,
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let settings = &self.functional.settings;
        let solution: Solution = match self.functional.solver {
            Solver::Auto | Solver::Fast => self.solver.solve(&problem, settings, self.progress)?,
            solver => solve(&problem, solver, settings, self.progress)?,
        };
        if solution.status == Status::Stopped {
            self.reached.status = Status::Stopped;
        }
        self.reached.values = solution.values;
        Ok(solution.objective)
    }

    fn report(&self, fraction: f64, stage: &str, iteration: usize, energy: Option<f64>) {
        self.progress.report(Report { fraction, stage: stage.into(), iteration, energy, gap: None });
    }
}
