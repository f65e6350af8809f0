//! Where the flow starts: the smooth patch.

use super::region::Region;
use crate::linear::Columns;
use crate::memory;
use crate::operators::{Dual, Energy, EnergyForm};
use crate::progress::Progress;
use crate::solve::{quadratic, Coupling, Problem, Settings};
use crate::Result;

/// Moves the patch to the minimizer of a quadratic energy of its coordinates, everything around it fixed,
/// `rounds` times, or until the caller wishes to finish: the energy is that of the surface before each round.
pub(super) fn smooth(region: &mut Region, energy: Energy, rounds: usize, progress: &Progress) -> Result<()> {
    let settings = Settings { announce: false, ..Settings::default() };
    for _ in 0..rounds {
        progress.check()?;
        if progress.is_finishing() {
            break;
        }
        let mesh = region.to_mesh()?;
        let form = EnergyForm::new(energy, &mesh, None, Dual::default())?;
        let problem = Problem {
            operator: &form.operator,
            weights: form.weights,
            fidelity: memory::repeated(0.0, region.mesh.n_vertices())?,
            target: Columns::from_points(region.mesh.positions())?,
            fixed: region.fixed()?,
            linear_constraints: None,
            coupling: Coupling::Joint,
        };
        let solution = quadratic::minimize(&problem, &settings, &progress.patient())?;
        for (v, point) in (0..).zip(solution.values.to_points()?).skip(region.anchors.len()) {
            region.mesh.set_position(v, point);
        }
    }
    Ok(())
}
