//! The flow toward piecewise flat shapes (Rowe et al. 2024, eq. (24)), with sharpness.

mod flatness;
mod options;
mod pace;

pub use flatness::Flatness;
use options::check;
pub use options::{FlowStatus, StylizeOptions, Stylized};
use pace::Pace;

use super::answer::Surroundings;
use super::scale::{extent, Scale};
use super::sharpness::{block_norms, sharpened_weights};
use crate::block_rows::BlockRows;
use crate::error::MeshError;
use crate::intrinsic::delaunay_flips_carrying;
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::{rows_of_lengths, triangle, Connectivity, Mesh, Working};
use crate::operators::{mollify, voronoi_mass, HessianPattern};
use crate::progress::{Progress, Report};
use crate::solve::{solve, Coupling, Problem, Session, Settings, Solution, Solver, Status};
use crate::unit::Unit;
use crate::{memory, Result};

/// A step that moves the vertices by less than this part of the shape's size (root mean square) moves
/// nothing.
const STILL: f64 = 1e-7;

/// A shape has collapsed when its size has fallen below this part of what it was,
/// or its area below the tenth of that.
const COLLAPSED: f64 = 1e-2;

/// Moves the vertices of `mesh` toward piecewise flat patches with crisp ridges.
///
/// Each step minimizes `Σ_f w_f A_f ‖H_f x‖ + η ‖x − x⁽ⁱ⁾‖²_M` over the coordinates `x`, with operator and
/// mass of the mesh as it is then. Rowe et al. 2024, eq. (24); the weights are those of
/// [`sharpened_weights`], the sizes of the steps those of [`Pace`].
///
/// Faces are oriented and seams joined first ([`Working`]): the sides of a seam stay together.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`], arguments of the wrong shape or range, and the errors
/// of the solver. Never a result that is not finite.
pub fn stylize(mesh: &Mesh, options: &StylizeOptions, progress: &Progress) -> Result<Stylized> {
    let original = mesh.positions().ok_or(MeshError::NoPositions)?;
    check(mesh, options)?;
    let unit = mesh.unit();
    let measured = mesh.measured(unit)?;
    let start = measured.positions().ok_or(MeshError::NoPositions)?;
    let progress = progress.in_unit(unit);
    let working = Working::new(&measured)?;
    let mut result = if working.is_plain() {
        flow(&measured, unit, options, None, &progress)?
    } else {
        let options = StylizeOptions {
            fixed: options.fixed.as_ref().map(|fixed| working.any_of(fixed)),
            strength: options.strength.as_ref().map(|strength| working.least_of(strength)),
            ..options.clone()
        };
        let flowed = flow(working.mesh(), unit, &options, Some(&working), &progress)?;
        Stylized { vertices: working.positions(&flowed.vertices), ..flowed }
    };
    unit.restore_points(&mut result.vertices, start, original);
    for energy in &mut result.energy {
        *energy = unit.restore_finite("the energy", *energy)?;
    }
    Ok(result)
}

/// The flow of a mesh as it is, measured in `unit`; snapshots are given back by `working`.
pub(super) fn flow(
    mesh: &Mesh,
    unit: Unit,
    options: &StylizeOptions,
    working: Option<&Working<'_>>,
    progress: &Progress,
) -> Result<Stylized> {
    let start = mesh.positions().ok_or(MeshError::NoPositions)?;
    let settings = Settings { announce: false, ..options.solve.settings()? };
    let n_columns = if options.coupling == Coupling::Joint { 3 } else { 1 };
    options.solve.run(|| {
        mesh.demand(Tool::Stylize)
            .with_columns(n_columns, options.solve.solver.is_clarabel())
            .admit(options.solve.memory_limit)?;
        Flow::new(mesh, start, unit, options, working)?.run(&settings, progress)
    })
}

struct Flow<'a> {
    options: &'a StylizeOptions,
    working: Option<&'a Working<'a>>,
    connectivity: &'a Connectivity,
    scale: Scale,
    around: Surroundings,
    points: Vec<[f64; 3]>,
    base: Vec<f64>,
    pattern: HessianPattern,
    solver: Session,
    size: f64,
    area: f64,
    start: &'a [[f64; 3]],
    pace: Pace,
    result: Stylized,
}

/// One step's operator and what it was made from.
struct Step {
    operator: BlockRows,
    areas: Vec<f64>,
    /// The ridge weights of its faces, which may be flipped ones.
    base: Vec<f64>,
    mass: Vec<f64>,
    norms: Vec<f64>,
    unit: f64,
}

