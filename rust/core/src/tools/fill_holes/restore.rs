//! One hole: the smooth patch, and from it the sharp one where the surroundings ask for it.

use super::constants::{
    ALIKE, COARSE_FACES, EXTEND_AFTER, FAIR_ROUNDS, FAIR_STEPS, FINE_FACES, FINE_ROUNDS, FLIP_SWEEPS, FLOW_STEPS,
    MOST_BEND, RESAMPLE_EVERY, RESAMPLE_ROUNDS, RIDGE, SHARP, SMOOTH_ROUNDS, SNAPS, SNAP_FROM, STILL_CYCLE,
};
use super::decide::{ridges_around, Ridges};
use super::extend::{extend, Extended};
use super::fair::fair;
use super::flips::flip_along_ridges;
use super::flow::flow;
use super::region::Region;
use super::resample::{resample, typical_edge, Kept};
use super::snap::{snap, Snapping};
use super::start::smooth;
use super::surface::total_bend;
use super::{FillHolesOptions, HoleStatus, PatchShape, Sharpness};
use crate::operators::Energy;
use crate::progress::Progress;
use crate::remesh::guard::worst_bend;
use crate::shape_guard::FOLDED;
use crate::Result;

/// How one patch ended.
pub(super) struct Restored {
    pub shape: PatchShape,
    pub sharpness: f64,
    pub status: HoleStatus,
    pub energy: [f64; 2],
    pub gap: f64,
    pub iterations: usize,
}

impl Restored {
    /// The end of a patch that stays smooth.
    pub(super) fn smooth() -> Self {
        Self {
            shape: PatchShape::Smooth,
            sharpness: 0.0,
            status: HoleStatus::Converged,
            energy: [0.0; 2],
            gap: 0.0,
            iterations: 0,
        }
    }
}

/// Hears of every cycle: the region, how much is done, the steps so far, the energy.
pub(super) type Watch<'a> = dyn FnMut(&Region, f64, usize, Option<f64>) + 'a;

/// Moves the patch of `region` to where the surface around it goes on; `watch` hears of every cycle.
pub(super) fn restore(
    region: &mut Region,
    options: &FillHolesOptions,
    progress: &Progress,
    watch: &mut Watch<'_>,
) -> Result<Restored> {
    smooth(region, Energy::L2Laplacian, SMOOTH_ROUNDS, progress)?;
    watch(region, 0.05, 0, None);
    let ridges = ridges_around(region);
    let (sharpness, flows) = match (options.shape, options.sharpness) {
        (PatchShape::Smooth, _) => (0.0, false),
        (PatchShape::Sharp, Sharpness::Auto) => (SHARP, true),
        (_, Sharpness::Auto) => (if ridges.is_some() { SHARP } else { 0.0 }, ridges.is_some()),
        (_, Sharpness::Value(sharpness)) => (sharpness, true),
    };
    let shape = if sharpness > 0.0 { PatchShape::Sharp } else { PatchShape::Smooth };
    let mut restored = Restored { shape, sharpness, ..Restored::smooth() };
    if !flows {
        return Ok(restored);
    }
    let ridge = RIDGE * ridges.map_or(1.0, |ridges| ridges.least);
    let is_remeshed = sharpness > 0.0 && options.iterations > 0;
    if !is_remeshed || region.mesh.n_faces() - region.n_outer <= 2 * COARSE_FACES {
        form_ridges(region, ridges, &mut restored, options, progress, watch)?;
        return Ok(restored);
    }
    let smooth = region.clone();
    resample(region, options.edge_length, &Kept::ridges(ridge), COARSE_FACES, FINE_ROUNDS, progress)?;
    form_ridges(region, ridges, &mut restored, options, progress, watch)?;
    if restored.sharpness == 0.0 {
        *region = smooth;
        return Ok(restored);
    }
    let coarse = region.clone();
    resample(region, options.edge_length, &Kept::ridges(ridge), FINE_FACES, FINE_ROUNDS, progress)?;
    flip_along_ridges(region, FLIP_SWEEPS);
    fair(region, ridge, progress)?;
    if worst_bend(&region.mesh) < worst_bend(&coarse.mesh).min(FOLDED) {
        *region = coarse;
    }
    watch(region, 1.0, restored.iterations, Some(restored.energy[1]));
    Ok(restored)
}

