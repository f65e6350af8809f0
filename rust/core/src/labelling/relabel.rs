//! Faces at borders go to the piece with which the energy is least.

use super::constants::{BORDER, GAIN, MOST_SWEEPS};
use super::labels::{Labelling, NONE};
use super::Domain;
use crate::progress::Progress;
use crate::Result;

/// Lets faces change to a neighbor's piece, one at a time, as long as the energy falls. The surfaces stay.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn relabel(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    for _ in 0..MOST_SWEEPS {
        progress.check()?;
        let mut changed = false;
        for f in 0..state.labels.len() {
            changed |= improve(domain, state, f);
        }
        if !changed || progress.is_finishing() {
            break;
        }
    }
    Ok(())
}

fn improve(domain: &Domain<'_>, state: &mut Labelling, f: usize) -> bool {
    let own = state.labels[f];
    if own == NONE {
        return false;
    }
    let neighbors: Vec<(u32, f64)> = domain
        .around(f)
        .filter(|&(_, g)| state.labels[g] != NONE)
        .map(|(h, g)| (state.labels[g], domain.lengths[h / 3][h % 3] / domain.mean_edge))
        .collect();
    if neighbors.iter().all(|(label, _)| *label == own) {
        return false;
    }
    let cost = |label: u32| {
        let border: f64 =
            neighbors.iter().filter(|(other, _)| *other != label).map(|(_, length)| length).sum();
        domain.face_cost(f, state.pieces.get(label as usize)) + BORDER * border
    };
    let (mut best, mut least) = (own, cost(own) - GAIN);
    for &(label, _) in &neighbors {
        let candidate = cost(label);
        if candidate < least {
            (best, least) = (label, candidate);
        }
    }
    state.labels[f] = best;
    best != own
}
