//! The L1 flow of one patch (Rowe et al. 2024, section 7.4.2), everything around it fixed.

use super::constants::SOLVER_ITERATIONS;
use super::guard::move_guarded;
use super::region::Region;
use super::FillHolesOptions;
use crate::mesh::{edge_lengths, Connectivity};
use crate::progress::Progress;
use crate::tools::{stylize, Scale, SolveOptions, StylizeOptions};
use crate::unit::Unit;
use crate::Result;

/// What a few steps of the flow did.
pub(super) struct Flowed {
    /// How far the vertex that moved most is from where it was.
    pub moved: f64,
    /// `E_H` of the region before and after.
    pub energy: [f64; 2],
    /// The relative duality gap of the last step.
    pub gap: f64,
}

/// `steps` steps of the flow.
pub(super) fn flow(
    region: &mut Region,
    steps: usize,
    sharpness: f64,
    options: &FillHolesOptions,
    progress: &Progress,
) -> Result<Flowed> {
    let mesh = region.to_mesh()?;
    let by_residuals = options.solve.tolerance.is_none();
    let options = StylizeOptions {
        iterations: steps,
        fidelity: options.fidelity,
        sharpness,
        coupling: options.coupling,
        scale: Scale::Length(unit(region, options.scale)?),
        fixed: Some(region.fixed()?),
        dual: options.dual,
        solve: SolveOptions {
            max_iterations: options.solve.max_iterations.or(by_residuals.then_some(SOLVER_ITERATIONS)),
            ..options.solve.within()
        },
        ..StylizeOptions::default()
    };
    let result = stylize::flow(&mesh, Unit::default(), &options, None, &progress.quiet())?;
    let moved = move_guarded(region, &result.vertices)?;
    let (first, last) = (result.energy.first(), result.energy.last());
    Ok(Flowed {
        moved,
        energy: [first, last].map(|e| e.copied().unwrap_or(0.0)),
        gap: result.gap.last().copied().unwrap_or(0.0),
    })
}

/// The length that is 1 for the fidelity weight: of the patch alone, so that nothing farther away matters.
fn unit(region: &Region, scale: Scale) -> Result<f64> {
    let (points, faces, _) = region.patch()?;
    let lengths = edge_lengths(&faces, &points)?;
    Ok(scale.unit(&Connectivity::new(faces, points.len())?, &points, &lengths))
}
