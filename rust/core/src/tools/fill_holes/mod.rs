//! Hole filling that brings ridges back (Rowe et al. 2024, section 7.4.2, and beyond it).
//!
//! Each hole is a problem of its own ([`region`]): the patch and a few rings around it. The passes,
//! in their order:
//!
//! 1. Which loops ([`choice`]), on an oriented mesh without seams; what comes out is given back for the mesh
//!    as it was ([`give_back`]).
//! 2. Planar rims that the surface meets steeply all round are closed flat; every other patch is
//!    [`complete`]d, and one that came out folded gives way to one that did not ([`sound`]).
//! 3. It starts as the minimizer of a quadratic energy ([`start`]). Where the surface around is smooth
//!    ([`decide`]) that is all.
//! 4. Where it has ridges, [`cycles`] follow: the L1 flow flattens ([`flow`]),
//!    edges flip along the ridges ([`flips`]).
//! 5. Then the smooth parts around the hole ([`parts`]), each a plane or gently bent ([`model`]), are given
//!    the faces of the patch ([`assign`]) and go on until they meet ([`extend`], [`meeting`]), with folds
//!    opened ([`untangle`]).
//! 6. Where they do not say how, the cycles go on: vertices snap onto the planes around them and their
//!    intersections ([`snap`]), the patch is remeshed with its ridges kept ([`resample`]).
//! 7. In the end bent parts become smooth ([`fair`]) and the ridges go on as those around ([`ridge_curves`]).
//!
//! No move folds the surface ([`guard`]).

mod assign;
mod choice;
mod complete;
mod completion;
mod constants;
mod cycles;
mod decide;
mod extend;
mod fair;
mod filled;
mod flips;
mod flow;
mod give_back;
mod guard;
mod meeting;
mod model;
mod neighborhoods;
mod options;
mod parts;
mod region;
mod resample;
mod ridge_curves;
mod snap;
mod sound;
mod start;
mod surface;
mod untangle;

pub use filled::{Filled, FilledHole, HoleStatus};
pub use options::{FillHolesOptions, LoopChoice, PatchShape, Sharpness};

use std::collections::HashSet;

use super::answer::{self, Surroundings};
use super::Scale;
use crate::error::MeshError;
use crate::hole_filling::{faces_at, FillOptions, Lids, Patch};
use crate::memory::{self, Demand, Tool};
use crate::mesh::{boundary_loops, Mesh, Working};
use crate::progress::{Progress, Report};
use crate::remesh::budget;
use crate::Result;
use constants::{MARKED_ANGLE, REGION_RINGS};
use filled::Completed;
use neighborhoods::Neighborhoods;
use region::Region;
use sound::completed_in_order;

/// Fills holes so that the ridges around them go on.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::Unfillable`] for vertices that are no boundary loop, arguments
/// out of range, the errors of the solver, [`Error::Cancelled`].
pub fn fill_holes(mesh: &Mesh, options: &FillHolesOptions, progress: &Progress) -> Result<Filled> {
    options.check()?;
    options.solve.settings()?;
    let unit = mesh.unit();
    let mesh = mesh.measured(unit)?;
    let options = FillHolesOptions {
        edge_length: options.edge_length.map(|length| unit.measure(length)),
        scale: match options.scale {
            Scale::Length(length) => Scale::Length(unit.measure(length)),
            relative => relative,
        },
        ..options.clone()
    };
    let working = Working::new(&mesh)?;
    let options = give_back::options_on(&working, &options);
    let filled = options.solve.run(|| fill(&working, &options, &progress.in_unit(unit)))?;
    let mut filled = give_back::given_back(filled, &working)?;
    let around = Surroundings::of(
        filled
            .holes
            .iter()
            .flat_map(|hole| &hole.boundary)
            .filter_map(|&v| Some(&mesh.positions()?[v as usize])),
    );
    if !around.hold(&filled.vertices) || filled.holes.iter().any(|hole| !hole.gap.is_finite()) {
        return Err(answer::refused());
    }
    for hole in &mut filled.holes {
        hole.gap = hole.gap.max(0.0);
        for energy in &mut hole.energy {
            *energy = unit.restore_finite("the energy", *energy)?;
        }
    }
    unit.restore_all(filled.vertices.iter_mut().flatten());
    Ok(filled)
}

/// What filling holes takes of which the longest has `longest` edges, since they follow each other;
/// without it, all of the mesh.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn filling_demand(mesh: &Mesh, longest: Option<usize>) -> Result<Demand> {
    let longest = match longest {
        Some(longest) => longest,
        None => boundary_loops(mesh.connectivity())?.iter().map(Vec::len).max().unwrap_or(0),
    };
    Ok(demand(mesh, longest, None))
}