impl<'a> Flow<'a> {
    /// The flow of `mesh`, measured in `unit`, from `start`.
    fn new(
        mesh: &'a Mesh,
        start: &'a [[f64; 3]],
        unit: Unit,
        options: &'a StylizeOptions,
        working: Option<&'a Working<'a>>,
    ) -> Result<Self> {
        let connectivity = mesh.connectivity();
        let base = match &options.ridge_weights {
            Some(weights) => memory::twin(weights)?,
            None => memory::repeated(1.0, connectivity.n_faces())?,
        };
        let (size, area) = extent(connectivity, start);
        if size <= 0.0 {
            return Err(MeshError::NoFaces.into());
        }
        let corners = connectivity.faces().iter().flatten();
        let scale = match options.scale {
            Scale::Length(length) => Scale::Length(unit.measure(length)),
            relative => relative,
        };
        let flatness = Flatness::of(connectivity, start)?;
        Ok(Self {
            options,
            working,
            connectivity,
            scale,
            around: Surroundings::of(corners.map(|&v| &start[v as usize])),
            points: memory::twin(start)?,
            base,
            pattern: HessianPattern::new(connectivity)?,
            solver: Session::new(),
            size,
            area,
            start,
            pace: Pace::new(options.movement, options.flat_share, &flatness),
            result: Stylized {
                vertices: memory::twin(start)?,
                energy: Vec::new(),
                gap: Vec::new(),
                solver_iterations: Vec::new(),
                factorisations: 0,
                flatness: [flatness; 2],
                status: FlowStatus::Finished,
            },
        })
    }

    fn run(mut self, settings: &Settings, progress: &Progress) -> Result<Stylized> {
        let n_steps = self.options.iterations;
        let mut step = self.prepare()?;
        self.result.energy.push(step.energy());
        if self.pace.is_flat(&self.result.flatness[0]) {
            self.result.status = FlowStatus::Settled;
            return Ok(self.result);
        }
        let weights = self.free_areas(&step)?;
        let mut inaccurate = false;
        for done in 0..n_steps {
            progress.check()?;
            if progress.is_finishing() {
                self.result.status = Stopped;
                break;
            }
            let solution = self.solve(&step, settings, progress)?;
            if progress.is_finishing() && solution.status == Status::Stopped {
                self.result.status = Stopped;
                break;
            }
            let moved = solution.values.to_points()?;
            if !self.is_near(&moved) || !solution.gap.is_finite() {
                self.result.status = Diverged;
                break;
            }
            if self.has_collapsed(&moved) {
                self.result.status = Collapsed;
                break;
            }
            let movement = root_mean_square(&self.points, &moved);
            self.points = moved;
            step = self.prepare()?;
            self.result.vertices.copy_from_slice(&self.points);
            self.result.energy.push(step.energy());
            self.result.gap.push(solution.gap);
            self.result.solver_iterations.push(solution.iterations);
            self.result.factorisations += solution.factorisations;
            inaccurate |= solution.status == Status::Inaccurate;
            match self.working {
                Some(working) => progress.set_snapshot(&working.positions(&self.points)),
                None => progress.set_snapshot(&self.points),
            }
            let flatness = Flatness::of(self.connectivity, &self.points)?;
            self.result.flatness[1] = flatness;
            let moved = weighted_distance(self.start, &self.points, &weights) / self.area.sqrt();
            let end = self.pace.after(moved, &flatness);
            progress.report(Report {
                fraction: if end.is_some() { 1.0 } else { self.pace.fraction(done + 1, n_steps) },
                stage: "stylizing".into(),
                iteration: done + 1,
                energy: self.result.energy.last().copied(),
                gap: Some(solution.gap),
            });
            if movement < STILL * self.size {
                self.result.status = FlowStatus::Converged;
                break;
            }
            if let Some(end) = end {
                self.result.status = end;
                break;
            }
        }
        use FlowStatus::{Collapsed, Diverged, Inaccurate, Stopped};
        if inaccurate && !matches!(self.result.status, Collapsed | Diverged | Stopped) {
            self.result.status = Inaccurate;
        }
        Ok(self.result)
    }

    fn is_near(&self, moved: &[[f64; 3]]) -> bool {
        self.around.hold(self.connectivity.faces().iter().flatten().map(|&v| &moved[v as usize]))
    }

