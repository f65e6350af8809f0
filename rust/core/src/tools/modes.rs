//! Vibration modes: orthonormal functions of least energy, one after the other (Rowe et al. 2024, eq. (38)).

use sprs::CsMat;

use super::unseen::{extend, unseen};
use super::{EnergyOptions, SolveOptions};
use crate::linear::small::symmetric_eigen;
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::{triangle, Mesh};
use crate::operators::{cotangent_laplacian, voronoi_mass, Energy, EnergyForm};
use crate::progress::{Progress, Report};
use crate::solve::eigen::{mass_dot, Eigenpairs, Pencil};
use crate::solve::{solve, Coupling, Problem, Session, Settings, Solution, Solver, Status};
use crate::{memory, Error, Result};

/// Eigenvalues below this part of the largest one computed belong to the kernel of an energy: those of the
/// kernel come out at 1e-16 and less, the first of the others at 1e-3 and more.
const KERNEL: f64 = 1e-9;

/// How exact eigenvectors are: see [`Pencil::accuracy`].
const ACCURACY: f64 = 1e-8;

/// Alternations of a mode at most; they take 3 to 12.
const MOST_ALTERNATIONS: usize = 60;

/// How to compute modes.
#[derive(Debug, Clone, Default)]
pub struct ModeOptions {
    /// The energy.
    pub energy: EnergyOptions,
    /// The solver of the L1 problems; a mode is done when its energy falls by less than the tolerance, or
    /// 1e-4 where there is none.
    pub solve: SolveOptions,
}

/// Modes and how they were left.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// One mode a column, orthonormal with respect to the Voronoi mass (of the flipped mesh, where edges
    /// were), with ascending energies. The entry of largest magnitude (the first of those that are equal to
    /// 1e-6) is positive. Vertices without mass have 0.
    pub values: Columns,
    /// The energy of each mode; infinite, on its side of 0, where it is past the largest number.
    /// [`Energy::L2CurvedHessian`] can be below 0, by little: -0.0003 was seen on a sheet with noise.
    pub energies: Vec<f64>,
    /// `Solved`, `Inaccurate` where a problem in between missed its tolerance,
    /// or `Stopped` with fewer modes than asked for.
    pub status: Status,
}

/// The `count` lowest vibration modes of a surface.
///
/// For a quadratic energy `½ uᵀ Q u` these are the first eigenvectors of `Q u = λ M u`. For an L1 energy `E`
/// they follow Rowe et al. 2024, eq. (38): `u ← argmin E(u) + ½ uᵀ L u / μ` over the `u` orthogonal to the
/// modes before with `⟨c, u⟩ = 1`, `c ← u / ‖u‖`, in turns until the energy stays, all with respect to the
/// mass. Taken in the limit of large `μ` (the paper has 10⁶) the Dirichlet energy `½ uᵀ L u` only orders
/// functions without energy: those, constants and on a plane affine functions, come first and exactly, by a
/// small eigenproblem of `L`. The other modes start from the eigenvectors of the sum of squared norms; each
/// is a local optimum, as in the paper.
///
/// # Errors
/// No modes or more than vertices with mass asked for, and the errors of [`super::interpolate`].
pub fn vibration_modes(
    mesh: &Mesh,
    count: usize,
    options: &ModeOptions,
    progress: &Progress,
) -> Result<Modes> {
    let settings = Settings { announce: false, ..options.solve.settings()? };
    options.energy.check_solver(options.solve.solver)?;
    let tool = if options.energy.kind.is_quadratic() { Tool::QuadraticModes } else { Tool::Modes };
    let n_columns = count.min(mesh.connectivity().n_vertices());
    mesh.demand(tool)
        .with_columns(n_columns, options.solve.solver.is_clarabel())
        .admit(options.solve.memory_limit)?;
    let length = mesh.unit();
    let measured = mesh.measured(length)?;
    let (mesh, form) = options.energy.on(&measured)?;
    let whole = voronoi_mass(mesh.connectivity(), mesh.edge_lengths())?;
    let unseen = unseen(&mesh, &form);
    // A vertex that costs no energy would be a mode of its own.
    let counts = |i: usize| !unseen.as_ref().is_some_and(|unseen| unseen[i]);
    let mass: Vec<f64> = whole.iter().enumerate().map(|(i, m)| if counts(i) { *m } else { 0.0 }).collect();
    let most = mass.iter().filter(|m| **m > 0.0).count();
    if count == 0 || count > most {
        return Err(Error::argument(
            "count",
            format!("is {count}; ask for 1 to {most} modes, one per vertex with mass"),
        ));
    }
    let sequence = Sequence { mesh: &mesh, form: &form, mass: &mass, options, settings, progress };
    options.solve.run(|| {
        let (mut modes, status) =
            if form.energy.is_quadratic() { sequence.quadratic(count) } else { sequence.l1(count) }?;
        if let Some(unseen) = &unseen {
            modes = sequence.extended(&modes, unseen, &whole)?;
        }
        let mut found = sequence.finished(&modes, status)?;
        // The square of a mode times an area is 1.
        let value = length.power(-1);
        for x in &mut found.values.data {
            *x = value.restore_finite("a mode", *x)?;
        }
        form.energy.unit(length, value).restore_all(&mut found.energies);
        Ok(found)
    })
}

