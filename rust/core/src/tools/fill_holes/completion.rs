//! What the passes over one patch go by, and what has become of it.

use super::constants::RIDGE_SHARE;
use super::decide::Ridges;
use super::filled::Completed;
use super::parts::SmoothParts;
use super::region::Region;
use super::resample::{resample, Kept, Target};
use super::FillHolesOptions;
use crate::progress::Progress;
use crate::Result;

/// Hears of every cycle: the region, how much is done, the steps so far, the energy.
pub(super) type Watch<'a> = dyn FnMut(&Region, f64, usize, Option<f64>) -> Result<()> + 'a;

/// The completion of one patch: what it goes by, and what has become of it.
pub(super) struct Completion<'a, 'w> {
    pub options: &'a FillHolesOptions,
    pub progress: &'a Progress,
    pub watch: &'a mut Watch<'w>,
    /// The ridges around the hole.
    pub ridges: Option<Ridges>,
    /// The parts around the hole that noise hides the ridges of.
    pub segments: Option<SmoothParts>,
    pub completed: Completed,
}

impl Completion<'_, '_> {
    /// Edges of the patch that are bent by more than this (radians) are ridges.
    pub(super) fn ridge(&self) -> f64 {
        RIDGE_SHARE * self.ridges.map_or(1.0, |ridges| ridges.least)
    }

    /// Remeshes the patch; edges bent by more than `ridge` radians stay.
    pub(super) fn resample(
        &self,
        region: &mut Region,
        ridge: f64,
        max_faces: usize,
        rounds: usize,
    ) -> Result<()> {
        let target = Target { edge_length: self.options.edge_length, max_faces, rounds };
        resample(region, &Kept::ridges(ridge), &target, self.progress)
    }

    /// Tells the watch how much is done.
    pub(super) fn report(&mut self, region: &Region, part: f64) -> Result<()> {
        (self.watch)(region, part, self.completed.iterations, Some(self.completed.energy[1]))
    }
}
