//! Pieces of no known kind: denoised by the flow, as far as the noise goes.

use super::constants::{FLOW_FIDELITY, FLOW_STEPS};
use super::place::Placement;
use crate::labelling::{Domain, Labelling, NONE};
use crate::mesh::vector::norm;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::tools::{stylize, Scale, SolveOptions, StylizeOptions};
use crate::{memory, Result};

/// Moves the vertices inside free pieces by the flow until they have moved by the noise, root mean square.
///
/// # Errors
/// Those of [`stylize`].
pub(super) fn denoise(
    domain: &Domain<'_>,
    state: &Labelling,
    placement: &mut Placement,
    solve: &SolveOptions,
    progress: &Progress,
) -> Result<()> {
    let is_free = |f: u32| {
        let label = state.labels[f as usize];
        label != NONE && state.pieces[label as usize].surface.is_none()
    };
    let stays = |v: usize| !(placement.moves[v] && domain.faces_at(v as u32).iter().all(|&f| is_free(f)));
    let fixed: Vec<bool> = memory::gathered((0..placement.points.len()).map(stays))?;
    if fixed.iter().all(|fixed| *fixed) {
        return Ok(());
    }
    let area: f64 = domain.areas.iter().map(|a| norm(*a)).sum();
    let mesh = Mesh::new(memory::twin(&placement.points)?, memory::twin(domain.connectivity.faces())?)?;
    let options = StylizeOptions {
        iterations: FLOW_STEPS,
        fidelity: FLOW_FIDELITY,
        movement: Some(domain.sigma / area.sqrt()),
        scale: Scale::Area,
        fixed: Some(fixed),
        solve: solve.within(),
        ..StylizeOptions::default()
    };
    placement.points = stylize(&mesh, &options, &progress.quiet())?.vertices;
    Ok(())
}
