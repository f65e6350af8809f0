//! The flow on one mesh, from a shape on the way to its end.

use super::movement::{root_mean_square, weighted_distance};
use super::options::{FlowStatus, StylizeOptions, Stylized};
use super::pace::{Pace, Plan};
use super::Flatness;
use crate::block_rows::BlockRows;
use crate::error::MeshError;
use crate::intrinsic::delaunay_flips_carrying;
use crate::linear::Columns;
use crate::mesh::vector::Point;
use crate::mesh::{rows_of_lengths, triangle, Connectivity, Mesh};
use crate::operators::{mollify, voronoi_mass, HessianPattern};
use crate::progress::{Progress, Report};
use crate::solve::{solve, Problem, Session, Settings, Solution, Solver, Status};
use crate::tools::answer::Surroundings;
use crate::tools::scale::{extent, Scale};
use crate::tools::sharpness::{block_norms, sharpened_weights};
use crate::{memory, Error, Result};

/// A step that moves the vertices by less than this part of the shape's size (root mean square) moves
/// nothing.
const STILL: f64 = 1e-7;

/// A shape has collapsed when its size has fallen below this part of what it was,
/// or its area below the tenth of that.
const COLLAPSED: f64 = 1e-2;

/// What a flow leaves to the one of a finer mesh.
pub(super) struct Legacy {
    /// The steps that count as done.
    pub done: usize,
    /// From where it goes on.
    pub points: Vec<Point>,
    pub plan: Plan,
    /// By how much curvature has changed the weight of each face at its end, if that is known.
    pub sharpening: Option<Vec<f64>>,
}

/// What is made of a flow's points to show them.
pub(super) type Show<'a> = &'a dyn Fn(&[Point]) -> Result<Vec<Point>>;

