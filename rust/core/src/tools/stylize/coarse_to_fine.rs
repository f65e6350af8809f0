//! The flow from coarse meshes to fine ones.
//!
//! A flow says where planes will be, and a coarse mesh says the same of them at a fraction of the cost. So
//! the whole flow is done on the coarsest level, which also finds where it ends; each finer one takes the
//! displacement over and relaxes what the coarser one does not have, its detail and its noise, by two steps
//! as short, for its edges, as the flow's first, or by one where that leaves as much flat as the flow had:
//! what is large has been found, and what is small needs no more time. All levels have one unit of length,
//! so what a flow makes of a shape does not depend on how densely it is sampled.

use super::flow::{Flow, Legacy, Show};
use super::options::{FlowStatus, StylizeOptions, Stylized};
use super::Flatness;
use crate::error::MeshError;
use crate::levels::{face_values, levels, Level};
use crate::mesh::vector::{add, sub, Point};
use crate::mesh::{edge_lengths, Mesh};
use crate::progress::Progress;
use crate::solve::Settings;
use crate::tools::options::ENOUGH;
use crate::tools::Scale;
use crate::{memory, Error, Result};

/// How many steps a flow is expected to take on its coarsest level, for the progress: 2 to 9.
const EXPECTED: usize = 6;

/// The most steps on each finer level: the first clears the noise away, the second finds the ridges. With the
/// last step of the flow only, fewer facets of noisy shapes are flat (0.45 of a bust, 0.60 with two, 0.63
/// with all). Where there is no noise, one finds them.
const STEPS: usize = 2;

/// A mesh that has so many times as many vertices as its coarsest level is shown what the flow of that level
/// ends with, and no step before: to draw 500,000 vertices once takes Blender longer than these steps, which
/// are a second's work, and the picture that matters would have to wait for that of the first one.
const LARGE: usize = 8;

/// The flow of `mesh` by levels; `finest` is that of the mesh itself, from its beginning.
pub(super) fn coarse_to_fine(
    mesh: &Mesh,
    options: &StylizeOptions,
    mut finest: Flow<'_>,
    scale: Scale,
    show: Show<'_>,
    settings: &Settings,
    progress: &Progress,
) -> Result<Stylized> {
    let start = mesh.positions().ok_or(MeshError::NoPositions)?;
    let held = held(options, start.len())?;
    let mut levels = match levels(mesh, held.as_deref(), ENOUGH, &progress.hasty()) {
        // Nothing has moved yet.
        Err(Error::Cancelled) if !progress.is_cancelled() => {
            finest.run(settings, progress)?;
            return Ok(finest.into_result());
        }
        levels => levels?,
    };
    // One unit of length for all levels.
    let lengths = edge_lengths(mesh.connectivity().faces(), start)?;
    let coarse_scale = Scale::Length(scale.unit(mesh.connectivity(), start, &lengths));
    let all = options_by_level(mesh, options, held.as_deref(), &levels)?;
    let fractions = fractions(mesh, &levels);
    let energy = finest.energy()?;
    let mut account = Account { energy: vec![energy], ..Account::default() };
    let mut legacy: Option<Legacy> = None;
    for depth in (1..=levels.len()).rev() {
        let level = &levels[depth - 1];
        let onto_mesh = |points: &[Point]| show(&carried(mesh, &levels[..depth], memory::twin(points)?)?);
        let mut flow = Flow::new(&level.mesh, &all[depth], coarse_scale, &onto_mesh)?
            .within(fractions[depth])
            .going_on();
        if let Some(legacy) = legacy.take() {
            flow.resume(legacy)?;
        } else if start.len() >= LARGE * level.mesh.connectivity().n_vertices() {
            flow = flow.showing_its_end();
        }
        flow.run(settings, progress)?;
        progress.check()?;
        if progress.is_finishing() {
            let result = flow.into_result();
            account.add(&result);
            return Ok(account.of(stopped(mesh, result, &levels[..depth])?));
        }
        let finer = mesh_at(mesh, &levels, depth - 1);
        let n_vertices = |mesh: &Mesh| mesh.connectivity().n_vertices() as f64;
        let left = flow.legacy(STEPS, n_vertices(finer) / n_vertices(&level.mesh));
        account.add(&flow.into_result());
        if left.plan.n_steps() > 0 {
            let points = carried(finer, &levels[depth - 1..depth], left.points)?;
            let faces = finer.connectivity().faces();
            let finer_factors = |factors: &Vec<f64>| level.carry.factors(factors, faces);
            let sharpening = left.sharpening.as_ref().map(finer_factors).transpose()?;
            legacy = Some(Legacy { points, sharpening, ..left });
        }
        // The finer ones need no more of it.
        levels.truncate(depth - 1);
    }
    if let Some(legacy) = legacy {
        finest.resume(legacy)?;
    }
    let mut finest = finest.within(fractions[0]);
    finest.run(settings, progress)?;
    let result = finest.into_result();
    account.add(&result);
    Ok(account.of(result))
}

/// The mesh of a level, 0 for the finest.
fn mesh_at<'m>(mesh: &'m Mesh, levels: &'m [Level], depth: usize) -> &'m Mesh {
    match depth {
        0 => mesh,
        _ => &levels[depth - 1].mesh,
    }
}

