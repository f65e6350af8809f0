//! The alternating minimization of the Ambrosio-Tortorelli functional with the L1 Hessian (Rowe et al. 2024,
//! eq. (41)).

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::constants::{NOISE_POWER, NOISE_SEARCH};
use super::indicator_step::IndicatorStep;
use super::piece::{Piece, Solving};
use super::surface::Surface;
use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::operators::{face_laplacian_weights, voronoi_mass, Dual, HessianPattern};
use crate::progress::{Progress, Report};
use crate::solve::pieces::{at, Pieces};
use crate::solve::{Coupling, Settings, Solver, Status};
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
    /// The mean squared change of `v` under which an alternation of a piece was the last for its `ε`.
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
    /// Alternations of the piece that takes most of them, all `ε` together.
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
        let mut run = Run {
            functional: self,
            pieces: self.pieces(progress)?,
            progress,
            reached: Minimizer {
                values: self.values.copied()?,
                indicator: memory::repeated(1.0, self.surface.n_faces())?,
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
        Ok(run.finished())
    }

    /// The connected pieces of the surface: minimizers of their own. What the Hessian sees nothing of, single
    /// triangles, has no borders and stays as it is.
    fn pieces(&self, progress: &Progress) -> Result<Vec<Piece>> {
        let surface = self.surface;
        let faces = surface.connectivity.faces();
        let operator = self.operator()?;
        let mass = voronoi_mass(surface.connectivity, &surface.lengths)?;
        let weights = face_laplacian_weights(surface.connectivity, &surface.lengths, &surface.centroids)?;
        let (length_weight, costs) = (self.length_weight, self.face_costs);
        let step = |faces| IndicatorStep::new(surface, faces, &weights, length_weight, costs, progress);
        let Some(pieces) = Pieces::of(&operator, Some(faces))? else {
            let (rows, faces) = (memory::numbers(mass.len())?, memory::numbers(faces.len())?);
            let step = step([&faces, &faces])?;
            let areas = memory::twin(&surface.areas)?;
            let piece = Piece::new([rows, faces], operator, mass, areas, self.values.copied()?, step)?;
            return Ok(vec![piece]);
        };
        let piece = |p: usize| {
            let (rows, faces) = (pieces.rows(p), pieces.blocks(p));
            Piece::new(
                [memory::twin(rows)?, memory::twin(faces)?],
                pieces.operator(&operator, p)?,
                at(&mass, rows)?,
                at(&surface.areas, faces)?,
                pieces.columns(self.values, p)?,
                step([faces, pieces.places_of_blocks()])?,
            )
        };
        memory::all((0..pieces.count()).map(piece).collect())
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
        let weights = face_laplacian_weights(surface.connectivity, &surface.lengths, &surface.centroids)?;
        let faces = memory::numbers(surface.n_faces())?;
        let (costs, faces) = (self.face_costs, [&faces[..], &faces]);
        let mut step = IndicatorStep::new(surface, faces, &weights, self.length_weight, costs, progress)?;
        if let Some(epsilon) = self.epsilons.last() {
            step.prepare(*epsilon);
        }
        Ok(Minimizer {
            values: self.values.copied()?,
            indicator: step.minimize(&block_norms(&operator, self.values, Coupling::Joint)?, progress)?,
            fidelity: self.fidelity,
            alternations: 1,
            status: Status::Solved,
        })
    }
}

struct Run<'a> {
    functional: &'a Functional<'a>,
    pieces: Vec<Piece>,
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
            self.on_each(|piece, solving| piece.update_values(solving).map(drop))?;
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
        let sum: f64 = self.pieces.iter().map(Piece::squared_residual).sum();
        let total: f64 = self.pieces.iter().map(|piece| piece.total).sum();
        (sum / total.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Both minimizations in turns for one `ε`, on each piece until its own end.
    fn alternate(&mut self, level: usize, epsilon: f64) -> Result<()> {
        let levels = self.functional.epsilons.len() as f64;
        let (n_pieces, ended) = (self.pieces.len(), AtomicUsize::new(0));
        let progress = self.progress;
        let inner_tolerance = self.functional.inner_tolerance;
        let report = |inner: f64, iteration: usize, energy: Option<f64>| {
            let fraction = 0.1 + 0.8 * (level as f64 + inner) / levels;
            progress.report(Report { fraction, stage: "borders".into(), iteration, energy, gap: None });
        };
        self.on_each(|piece, solving| {
            let each = |inner: f64, alternations: usize, energy: f64| {
                if n_pieces == 1 {
                    report(inner, alternations, Some(energy));
                }
            };
            piece.alternate(epsilon, inner_tolerance, solving, each)?;
            if n_pieces > 1 {
                let ended = ended.fetch_add(1, Ordering::Relaxed) + 1;
                report(ended as f64 / n_pieces as f64, piece.alternations, None);
            }
            Ok(())
        })
    }

    /// Does this with every piece.
    fn on_each(&mut self, act: impl Fn(&mut Piece, &Solving<'_>) -> Result<()> + Sync) -> Result<()> {
        let solving = Solving {
            fidelity: self.reached.fidelity,
            solver: self.functional.solver,
            settings: &self.functional.settings,
            progress: self.progress,
        };
        let ends: Vec<Result<()>> =
            memory::joined(self.pieces.par_iter_mut().map(|piece| act(piece, &solving)))?;
        ends.into_iter().collect::<Result<()>>()?;
        if self.pieces.iter().any(|piece| piece.is_stopped) {
            self.reached.status = Status::Stopped;
        }
        Ok(())
    }

    /// What all pieces have reached.
    fn finished(self) -> Minimizer {
        let mut reached = self.reached;
        for piece in self.pieces {
            for c in 0..reached.values.n_columns {
                let column = reached.values.column_mut(c);
                let own = piece.rows.iter().zip(piece.values.column(c));
                own.for_each(|(&row, x)| column[row as usize] = *x);
            }
            let own = piece.faces.iter().zip(&piece.indicator);
            own.for_each(|(&face, v)| reached.indicator[face as usize] = *v);
            reached.alternations = reached.alternations.max(piece.alternations);
        }
        reached
    }

    fn report(&self, fraction: f64, stage: &str, iteration: usize, energy: Option<f64>) {
        self.progress.report(Report { fraction, stage: stage.into(), iteration, energy, gap: None });
    }
}