/// The flow of one mesh.
pub(super) struct Flow<'a> {
    options: &'a StylizeOptions,
    show: Show<'a>,
    /// Whether every step is shown, or the last one alone.
    shows_steps: bool,
    /// The part of the whole that this flow is, for its reports.
    part: [f64; 2],
    /// Whether a finer mesh goes on from its end.
    goes_on: bool,
    done: usize,
    /// How the steps ended, however exact they were.
    end: FlowStatus,
    /// By how much curvature changes the weight of each face in the next step, where it is not its own that
    /// does.
    sharpening: Option<Vec<f64>>,
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
    /// The flow of `mesh` from its beginning, with its fidelity measured in `scale`. It shows its points by
    /// `show`.
    pub(super) fn new(
        mesh: &'a Mesh,
        options: &'a StylizeOptions,
        scale: Scale,
        show: Show<'a>,
    ) -> Result<Self> {
        let connectivity = mesh.connectivity();
        let start = mesh.positions().ok_or(MeshError::NoPositions)?;
        let base = match &options.ridge_weights {
            Some(weights) => memory::twin(weights)?,
            None => memory::repeated(1.0, connectivity.n_faces())?,
        };
        let (size, area) = extent(connectivity, start);
        if size <= 0.0 {
            return Err(MeshError::NoFaces.into());
        }
        let corners = connectivity.faces().iter().flatten();
        let flatness = Flatness::of(connectivity, start)?;
        Ok(Self {
            options,
            show,
            shows_steps: true,
            part: [0.0, 1.0],
            goes_on: false,
            done: 0,
            end: FlowStatus::Finished,
            sharpening: None,
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
                iterations: 0,
                energy: Vec::new(),
                fidelities: Vec::new(),
                gap: Vec::new(),
                solver_iterations: Vec::new(),
                level_vertices: Vec::new(),
                factorisations: 0,
                flatness: [flatness; 2],
                status: FlowStatus::Finished,
            },
        })
    }

    /// Whether there is nothing to do.
    pub(super) fn is_flat(&self) -> bool {
        self.pace.is_flat(&self.result.flatness[0])
    }

    /// The energy of the shape as it is now.
    pub(super) fn energy(&mut self) -> Result<f64> {
        Ok(self.prepare()?.energy())
    }

    /// Goes on from the place that was reached elsewhere.
    pub(super) fn resume(&mut self, Legacy { done, points, plan, sharpening }: Legacy) -> Result<()> {
        (self.done, self.points) = (done, points);
        self.pace.follow(plan, self.done);
        self.sharpening = sharpening;
        (self.result.iterations, self.result.vertices) = (self.done, self.points.clone());
        self.result.flatness[1] = Flatness::of(self.connectivity, &self.points)?;
        Ok(())
    }

    /// As one part of a longer run, from one fraction of it to another.
    pub(super) fn within(mut self, part: [f64; 2]) -> Self {
        self.part = part;
        self
    }

    /// As one that a finer mesh goes on from.
    pub(super) fn going_on(mut self) -> Self {
        self.goes_on = true;
        self
    }

    /// Shows its end, and none of the steps before.
    pub(super) fn showing_its_end(mut self) -> Self {
        self.shows_steps = false;
        self
    }

    /// What a finer level, with `by` times as many vertices, goes on from, by `count` short steps.
    pub(super) fn legacy(&self, count: usize, by: f64) -> Legacy {
        let plan = self.pace.plan(self.end);
        let done = plan.n_steps().saturating_sub(count);
        let plan = plan.ending_shortly(count, by);
        Legacy { done, points: self.points.clone(), plan, sharpening: self.sharpening.clone() }
    }

    /// The steps that are left, or until an end.
    pub(super) fn run(&mut self, settings: &Settings, progress: &Progress) -> Result<()> {
        use FlowStatus::{Collapsed, Converged, Diverged, Inaccurate, Settled, Stopped};
        let n_steps = self.options.iterations;
        let mut step = self.prepare()?;
        self.result.energy.push(step.energy());
        if self.done == 0 && self.is_flat() {
            self.result.status = Settled;
            return Ok(());
        }
        let weights = self.free_areas(&step)?;
        let mut inaccurate = false;
        while self.done < n_steps {
            progress.check()?;
            if progress.is_finishing() {
                self.result.status = Stopped;
                break;
            }
            // Nothing is taken of a step that is not done.
            let solution = match self.solve(&step, settings, &progress.hasty()) {
                Err(Error::Cancelled) if !progress.is_cancelled() => {
                    self.result.status = Stopped;
                    break;
                }
                solution => solution?,
            };
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
            self.done += 1;
            step = self.prepare()?;
            progress.check()?;
            self.note(&step, &solution);
            inaccurate |= solution.status == Status::Inaccurate;
            if self.shows_steps {
                progress.set_snapshot(self.done, &(self.show)(&self.points)?);
            }
            progress.check()?;
            let flatness = Flatness::of(self.connectivity, &self.points)?;
            self.result.flatness[1] = flatness;
            let moved = weighted_distance(self.start, &self.points, &weights) / self.area.sqrt();
            let end = self.pace.after(moved, &flatness);
            progress.report(self.report(end.is_some(), &solution));
            if movement < STILL * self.size {
                self.result.status = Converged;
                break;
            }
            if let Some(end) = end {
                self.result.status = end;
                break;
            }
        }
        if !self.shows_steps && self.done > 0 {
            progress.set_snapshot(self.done, &(self.show)(&self.points)?);
        }
        self.end = self.result.status;
        if self.goes_on && !self.options.delaunay {
            let weights = self.weights(&step)?;
            let factor = |(w, base): (&f64, &f64)| if *base > 0.0 { w / base } else { 1.0 };
            self.sharpening = Some(memory::gathered(weights.iter().zip(&step.base).map(factor))?);
        }
        if inaccurate && !matches!(self.result.status, Collapsed | Diverged | Stopped) {
            self.result.status = Inaccurate;
        }
        Ok(())
    }

    /// What has come out.
    pub(super) fn into_result(self) -> Stylized {
        self.result
    }

    /// Takes down what a step did.
    fn note(&mut self, step: &Step, solution: &Solution) {
        self.result.vertices.copy_from_slice(&self.points);
        self.result.iterations = self.done;
        self.result.energy.push(step.energy());
        self.result.fidelities.push(self.pace.factor() * self.options.fidelity);
        self.result.gap.push(solution.gap);
        self.result.solver_iterations.push(solution.iterations);
        self.result.level_vertices.push(self.points.len());
        self.result.factorisations += solution.factorisations;
    }

    fn report(&mut self, is_end: bool, solution: &Solution) -> Report {
        let done = if is_end { 1.0 } else { self.pace.fraction(self.done, self.options.iterations) };
        Report {
            fraction: self.part[0] + done * (self.part[1] - self.part[0]),
            stage: "stylizing".into(),
            iteration: self.done,
            energy: self.result.energy.last().copied(),
            gap: Some(solution.gap),
        }
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
        let is_fixed = |i: usize| self.options.holds(i) || step.mass[i] <= 0.0;
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
                delaunay_flips_carrying(self.connectivity, &lengths, &mut base)?;
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

    /// The weights of the faces: by their own curvature, and in the first step on a finer level by that
    /// which the coarser one has ended with as well.
    ///
    /// The coarser level knows ridges from noise, but not on which of the finer faces they are; the finer
    /// one has them to the face, under noise. Their geometric mean is low where both say so: with the finer
    /// one's alone facets of a noisy skull melt (0.39 of it flat, 0.66 by all steps on the mesh itself, 0.72
    /// with the mean), with the coarser one's alone the ridges of a noisy cube are chamfered (0.0022 off;
    /// 0.0014; 0.0017).
    fn weights(&mut self, step: &Step) -> Result<Vec<f64>> {
        let mut weights = sharpened_weights(&step.norms, &step.areas, &step.base, self.options.sharpness)?;
        if let Some(factors) = self.sharpening.take() {
            let given = step.base.iter().zip(factors).map(|(base, factor)| base * factor);
            weights.iter_mut().zip(given).for_each(|(own, given)| *own = (*own * given).sqrt());
        }
        Ok(weights)
    }

    fn solve(&mut self, step: &Step, settings: &Settings, progress: &Progress) -> Result<Solution> {
        // In units of `unit` the step is `E + η‖·‖²_M`; in the mesh's own units that is `η / unit³`.
        let fidelity = self.pace.factor() * self.options.fidelity / step.unit.powi(3);
        let strength = self.options.strength.as_ref();
        let n = self.points.len();
        let fixed = self.fixed(step)?;
        let weights = self.weights(step)?;
        let pull = |i: usize| fidelity * step.mass[i] / strength.map_or(1.0, |s| s[i]);
        let problem = Problem {
            operator: &step.operator,
            weights,
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