    /// What each vertex counts when the movement is measured: its area, nothing where it is held.
    fn free_areas(&self, step: &Step) -> Result<Vec<f64>> {
        let fixed = self.fixed(step)?;
        let free = step.mass.iter().zip(fixed).map(|(mass, fixed)| if fixed { 0.0 } else { *mass });
        Ok(memory::gathered(free)?)
    }

    /// Which vertices do not move.
    fn fixed(&self, step: &Step) -> Result<Vec<bool>> {
        let is_fixed = |i: usize| {
            self.options.fixed.as_ref().is_some_and(|f| f[i])
                || self.options.strength.as_ref().is_some_and(|s| s[i] <= 0.0)
                || step.mass[i] <= 0.0
        };
        Ok(memory::gathered((0..self.points.len()).map(is_fixed))?)
    }

    fn has_collapsed(&self, moved: &[[f64; 3]]) -> bool {
        let (size, area) = extent(self.connectivity, moved);
        !(size >= COLLAPSED * self.size && area >= 0.1 * COLLAPSED * self.area)
    }

    /// Operator, mass and unit of the shape as it is now.
    fn prepare(&mut self) -> Result<Step> {
        let mut lengths: Vec<[f64; 3]> =
            memory::gathered(rows_of_lengths(self.connectivity.faces(), &self.points))?;
        let unit = self.scale.unit(self.connectivity, &self.points, &lengths);
        let flipped;
        let mut base = memory::twin(&self.base)?;
        let (connectivity, pattern) = if self.options.delaunay {
            mollify(self.connectivity, &mut lengths);
            let (connectivity, flipped_lengths, _) =
                delaunay_flips_carrying(self.connectivity, &lengths, &mut base);
            lengths = flipped_lengths;
            let pattern = HessianPattern::new(&connectivity)?;
            flipped = (connectivity, pattern);
            (&flipped.0, &flipped.1)
        } else {
            (self.connectivity, &self.pattern)
        };
        mollify(connectivity, &mut lengths);
        let operator = pattern.assemble(connectivity, &lengths, self.options.dual)?;
        let areas = memory::gathered(lengths.iter().map(|&l| triangle::area(l)))?;
        let mass = voronoi_mass(connectivity, &lengths)?;
        let norms = block_norms(&operator, &Columns::from_points(&self.points)?, self.options.coupling)?;
        Ok(Step { operator, areas, base, mass, norms, unit })
    }

    fn solve(&mut self, step: &Step, settings: &Settings, progress: &Progress) -> Result<Solution> {
        // In units of `unit` the step is `E + η‖·‖²_M`; in the mesh's own units that is `η / unit³`.
        let fidelity = self.pace.factor() * self.options.fidelity / step.unit.powi(3);
        let strength = self.options.strength.as_ref();
        let n = self.points.len();
        let fixed = self.fixed(step)?;
        let pull = |i: usize| fidelity * step.mass[i] / strength.map_or(1.0, |s| s[i]);
        let problem = Problem {
            operator: &step.operator,
            weights: sharpened_weights(&step.norms, &step.areas, &step.base, self.options.sharpness)?,
            fidelity: memory::gathered((0..n).map(|i| if fixed[i] { 0.0 } else { pull(i) }))?,
            target: Columns::from_points(&self.points)?,
            fixed,
            linear_constraints: None,
            coupling: self.options.coupling,
        };
        match self.options.solve.solver {
            Solver::Auto | Solver::Fast => self.solver.solve(&problem, settings, progress),
            solver => solve(&problem, solver, settings, progress),
        }
    }
}

impl Step {
    fn energy(&self) -> f64 {
        self.norms.iter().sum()
    }
}

/// Root mean square distance of two point lists, with a weight for each point.
fn weighted_distance(a: &[[f64; 3]], b: &[[f64; 3]], weights: &[f64]) -> f64 {
    let square =
        |(p, q): (&[f64; 3], &[f64; 3])| p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
    let sum: f64 = a.iter().zip(b).map(square).zip(weights).map(|(d, w)| w * d).sum();
    let total: f64 = weights.iter().sum();
    if total > 0.0 {
        (sum / total).sqrt()
    } else {
        0.0
    }
}

/// Root mean square distance of two point lists.
fn root_mean_square(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let sum: f64 = a.iter().zip(b).flat_map(|(p, q)| p.iter().zip(q)).map(|(x, y)| (x - y) * (x - y)).sum();
    (sum / a.len().max(1) as f64).sqrt()
}
