//! One hole: the smooth patch, and from it the sharp one where the surroundings ask for it.

use super::completion::{Completion, Watch};
use super::constants::{COARSE_FACES, FINE_FACES, FINE_ROUNDS, SHARP, SMOOTH_ROUNDS};
use super::decide::{bends_around, Bends};
use super::fair::fair;
use super::filled::{Completed, HoleStatus};
use super::flips::flip_along_ridges;
use super::parts::SmoothParts;
use super::region::Region;
use super::resample::typical_edge;
use super::start::smooth;
use super::{FillHolesOptions, PatchShape, Sharpness};
use crate::operators::Energy;
use crate::progress::Progress;
use crate::remesh::guard::worst_bend;
use crate::shape_guard::FOLDED;
use crate::Result;

/// Moves the patch of `region` to where the surface around it goes on; `watch` hears of every cycle.
pub(super) fn complete(
    region: &mut Region,
    options: &FillHolesOptions,
    progress: &Progress,
    watch: &mut Watch<'_>,
) -> Result<Completed> {
    smooth(region, Energy::L2Laplacian, SMOOTH_ROUNDS, progress)?;
    watch(region, 0.05, 0, None)?;
    if progress.is_finishing() {
        return Ok(Completed { status: HoleStatus::Stopped, ..Completed::smooth() });
    }
    let bends = bends_around(region)?;
    let (ridges, segments) = match bends {
        Bends::Ridges(ridges) => (Some(ridges), None),
        Bends::Unclear if options.shape != PatchShape::Smooth => {
            let edge = typical_edge(&region.mesh)?;
            (None, SmoothParts::segments(region, &options.solve, edge, progress)?)
        }
        Bends::Unclear | Bends::Smooth => (None, None),
    };
    let is_sharp = ridges.is_some() || segments.is_some();
    let (sharpness, flows) = match (options.shape, options.sharpness) {
        (PatchShape::Smooth, _) => (0.0, false),
        (PatchShape::Sharp, Sharpness::Auto) => (SHARP, true),
        (_, Sharpness::Auto) => (if is_sharp { SHARP } else { 0.0 }, is_sharp),
        (_, Sharpness::Value(sharpness)) => (sharpness, true),
    };
    let shape = if sharpness > 0.0 { PatchShape::Sharp } else { PatchShape::Smooth };
    let completed = Completed { shape, sharpness, ..Completed::smooth() };
    let mut completion = Completion { options, progress, watch, ridges, segments, completed };
    if flows {
        completion.sharpen(region)?;
    }
    Ok(completion.completed)
}

impl Completion<'_, '_> {
    /// Forms the ridges on a coarse patch, and makes it fine after that.
    fn sharpen(&mut self, region: &mut Region) -> Result<()> {
        let is_remeshed = self.completed.sharpness > 0.0 && self.options.iterations > 0;
        // Where a length is asked for, a patch that got coarser while its ridges formed is made fine again.
        let most = if self.options.edge_length.is_some() { COARSE_FACES } else { 2 * COARSE_FACES };
        if !is_remeshed || region.mesh.n_faces() - region.n_outer <= most {
            return self.form_ridges(region);
        }
        let smooth = region.twin()?;
        self.resample(region, self.ridge(), COARSE_FACES, FINE_ROUNDS)?;
        self.form_ridges(region)?;
        if self.completed.sharpness == 0.0 {
            *region = smooth;
            return Ok(());
        }
        let coarse = region.twin()?;
        if !self.progress.is_finishing() {
            self.resample(region, self.ridge(), FINE_FACES, FINE_ROUNDS)?;
        }
        if self.progress.is_finishing() {
            *region = coarse;
            self.completed.status = HoleStatus::Stopped;
            return Ok(());
        }
        flip_along_ridges(region)?;
        fair(region, self.ridge(), self.progress)?;
        if worst_bend(&region.mesh) < worst_bend(&coarse.mesh).min(FOLDED) {
            *region = coarse;
        }
        self.report(region, 1.0)
    }
}