/// The cycles that bring the `ridges` around the hole back.
fn form_ridges(
    region: &mut Region,
    ridges: Option<Ridges>,
    restored: &mut Restored,
    options: &FillHolesOptions,
    progress: &Progress,
    watch: &mut Watch<'_>,
) -> Result<()> {
    let sharpness = restored.sharpness;
    let ridge = RIDGE * ridges.map_or(1.0, |ridges| ridges.least);
    let (smooth, mut sound) = (region.clone(), region.clone());
    let worst = worst_bend(&region.mesh).min(FOLDED);
    restored.status = HoleStatus::Finished;
    let cycles = options.iterations.div_ceil(FLOW_STEPS);
    for cycle in 1..=cycles {
        progress.check()?;
        if progress.is_finishing() {
            restored.status = HoleStatus::Stopped;
            return Ok(());
        }
        let steps = FLOW_STEPS.min(options.iterations - restored.iterations);
        let flowed = flow(region, steps, sharpness, options, progress)?;
        let moved = flowed.moved.max(if sharpness > 0.0 { align(region, cycle) } else { 0.0 });
        if cycle == 1 {
            restored.energy[0] = flowed.energy[0];
        }
        restored.energy[1] = flowed.energy[1];
        restored.gap = flowed.gap;
        restored.iterations += steps;
        watch(region, 0.05 + 0.9 * cycle as f64 / cycles as f64, restored.iterations, Some(flowed.energy[1]));
        if worst_bend(&region.mesh) >= worst {
            sound.clone_from(region);
        }
        if cycle > SNAP_FROM && moved < STILL_CYCLE * typical_edge(&region.mesh) {
            restored.status = HoleStatus::Converged;
            break;
        }
        if let Some(around) = ridges.filter(|_| sharpness > 0.0 && cycle == EXTEND_AFTER) {
            if let Some(extended) = extend_between(region, around, options, progress)? {
                if worst_bend(&extended.mesh) >= worst {
                    *region = extended;
                    watch(region, 1.0, restored.iterations, Some(restored.energy[1]));
                    restored.status = HoleStatus::Converged;
                    return Ok(());
                }
            }
        }
        if sharpness > 0.0 && cycle % RESAMPLE_EVERY == 0 {
            resample(region, options.edge_length, &Kept::ridges(ridge), COARSE_FACES, RESAMPLE_ROUNDS, progress)?;
            flip_along_ridges(region, FLIP_SWEEPS);
        }
    }
    if sharpness > 0.0 && cycles > 0 {
        finish(region, options, ridge, progress)?;
        if worst_bend(&region.mesh) < worst {
            region.clone_from(&sound);
            finish(region, options, ridge, progress)?;
        }
        watch(region, 1.0, restored.iterations, Some(restored.energy[1]));
    }
    if worst_bend(&region.mesh) < worst {
        *region = sound;
    }
    let is_sharp = restored.status != HoleStatus::Stopped && sharpness > 0.0 && cycles > 0;
    let is_free = options.sharpness == Sharpness::Auto && options.shape != PatchShape::Sharp;
    if is_free && is_sharp && total_bend(region) > MOST_BEND * total_bend(&smooth) {
        *region = smooth;
        *restored = Restored::smooth();
    }
    Ok(())
}

/// The patch in which the parts between the ridges around it have gone on until they meet. Where there are folds besides ridges,
/// the parts between ridges alone are tried too.
fn extend_between(
    region: &Region,
    ridges: Ridges,
    options: &FillHolesOptions,
    progress: &Progress,
) -> Result<Option<Region>> {
    for bend in [ridges.least, ridges.most] {
        let mut extended = region.clone();
        match extend(&mut extended, RIDGE * bend, options.edge_length, progress)? {
            Extended::NotMet => {}
            Extended::Planes => return Ok(Some(extended)),
            Extended::Bent => {
                finish(&mut extended, options, RIDGE * bend, progress)?;
                return Ok(Some(extended));
            }
        }
        if ridges.most < ALIKE * ridges.least {
            break;
        }
    }
    Ok(None)
}

/// Makes the parts between ridges smooth. Between the rounds the patch is remeshed: thin triangles would hold the next one back.
fn finish(region: &mut Region, options: &FillHolesOptions, ridge: f64, progress: &Progress) -> Result<()> {
    for _ in 0..FAIR_ROUNDS {
        resample(region, options.edge_length, &Kept::ridges(ridge), COARSE_FACES, RESAMPLE_ROUNDS, progress)?;
        for _ in 0..FAIR_STEPS {
            flip_along_ridges(region, FLIP_SWEEPS);
            fair(region, ridge, progress)?;
        }
    }
    Ok(())
}

/// Turns the edges of the patch along its ridges and snaps its vertices onto them; returns the longest move, infinite where an
/// edge was flipped.
fn align(region: &mut Region, cycle: usize) -> f64 {
    let mut flips = flip_along_ridges(region, FLIP_SWEEPS);
    let mut moved: f64 = 0.0;
    if cycle >= SNAP_FROM {
        for _ in 0..SNAPS {
            moved = moved.max(snap(region, &Snapping::DEFAULT));
            flips += flip_along_ridges(region, FLIP_SWEEPS);
        }
    }
    if flips > 0 {
        f64::INFINITY
    } else {
        moved
    }
}