/// Which vertices do not move at all: none of the others collapses into one of them.
fn held(options: &StylizeOptions, n_vertices: usize) -> Result<Option<Vec<bool>>> {
    let may_hold = options.fixed.is_some() || options.strength.is_some();
    Ok(may_hold.then(|| memory::gathered((0..n_vertices).map(|v| options.holds(v)))).transpose()?)
}

/// What is asked of each level, the finest first.
fn options_by_level(
    mesh: &Mesh,
    options: &StylizeOptions,
    held: Option<&[bool]>,
    levels: &[Level],
) -> Result<Vec<StylizeOptions>> {
    let as_number = |held: &[bool]| memory::gathered(held.iter().map(|&is| f64::from(u8::from(is))));
    let mut fixed: Option<Vec<f64>> = held.map(as_number).transpose()?;
    let mut strength = options.strength.as_deref().map(memory::twin).transpose()?;
    let values = |weights: &Vec<f64>| face_values(mesh, levels, weights);
    let ridges = options.ridge_weights.as_ref().map(values).transpose()?;
    let mut all = vec![options.copied()?];
    let is_most = |values: &[f64]| memory::gathered(values.iter().map(|&value| value > 0.5));
    for (i, level) in levels.iter().enumerate() {
        fixed = fixed.map(|values| level.mean_of(&values)).transpose()?;
        strength = strength.map(|values| level.mean_of(&values)).transpose()?;
        all.push(StylizeOptions {
            fixed: fixed.as_deref().map(is_most).transpose()?,
            strength: strength.as_deref().map(memory::twin).transpose()?,
            ridge_weights: ridges.as_ref().map(|values| memory::twin(&values[i])).transpose()?,
            ..options.without_arrays()
        });
    }
    Ok(all)
}

/// Points of the coarsest of `levels`, as they move the vertices of `mesh`, the finest.
fn carried(mesh: &Mesh, levels: &[Level], mut points: Vec<Point>) -> Result<Vec<Point>> {
    for (i, level) in levels.iter().enumerate().rev() {
        let finer = if i == 0 { mesh } else { &levels[i - 1].mesh };
        let (Some(home), Some(fine)) = (level.mesh.positions(), finer.positions()) else { continue };
        let moves: Vec<Point> = memory::gathered(points.iter().zip(home).map(|(p, q)| sub(*p, *q)))?;
        let moves = level.carry.points(&moves, [0.0; 3])?;
        points = memory::gathered(fine.iter().zip(moves).map(|(p, by)| add(*p, by)))?;
    }
    Ok(points)
}

/// The part of the whole that each level takes, by its vertices and the steps that are expected of it.
fn fractions(mesh: &Mesh, levels: &[Level]) -> Vec<[f64; 2]> {
    let work = |depth: usize| {
        let steps = if depth == levels.len() { EXPECTED } else { STEPS };
        mesh_at(mesh, levels, depth).connectivity().n_vertices() as f64 * steps as f64
    };
    let total: f64 = (0..=levels.len()).map(work).sum();
    let mut done = 0.0;
    let mut parts: Vec<[f64; 2]> = (0..=levels.len())
        .rev()
        .map(|depth| {
            let from = done;
            done += work(depth) / total;
            [from, done]
        })
        .collect();
    parts.reverse();
    parts
}

/// What the steps on all levels did.
#[derive(Default)]
struct Account {
    energy: Vec<f64>,
    fidelities: Vec<f64>,
    gap: Vec<f64>,
    solver_iterations: Vec<usize>,
    level_vertices: Vec<usize>,
    factorisations: usize,
}

impl Account {
    /// The steps on one level.
    fn add(&mut self, result: &Stylized) {
        // The first is that of what was taken over.
        self.energy.extend(result.energy.iter().skip(1));
        self.fidelities.extend(&result.fidelities);
        self.gap.extend(&result.gap);
        self.solver_iterations.extend(&result.solver_iterations);
        self.level_vertices.extend(&result.level_vertices);
        self.factorisations += result.factorisations;
    }

    /// The result with the account of all.
    fn of(self, result: Stylized) -> Stylized {
        let Self { energy, fidelities, gap, solver_iterations, level_vertices, factorisations } = self;
        Stylized { energy, fidelities, gap, solver_iterations, level_vertices, factorisations, ..result }
    }
}

/// What a flow that was stopped on a coarse level leaves on the mesh. However that level ended, those below
/// it were not done.
fn stopped(mesh: &Mesh, result: Stylized, levels: &[Level]) -> Result<Stylized> {
    let vertices = carried(mesh, levels, result.vertices)?;
    let start = mesh.positions().ok_or(MeshError::NoPositions)?;
    let flatness = [Flatness::of(mesh.connectivity(), start)?, Flatness::of(mesh.connectivity(), &vertices)?];
    let status = match result.status {
        failed @ (FlowStatus::Collapsed | FlowStatus::Diverged) => failed,
        _ => FlowStatus::Stopped,
    };
    Ok(Stylized { vertices, flatness, status, ..result })
}
