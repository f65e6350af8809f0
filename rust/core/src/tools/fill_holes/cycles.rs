//! The cycles that bring ridges back: flow, flips, snapping, remeshing,
//! until the patch rests or the parts around it meet in it.

use super::completion::Completion;
use super::constants::{
    COARSE_FACES, EXTEND_AFTER, FAIR_ROUNDS, FAIR_STEPS, FLOW_STEPS, MOST_BEND, RESAMPLE_EVERY,
    RESAMPLE_ROUNDS, RIDGE_SHARE, SNAPS, SNAP_FROM, STILL_CYCLE,
};
use super::extend::{extend, Extended};
use super::fair::fair;
use super::filled::Completed;
use super::flips::flip_along_ridges;
use super::flow::flow;
use super::parts::SmoothParts;
use super::region::Region;
use super::resample::typical_edge;
use super::snap::{snap, Snapping};
use super::surface::total_bend;
use super::{HoleStatus, PatchShape, Sharpness};
use crate::remesh::guard::worst_bend;
use crate::shape_guard::FOLDED;
use crate::Result;

/// The last region without folds, or with no worse ones than the first had.
struct Unfolded {
    region: Region,
    worst: f64,
}

impl Unfolded {
    fn new(region: &Region) -> Result<Self> {
        Ok(Self { region: region.twin()?, worst: worst_bend(&region.mesh).min(FOLDED) })
    }

    fn allows(&self, region: &Region) -> bool {
        worst_bend(&region.mesh) >= self.worst
    }

    fn keep(&mut self, region: &Region) -> Result<()> {
        if self.allows(region) {
            self.region = region.twin()?;
        }
        Ok(())
    }
}

impl Completion<'_, '_> {
    /// The cycles that bring the ridges around the hole back.
    pub(super) fn form_ridges(&mut self, region: &mut Region) -> Result<()> {
        let (smooth, mut last) = (region.twin()?, Unfolded::new(region)?);
        let cycles = self.options.iterations.div_ceil(FLOW_STEPS);
        let is_sharp = self.completed.sharpness > 0.0;
        self.completed.status = HoleStatus::Finished;
        for cycle in 1..=cycles {
            self.progress.check()?;
            if self.progress.is_finishing() {
                self.completed.status = HoleStatus::Stopped;
                return Ok(());
            }
            let flowed = self.flow(region, cycle)?;
            let is_aligned = is_sharp && !self.progress.is_finishing();
            let moved = if is_aligned { flowed.max(align(region, cycle)?) } else { flowed };
            self.report(region, 0.05 + 0.9 * cycle as f64 / cycles as f64)?;
            last.keep(region)?;
            if cycle > SNAP_FROM && moved < STILL_CYCLE * typical_edge(&region.mesh)? {
                self.completed.status = HoleStatus::Converged;
                break;
            }
            if is_sharp && cycle >= EXTEND_AFTER && cycle.is_power_of_two() {
                if let Some(extended) =
                    self.extended(region, &smooth)?.filter(|extended| last.allows(extended))
                {
                    *region = extended;
                    self.report(region, 1.0)?;
                    self.completed.status = HoleStatus::Converged;
                    return Ok(());
                }
            }
            if is_sharp && cycle % RESAMPLE_EVERY == 0 {
                self.resample(region, self.ridge(), COARSE_FACES, RESAMPLE_ROUNDS)?;
                flip_along_ridges(region)?;
            }
        }
        if is_sharp && cycles > 0 && !self.progress.is_finishing() {
            self.smooth_between(region, self.ridge())?;
            if !last.allows(region) {
                *region = last.region.twin()?;
                self.smooth_between(region, self.ridge())?;
            }
            self.report(region, 1.0)?;
        }
        if !last.allows(region) {
            *region = last.region;
        }
        let is_free = self.options.sharpness == Sharpness::Auto && self.options.shape != PatchShape::Sharp;
        if is_free && is_sharp && cycles > 0 && total_bend(region)? > MOST_BEND * total_bend(&smooth)? {
            *region = smooth;
            self.completed = Completed::smooth();
        }
        Ok(())
    }

    /// The steps of the flow of one cycle; returns the longest move.
    fn flow(&mut self, region: &mut Region, cycle: usize) -> Result<f64> {
        let steps = FLOW_STEPS.min(self.options.iterations - self.completed.iterations);
        let flowed = flow(region, steps, self.completed.sharpness, self.options, self.progress)?;
        if cycle == 1 {
            self.completed.energy[0] = flowed.energy[0];
        }
        self.completed.energy[1] = flowed.energy[1];
        self.completed.gap = flowed.gap;
        self.completed.iterations += steps;
        Ok(flowed.moved)
    }

    /// The patch in which the parts between the ridges around it have gone on until they meet. Where there
    /// are folds besides ridges, the parts between ridges alone are tried too; and where noise hides the
    /// ridges, segments. These may find parts that are none: their patch may have no more folds than the
    /// `smooth` one asks for.
    fn extended(&self, region: &Region, smooth: &Region) -> Result<Option<Region>> {
        let edge = typical_edge(&region.mesh)?;
        for bend in self.ridges.iter().flat_map(|ridges| ridges.bends()) {
            let ridge = RIDGE_SHARE * bend;
            let Some(parts) = SmoothParts::between_ridges(region, ridge, edge)? else { continue };
            if let Some(extended) = self.extended_by(region, &parts, ridge)? {
                return Ok(Some(extended));
            }
        }
        let found;
        let segments = if self.segments.is_some() {
            &self.segments
        } else {
            found = SmoothParts::segments(region, &self.options.solve, edge, self.progress)?;
            &found
        };
        let Some(segments) = segments else { return Ok(None) };
        let most = MOST_BEND * total_bend(smooth)?;
        match self.extended_by(region, segments, self.ridge())? {
            Some(extended) if total_bend(&extended)? <= most => Ok(Some(extended)),
            _ => Ok(None),
        }
    }

    /// The patch in which `parts` have gone on until they meet, if they do; edges bent by more than `ridge`
    /// (radians) part them.
    fn extended_by(&self, region: &Region, parts: &SmoothParts, ridge: f64) -> Result<Option<Region>> {
        let mut extended = region.twin()?;
        match extend(&mut extended, parts, self.options.edge_length, self.progress)? {
            Extended::NotMet => return Ok(None),
            Extended::Planes => {}
            Extended::Bent => self.smooth_between(&mut extended, ridge)?,
        }
        Ok(Some(extended))
    }

    /// Makes the parts between ridges smooth. Between the rounds the patch is remeshed:
    /// thin triangles would hold the next one back.
    fn smooth_between(&self, region: &mut Region, ridge: f64) -> Result<()> {
        for _ in 0..FAIR_ROUNDS {
            self.resample(region, ridge, COARSE_FACES, RESAMPLE_ROUNDS)?;
            for _ in 0..FAIR_STEPS {
                if self.progress.is_finishing() {
                    return Ok(());
                }
                flip_along_ridges(region)?;
                fair(region, ridge, self.progress)?;
            }
        }
        Ok(())
    }
}

/// Turns the edges of the patch along its ridges and snaps its vertices onto them; returns the longest move,
/// infinite where an edge was flipped.
fn align(region: &mut Region, cycle: usize) -> Result<f64> {
    let mut flips = flip_along_ridges(region)?;
    let mut moved: f64 = 0.0;
    if cycle >= SNAP_FROM {
        for _ in 0..SNAPS {
            moved = moved.max(snap(region, &Snapping::DEFAULT)?);
            flips += flip_along_ridges(region)?;
        }
    }
    Ok(if flips > 0 { f64::INFINITY } else { moved })
}
