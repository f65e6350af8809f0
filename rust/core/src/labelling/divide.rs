//! Pieces that their surface does not explain are divided, and surfaces are sought in those that have none:
//! what strays becomes a piece with a surface of its own, and borders move to where the energy is least.

use super::constants::{FREE_MISFIT, MOST_ROUNDS, NOISE_MISFIT, SOUGHT_SHARE, TURNS};
use super::doubt::Strays;
use super::labels::{Labelling, NONE};
use super::merge::merge;
use super::seek::{goes_on, seek};
use super::swap::swap;
use super::Domain;
use crate::progress::Progress;
use crate::{memory, Result};

/// Divides pieces as long as the energy falls. `has_left` learns which faces were on a surface that did not
/// explain them.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn divide(
    domain: &Domain<'_>,
    state: &mut Labelling,
    has_left: &mut [bool],
    progress: &Progress,
) -> Result<()> {
    sought(domain, state, has_left, progress)?;
    part(domain, state, has_left, progress)
}

/// Seeks surfaces in pieces that have none and in what strays. What is found is taken if, before neighbors
/// become one, the energy falls by [`SOUGHT_SHARE`] of what it could by surfaces in free pieces, where noise
/// alone would be left: patches lower it on any smooth shape, and to merge hundreds takes longest.
fn sought(
    domain: &Domain<'_>,
    state: &mut Labelling,
    has_left: &mut [bool],
    progress: &Progress,
) -> Result<()> {
    let is_free = |label: u32| state.pieces.get(label as usize).is_some_and(|piece| piece.surface.is_none());
    let free: Vec<bool> = memory::gathered(state.labels.iter().map(|&label| is_free(label)))?;
    if progress.is_finishing() || !goes_on(domain, &free)? {
        return Ok(());
    }
    let out: Vec<bool> = memory::gathered(state.labels.iter().map(|label| *label == NONE))?;
    let energy = state.energy(domain);
    tried(state, has_left, |state, has_left| {
        let strays = Strays::new(domain, state)?.found()?;
        state.leave(domain, &strays, has_left)?;
        let n_before = state.pieces.len() as u32;
        for (label, is_free) in state.labels.iter_mut().zip(&free) {
            if *is_free || *label >= n_before {
                *label = NONE;
            }
        }
        if !seek(domain, state, &out, progress)? {
            return Ok(false);
        }
        for turn in 0..TURNS {
            swap(domain, state, progress)?;
            state.fit_again(domain, turn == 0)?;
        }
        swap(domain, state, progress)?;
        state.fit_all(domain, progress)?;
        let faces = (0..free.len()).filter(|&f| free[f]);
        let most: f64 = faces.map(|f| (FREE_MISFIT - NOISE_MISFIT) * domain.shares(f)).sum();
        let gain = energy - state.energy(domain);
        let is_taken = gain >= SOUGHT_SHARE * most && gain > 0.0;
        if is_taken {
            settle(domain, state, progress)?;
        }
        Ok(is_taken)
    })?;
    Ok(())
}

/// Gives what strays together a surface of its own, as long as the energy falls.
fn part(
    domain: &Domain<'_>,
    state: &mut Labelling,
    has_left: &mut [bool],
    progress: &Progress,
) -> Result<()> {
    let mut energy = state.energy(domain);
    for _ in 0..MOST_ROUNDS {
        progress.check()?;
        let strays = Strays::new(domain, state)?.found()?;
        if !strays.contains(&true) || progress.is_finishing() {
            break;
        }
        let is_better = tried(state, has_left, |state, has_left| {
            state.leave(domain, &strays, has_left)?;
            state.fit_all(domain, progress)?;
            for _ in 0..TURNS {
                swap(domain, state, progress)?;
                state.fit_all(domain, progress)?;
            }
            settle(domain, state, progress)?;
            let after = state.energy(domain);
            let is_better = after < energy;
            energy = after;
            Ok(is_better)
        })?;
        if !is_better {
            break;
        }
    }
    Ok(())
}

/// Makes a change, and takes it back where it says that it is not for the better; says whether it is.
fn tried(
    state: &mut Labelling,
    has_left: &mut [bool],
    change: impl FnOnce(&mut Labelling, &mut [bool]) -> Result<bool>,
) -> Result<bool> {
    let (before, left_before) = (state.copied()?, memory::twin(has_left)?);
    let is_better = change(state, has_left)?;
    if !is_better {
        *state = before;
        has_left.copy_from_slice(&left_before);
    }
    Ok(is_better)
}

/// Neighbors that one surface explains become one piece, and borders and surfaces follow.
fn settle(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    merge(domain, state, progress)?;
    swap(domain, state, progress)?;
    state.fit_all(domain, progress)
}
