//! Restoring: a noisy part put onto the planes, spheres, cylinders, cones and tori that it was made of.
//!
//! Segments ([`mod@super::segment`]) are labeled with surfaces by one energy ([`crate::labelling`]), which
//! can be made parallel, orthogonal and equal ([`regularize`]); every vertex goes onto the surface of its
//! faces, the curve of two, the corner of three ([`place`]); what no surface explains is denoised by the flow
//! ([`free`]); then vertices move within surfaces and curves until no triangle is folded ([`relax`]).

mod constants;
mod free;
mod options;
mod place;
mod regularize;
mod relax;

pub use options::{RestoreOptions, RestoreStatus, Restored, RestoredSurface};

use crate::error::MeshError;
use crate::labelling::{labelling, Domain, Labelling, NONE};
use crate::memory::{self, Tool};
use crate::mesh::vector::{distance, Point};
use crate::mesh::{Mesh, Working, FILE_ROUNDING};
use crate::progress::{Progress, Report};
use crate::solve::Status;
use crate::tools::answer::{refused, Surroundings};
use crate::tools::scale::extent;
use crate::tools::segment::{segment, Fillets, SegmentOptions};
use crate::unit::Unit;
use crate::{Error, Result};
use constants::MOST_MOVE;
use place::Placement;

/// Moves the vertices of `mesh` onto the surfaces that its faces were sampled from. Connectivity stays.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`], arguments of the wrong shape or range,
/// [`crate::Error::Cancelled`], and the errors of the solver.
pub fn restore(mesh: &Mesh, options: &RestoreOptions, progress: &Progress) -> Result<Restored> {
    options.check(mesh)?;
    let original = mesh.positions().ok_or(MeshError::NoPositions)?;
    let unit = mesh.unit();
    let measured = mesh.measured(unit)?;
    let start = measured.positions().ok_or(MeshError::NoPositions)?;
    let working = Working::new(&measured)?;
    let mut found = options.solve.run(|| {
        measured.demand(Tool::Restore).admit(options.solve.memory_limit)?;
        on(&working, unit, options, progress)
    })?;
    found.vertices = working.positions(&found.vertices)?;
    unit.restore_points(&mut found.vertices, start, original);
    let origin = working.place([0.0; 3]);
    for piece in &mut found.surfaces {
        piece.surface =
            piece.surface.map(|surface| surface.placed(1.0, origin).placed(unit.restore(1.0), [0.0; 3]));
        piece.rms = unit.restore(piece.rms);
    }
    found.noise = unit.restore(found.noise);
    Ok(found)
}

/// Restores the working mesh; the result is in its coordinates.
fn on(working: &Working<'_>, unit: Unit, options: &RestoreOptions, progress: &Progress) -> Result<Restored> {
    let mesh = working.mesh();
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let (size, _) = extent(mesh.connectivity(), positions);
    // A mesh without area has no size, and a noise that is no number beside it is as large all the same.
    let is_as_large = |noise: f64| noise >= size && size > 0.0 || noise.is_infinite();
    if let Some(noise) = options.noise.filter(|&noise| is_as_large(unit.measure(noise))) {
        let problem = format!("is {noise:e}, as large as the mesh; pass the height of its bumps, or None");
        return Err(Error::argument("noise", problem));
    }
    let segments = segment(
        mesh,
        None,
        &SegmentOptions {
            faces: options.faces.as_deref().map(memory::twin).transpose()?,
            fillets: Fillets::Unseen,
            solve: options.segment_solve(),
            ..SegmentOptions::default()
        },
        progress,
    )?;
    say(progress, 0.5, "surfaces");
    let noise = options.noise.map_or(segments.noise, |noise| unit.measure(noise));
    // There is no less noise than rounding, and what is nearer to where it should be stays bit by bit.
    let rounding = FILE_ROUNDING * size;
    let domain = Domain::new(mesh.connectivity(), positions, noise.max(rounding))?;
    let mut state = labelling(&domain, &segments.labels, progress)?;
    let relations = match options.regularize {
        Some(degrees) => regularize::regularize(&domain, &mut state, degrees.to_radians())?,
        None => Vec::new(),
    };
    say(progress, 0.8, "vertices");
    let fixed = options.fixed.as_ref().map(|fixed| working.any_of(fixed)).transpose()?;
    let reach = options
        .max_move
        .map_or(MOST_MOVE[0] * domain.sigma + MOST_MOVE[1] * domain.mean_edge, |most| unit.measure(most));
    let mut placement = Placement::new(&domain, &state, fixed.as_deref(), reach)?;
    placement.place(&domain, &state, progress)?;
    let has_free = state.pieces.iter().any(|piece| piece.surface.is_none());
    let labels = state.labels.iter().map(|&l| if l == NONE { -1 } else { l.cast_signed() });
    let mut restored = Restored {
        vertices: Vec::new(),
        labels: memory::gathered(labels)?,
        surfaces: pieces(&state),
        noise: domain.sigma,
        relations,
        n_held: placement.n_held,
        n_folded: 0,
        status: RestoreStatus::Restored,
    };
    if restored.surfaces.iter().all(|piece| piece.surface.is_none()) {
        restored.vertices = memory::twin(positions)?;
        let is_stopped = segments.status == Status::Stopped || progress.is_finishing();
        restored.status = if is_stopped { RestoreStatus::Stopped } else { RestoreStatus::Unsure };
        return Ok(restored);
    }
    if options.free && has_free && !progress.is_finishing() {
        say(progress, 0.85, "free pieces");
        free::denoise(&domain, &state, &mut placement, &options.solve, progress)?;
    }
    say(progress, 0.95, "folds");
    restored.n_folded = relax::relax(&domain, &state, &mut placement, progress)?;
    restored.vertices = kept(positions, placement.points, rounding)?;
    if !Surroundings::of(positions).hold(&restored.vertices) {
        return Err(refused());
    }
    if segments.status == Status::Stopped || progress.is_finishing() {
        restored.status = RestoreStatus::Stopped;
    }
    Ok(restored)
}

/// The points, those that moved by no more than rounding as they were.
fn kept(before: &[Point], after: Vec<Point>, least: f64) -> Result<Vec<Point>> {
    let one = |(&p, q): (&Point, Point)| if distance(p, q) <= least { p } else { q };
    Ok(memory::gathered(before.iter().zip(after).map(one))?)
}

/// What is said of the pieces.
fn pieces(state: &Labelling) -> Vec<RestoredSurface> {
    let said = |piece: &crate::labelling::Piece| RestoredSurface {
        surface: piece.surface,
        is_inside_out: piece.side < 0.0,
        rms: piece.rms,
        n_faces: piece.faces.len(),
    };
    state.pieces.iter().map(said).collect()
}

fn say(progress: &Progress, fraction: f64, stage: &str) {
    progress.report(Report { fraction, stage: stage.into(), ..Report::default() });
}