struct Sequence<'a> {
    mesh: &'a Mesh,
    form: &'a EnergyForm,
    mass: &'a [f64],
    options: &'a ModeOptions,
    settings: Settings,
    progress: &'a Progress,
}

impl Sequence<'_> {
    fn quadratic(&self, count: usize) -> Result<(Vec<Vec<f64>>, Status)> {
        self.report(0, count, "modes", None);
        let found = self.pencil(&self.form.weights).smallest(count, self.progress)?;
        Ok(((0..count).map(|j| found.vectors.column(j).to_vec()).collect(), Status::Solved))
    }

    fn l1(&self, count: usize) -> Result<(Vec<Vec<f64>>, Status)> {
        self.report(0, count, "modes of the squares", None);
        let weights = self.weights_of_squares()?;
        let start = self.pencil(&weights).smallest(count, self.progress)?;
        let (mut modes, mut status) = (self.kernel(&start)?, Status::Solved);
        let mut solver = Session::new();
        while modes.len() < count {
            if self.progress.is_finishing() {
                status = Status::Stopped;
                break;
            }
            let (mode, inner) = self.next(start.vectors.column(modes.len()), &modes, count, &mut solver)?;
            modes.push(mode);
            status = status.worse(inner);
        }
        Ok((modes, status))
    }

    /// The weights with which the squared norms sum to the integral of a squared density: for the norms of
    /// faces, which carry the area, over the area.
    fn weights_of_squares(&self) -> Result<Vec<f64>> {
        if self.form.energy != Energy::L1Hessian {
            return Ok(memory::twin(&self.form.weights)?);
        }
        let areas = self.mesh.edge_lengths().iter().map(|&l| triangle::area(l));
        let over = |(w, area): (&f64, f64)| if area > 0.0 { w / area } else { 0.0 };
        Ok(memory::gathered(self.form.weights.iter().zip(areas).map(over))?)
    }

    fn pencil<'b>(&'b self, weights: &'b [f64]) -> Pencil<'b> {
        // Weyl's law: the n-th eigenvalue of the Laplacian of a surface is about 4πn over its area.
        let area: f64 = self.mass.iter().sum();
        let mut scale = (4.0 * std::f64::consts::PI / area).powi(2);
        if let Some(weights) = &self.options.energy.face_weights {
            scale *= (weights.iter().sum::<f64>() / weights.len() as f64).max(f64::MIN_POSITIVE);
        }
        Pencil {
            operator: &self.form.operator,
            weights,
            mass: self.mass,
            scale,
            accuracy: ACCURACY,
            memory_limit: self.settings.memory_limit,
        }
    }

    /// The functions without energy among the eigenvectors `found`, ordered by their Dirichlet energy.
    fn kernel(&self, found: &Eigenpairs) -> Result<Vec<Vec<f64>>> {
        let largest = found.values.last().copied().unwrap_or(0.0).max(self.pencil(&[]).scale);
        let within = found.values.iter().take_while(|value| **value <= KERNEL * largest).count();
        let basis: Vec<&[f64]> = (0..within).map(|j| found.vectors.column(j)).collect();
        let laplacian = cotangent_laplacian(self.mesh.connectivity(), self.mesh.edge_lengths())?;
        let times = |u: &[f64]| {
            let mut product = memory::room(u.len())?;
            let along =
                |row: sprs::CsVecView<'_, f64>| row.iter().map(|(j, value)| value * u[j]).sum::<f64>();
            product.extend(laplacian.outer_iterator().map(along));
            Ok(product)
        };
        let images: Vec<Vec<f64>> = basis.iter().map(|u| times(u)).collect::<Result<_>>()?;
        let inner = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let projected = images.iter().map(|y| basis.iter().map(|x| inner(x, y)).collect()).collect();
        let (_, rotation) = symmetric_eigen(projected);
        let combine = |coefficients: &Vec<f64>| {
            let mut sum = memory::repeated(0.0, self.mass.len())?;
            for (x, c) in basis.iter().zip(coefficients) {
                sum.iter_mut().zip(*x).for_each(|(s, x)| *s += c * x);
            }
            Ok(sum)
        };
        rotation.iter().map(combine).collect()
    }

    /// The mode after `modes`, by the alternation (38) from `start`.
    fn next(
        &self,
        start: &[f64],
        modes: &[Vec<f64>],
        count: usize,
        solver: &mut Session,
    ) -> Result<(Vec<f64>, Status)> {
        let enough = self.settings.tolerance.unwrap_or(1e-4);
        let mut direction = orthonormal(self.mass, memory::twin(start)?, modes);
        let mut energy = self.form.evaluate(&direction)?;
        let mut status = Status::Solved;
        solver.forget();
        for _ in 0..MOST_ALTERNATIONS {
            self.report(modes.len(), count, "modes", Some(energy));
            let solution = self.alternate(&direction, modes, solver)?;
            status = solution.status;
            let moved = orthonormal(self.mass, memory::twin(solution.values.column(0))?, modes);
            let lower = self.form.evaluate(&moved)?;
            if lower < energy {
                direction = moved;
            }
            let fall = energy - lower;
            energy = energy.min(lower);
            if fall <= enough * energy || status == Status::Stopped {
                break;
            }
        }
        Ok((direction, status))
    }

    /// The first line of (38): the least energy among functions orthogonal to `modes` whose product with
    /// `direction` is 1.
    fn alternate(&self, direction: &[f64], modes: &[Vec<f64>], solver: &mut Session) -> Result<Solution> {
        let n = self.mass.len();
        let mut right = vec![0.0; modes.len()];
        right.push(1.0);
        let problem = Problem {
            operator: &self.form.operator,
            weights: memory::twin(&self.form.weights)?,
            fidelity: memory::repeated(0.0, n)?,
            target: Columns::from_column(memory::twin(direction)?),
            fixed: memory::gathered(self.mass.iter().map(|m| *m == 0.0))?,
            linear_constraints: Some((self.products(modes, direction)?, Columns::from_column(right))),
            coupling: Coupling::Joint,
        };
        match self.options.solve.solver {
            Solver::Auto | Solver::Fast => solver.solve(&problem, &self.settings, self.progress),
            other => solve(&problem, other, &self.settings, self.progress),
        }
    }

    /// The rows `uᵀ M` for every one of `modes`, then for `direction`.
    fn products(&self, modes: &[Vec<f64>], direction: &[f64]) -> Result<CsMat<f64>> {
        let n_rows = modes.len() + 1;
        let n_entries = n_rows * self.mass.iter().filter(|m| **m > 0.0).count();
        let (mut starts, mut columns) = (memory::room(n_rows + 1)?, memory::room(n_entries)?);
        let mut values = memory::room(n_entries)?;
        starts.push(0);
        for u in modes.iter().map(Vec::as_slice).chain([direction]) {
            for (i, (m, x)) in self.mass.iter().zip(u).enumerate().filter(|(_, (m, _))| **m > 0.0) {
                columns.push(i);
                values.push(m * x);
            }
            starts.push(columns.len());
        }
        Ok(CsMat::new((n_rows, self.mass.len()), starts, columns, values))
    }

    /// The modes with linearly extrapolated values at the `unseen` vertices,
    /// orthonormal with respect to the `whole` mass.
    fn extended(&self, modes: &[Vec<f64>], unseen: &[bool], whole: &[f64]) -> Result<Vec<Vec<f64>>> {
        let mut values = Columns { n_rows: whole.len(), n_columns: modes.len(), data: modes.concat() };
        extend(self.mesh, unseen, &mut values, self.progress)?;
        let mut extended: Vec<Vec<f64>> = Vec::new();
        for c in 0..modes.len() {
            let mode = orthonormal(whole, values.column(c).to_vec(), &extended);
            extended.push(mode);
        }
        Ok(extended)
    }

    fn finished(&self, modes: &[Vec<f64>], status: Status) -> Result<Modes> {
        let energies: Vec<f64> = modes.iter().map(|u| self.form.evaluate(u)).collect::<Result<_>>()?;
        let mut order: Vec<usize> = (0..modes.len()).collect();
        order.sort_by(|&a, &b| energies[a].total_cmp(&energies[b]));
        let mut values = Columns::try_zeros(self.mass.len(), modes.len())?;
        for (c, &j) in order.iter().enumerate() {
            let largest = modes[j].iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            let first = modes[j].iter().find(|x| x.abs() >= (1.0 - 1e-6) * largest);
            let sign = first.map_or(1.0, |x| x.signum());
            values.column_mut(c).iter_mut().zip(&modes[j]).for_each(|(out, x)| *out = sign * x);
        }
        Ok(Modes { values, energies: order.iter().map(|&j| energies[j]).collect(), status })
    }

    fn report(&self, done: usize, count: usize, stage: &str, energy: Option<f64>) {
        let fraction = done as f64 / count as f64;
        self.progress.report(Report { fraction, stage: stage.into(), iteration: done, energy, gap: None });
    }
}

/// `u` less its part along the orthonormal `modes`, of length 1; twice, since the first time leaves rounding.
fn orthonormal(mass: &[f64], mut u: Vec<f64>, modes: &[Vec<f64>]) -> Vec<f64> {
    for _ in 0..2 {
        for mode in modes {
            let along = mass_dot(mass, &u, mode);
            u.iter_mut().zip(mode).for_each(|(x, y)| *x -= along * y);
        }
        let length = mass_dot(mass, &u, &u).sqrt().max(f64::MIN_POSITIVE);
        u.iter_mut().for_each(|x| *x /= length);
    }
    u
}