/// What a patch in a rim of so many edges takes: it has as many faces as a disk with that rim has, up to the
/// bound for all patches, or where an edge length is asked for, as that bound says. The mesh itself is only
/// looked through: a flag and a bit of bookkeeping for each face.
fn demand(mesh: &Mesh, n_rim_edges: usize, edge_length: Option<f64>) -> Demand {
    let most = budget::patch_faces(FillOptions::default().max_faces, n_rim_edges);
    let disk = edge_length.map_or(n_rim_edges.saturating_mul(n_rim_edges) / 5, |_| most);
    let whole = mesh.demand(Tool::FillHoles);
    Demand { n_vertices: 0, n_faces: disk.min(most) + whole.n_faces / 200, ..whole }
}

fn fill(working: &Working<'_>, options: &FillHolesOptions, progress: &Progress) -> Result<Filled> {
    let mesh = working.mesh();
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    report(progress, 0.0, "triangulating", 0, None);
    let lids = match options.shape {
        PatchShape::Auto => Lids::Planar,
        PatchShape::Flat => Lids::Always,
        PatchShape::Smooth | PatchShape::Sharp => Lids::Never,
    };
    let geometry = FillOptions { edge_length: options.edge_length, lids, ..FillOptions::default() };
    let mut chosen = choice::choose(mesh, options)?;
    let loops: Vec<Vec<u32>> = chosen.iter().map(|(vertices, _)| vertices.clone()).collect();
    let longest = loops.iter().map(Vec::len).max().unwrap_or(0);
    demand(mesh, longest, options.edge_length).admit(options.solve.memory_limit)?;
    let at_loops = faces_at(mesh, &loops)?;
    let patches = choice::triangulate(mesh, &mut chosen, &at_loops, &geometry, progress)?;
    let mut filled = Filled::none();
    let near = Neighborhoods::new(mesh.connectivity(), &at_loops)?;
    let shared = choice::on_several(&chosen);
    let filling = Filling { working, near, shared, options, progress };
    let total = patches.iter().map(|patch| patch.faces.len()).sum::<usize>().max(1) as f64;
    let mut done = 0.0;
    // Where the new vertices of a patch begin, as the triangulation numbered them.
    let mut from = positions.len() as u32;
    for ((boundary, refusal), patch) in chosen.into_iter().zip(patches) {
        let share = patch.faces.len() as f64 / total;
        let outcome = match refusal {
            Some(reason) => Err(reason),
            None => {
                let watch = |part: f64, steps, energy| {
                    report(progress, done + share * part, "filling", steps, energy)
                };
                Ok(filling.one(&patch, from, &mut filled, &watch)?)
            }
        };
        done += share;
        from += patch.vertices.len() as u32;
        filled.holes.push(FilledHole::of(boundary, outcome));
    }
    filled.sum_up();
    report(progress, 1.0, "filling", 0, None);
    Ok(filled)
}

/// What the filling of every hole knows.
struct Filling<'a> {
    working: &'a Working<'a>,
    near: Neighborhoods<'a>,
    /// The vertices on several loops.
    shared: HashSet<u32>,
    options: &'a FillHolesOptions,
    progress: &'a Progress,
}

impl Filling<'_> {
    /// Completes one patch, whose new vertices begin at the number `from`, and appends it.
    fn one(
        &self,
        patch: &Patch,
        from: u32,
        filled: &mut Filled,
        watch: &dyn Fn(f64, usize, Option<f64>),
    ) -> Result<Completed> {
        let (mesh, progress) = (self.working.mesh(), self.progress);
        let mut region = Region::new(mesh, &self.near, patch, from, REGION_RINGS, &self.shared)?;
        region.first_new = (mesh.connectivity().n_vertices() + filled.vertices.len()) as u32;
        let completed = completed_in_order(
            &mut region,
            patch,
            self.options,
            progress,
            &mut |region, part, steps, energy| {
                let (mut vertices, faces, _) = region.patch()?;
                vertices.iter_mut().for_each(|p| *p = self.working.place(*p));
                progress.set_surface(vertices, faces);
                watch(part, steps, energy);
                Ok(())
            },
        )?;
        memory::extend(&mut filled.vertices, region.free().len())?;
        filled.vertices.extend(region.free().map(|v| region.mesh.position(v)));
        memory::extend(&mut filled.faces, region.mesh.n_faces() - region.n_outer)?;
        filled.faces.extend(region.patch_faces().map(|(_, face)| face.map(|v| region.global(v))));
        memory::grow(&mut filled.patch, filled.faces.len(), filled.holes.len() as u32)?;
        if completed.shape != PatchShape::Smooth {
            let ridges = surface::ridges(&region, MARKED_ANGLE)?;
            memory::extend(&mut filled.ridges, ridges.len())?;
            filled.ridges.extend(ridges);
        }
        Ok(completed)
    }
}

fn report(progress: &Progress, fraction: f64, stage: &str, iteration: usize, energy: Option<f64>) {
    progress.report(Report { fraction, stage: stage.into(), iteration, energy, gap: None });
}
