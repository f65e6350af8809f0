//! The flow toward piecewise flat shapes (Rowe et al. 2024, eq. (24)), with sharpness.

mod coarse_to_fine;
mod flatness;
mod flow;
mod movement;
mod options;
mod pace;

pub use flatness::Flatness;
use options::check;
pub use options::{FlowStatus, StylizeOptions, Stylized};

use super::scale::Scale;
use crate::error::MeshError;
use crate::memory::{self, Tool};
use crate::mesh::vector::Point;
use crate::mesh::{Mesh, Working};
use crate::progress::Progress;
use crate::solve::{Coupling, Settings};
use crate::unit::Unit;
use crate::Result;
use coarse_to_fine::coarse_to_fine;
use flow::Flow;

/// Moves the vertices of `mesh` toward piecewise flat patches with crisp ridges.
///
/// Each step minimizes `Σ_f w_f A_f ‖H_f x‖ + η ‖x − x⁽ⁱ⁾‖²_M` over the coordinates `x`, with operator and
/// mass of the mesh as it is then. Rowe et al. 2024, eq. (24); the weights are those of
/// [`sharpened_weights`], the sizes of the steps those of [`Pace`].
///
/// A large mesh gets coarser levels first, on which most steps are done ([`StylizeOptions::levels`]).
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
            fixed: options.fixed.as_ref().map(|fixed| working.any_of(fixed)).transpose()?,
            strength: options.strength.as_ref().map(|strength| working.least_of(strength)).transpose()?,
            ridge_weights: options.ridge_weights.as_deref().map(memory::twin).transpose()?,
            ..options.without_arrays()
        };
        let flowed = flow(working.mesh(), unit, &options, Some(&working), &progress)?;
        Stylized { vertices: working.positions(&flowed.vertices)?, ..flowed }
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
    let settings = Settings { announce: false, ..options.solve.settings()? };
    let n_columns = if options.coupling == Coupling::Joint { 3 } else { 1 };
    let scale = match options.scale {
        Scale::Length(length) => Scale::Length(unit.measure(length)),
        relative => relative,
    };
    let show = |points: &[Point]| {
        Ok(working.map_or_else(|| memory::twin(points), |working| working.positions(points))?)
    };
    options.solve.run(|| {
        mesh.demand(Tool::Stylize)
            .with_columns(n_columns, options.solve.solver.is_clarabel())
            .admit(options.solve.memory_limit)?;
        let mut flow = Flow::new(mesh, options, scale, &show)?;
        if options.uses_levels(mesh.connectivity().n_vertices()) && !flow.is_flat() {
            return coarse_to_fine(mesh, options, flow, scale, &show, &settings, progress);
        }
        flow.run(&settings, progress)?;
        Ok(flow.into_result())
    })
}
