//! One hole: the smooth patch, and from it the sharp one where the surroundings ask for it.

use super::decide::is_sharp;
use super::flips::flip_along_ridges;
use super::flow::flow;
use super::region::Region;
use super::snap::{snap, Snapping};
use super::start::smooth;
use super::{FillHolesOptions, HoleStatus, Sharpness};
use crate::mesh::vector::distance;
use crate::operators::Energy;
use crate::progress::Progress;
use crate::Result;

/// Rounds of the smooth start: the third moves the patch by a hundredth of an edge.
const SMOOTH_ROUNDS: usize = 3;

/// Sharpness where the surroundings are sharp: with less, a cube's corner is cut off, since the plain energy prefers it so.
const SHARP: f64 = 0.8;

/// Flow steps in a cycle, and the cycle from which on vertices snap: before, no face is on its plane yet.
const STEPS: usize = 3;
const SNAP_FROM: usize = 3;
const SNAPS: usize = 2;

/// Sweeps of flips at most; they end by themselves after three or four.
const SWEEPS: usize = 10;

/// A patch whose vertices all moved by less than this part of its mean edge in a cycle rests.
const STILL: f64 = 1e-3;

/// How one patch ended.
pub(super) struct Restored {
    pub sharpness: f64,
    pub status: HoleStatus,
    pub energy: [f64; 2],
    pub gap: f64,
    pub iterations: usize,
}

/// Moves the patch of `region` to where the surface around it goes on; `watch` is told how much is done, the steps so far
/// and the energy.
pub(super) fn restore(
    region: &mut Region,
    options: &FillHolesOptions,
    progress: &Progress,
    watch: &mut dyn FnMut(&Region, f64, usize, Option<f64>),
) -> Result<Restored> {
    smooth(region, Energy::L2Laplacian, SMOOTH_ROUNDS, progress)?;
    watch(region, 0.05, 0, None);
    let sharpness = match options.sharpness {
        Sharpness::Auto if is_sharp(region) => SHARP,
        Sharpness::Auto => 0.0,
        Sharpness::Value(sharpness) => sharpness,
    };
    let mut restored = Restored { sharpness, status: HoleStatus::Converged, energy: [0.0; 2], gap: 0.0, iterations: 0 };
    if options.sharpness == Sharpness::Auto && sharpness == 0.0 {
        return Ok(restored);
    }
    restored.status = HoleStatus::Finished;
    let cycles = options.iterations.div_ceil(STEPS);
    for cycle in 1..=cycles {
        progress.check()?;
        if progress.is_finishing() {
            restored.status = HoleStatus::Stopped;
            break;
        }
        let steps = STEPS.min(options.iterations - restored.iterations);
        let flowed = flow(region, steps, sharpness, options, progress)?;
        let mut moved = flowed.moved;
        let mut flips = 0;
        if sharpness > 0.0 {
            flips += flip_along_ridges(region, SWEEPS);
            if cycle >= SNAP_FROM {
                for _ in 0..SNAPS {
                    moved = moved.max(snap(region, &Snapping::WIDE));
                    flips += flip_along_ridges(region, SWEEPS);
                }
            }
        }
        if cycle == 1 {
            restored.energy[0] = flowed.energy[0];
        }
        restored.energy[1] = flowed.energy[1];
        restored.gap = flowed.gap;
        restored.iterations += steps;
        watch(region, cycle as f64 / cycles as f64, restored.iterations, Some(flowed.energy[1]));
        if flips == 0 && moved < STILL * mean_edge(region) && cycle > SNAP_FROM {
            restored.status = HoleStatus::Converged;
            break;
        }
    }
    Ok(restored)
}

fn mean_edge(region: &Region) -> f64 {
    let mesh = &region.mesh;
    let patch = mesh.faces().filter(|&(f, _)| region.is_patch(f)).map(|(_, face)| mesh.corners(face));
    let (sum, count) = patch.fold((0.0, 0.0), |(sum, count), [a, b, c]| {
        (sum + distance(a, b) + distance(b, c) + distance(c, a), count + 3.0)
    });
    sum / f64::max(count, 1.0)
}
