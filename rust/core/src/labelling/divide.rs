//! Pieces that their surface does not explain are divided: what strays from it becomes a piece with a surface
//! of its own, and borders move to where the energy is least.

use super::constants::{MOST_ROUNDS, TURNS};
use super::doubt::Strays;
use super::labels::Labelling;
use super::merge::merge;
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
    let mut energy = state.energy(domain);
    for _ in 0..MOST_ROUNDS {
        progress.check()?;
        let strays = Strays::new(domain, state)?.found()?;
        if !strays.contains(&true) || progress.is_finishing() {
            break;
        }
        let (before, left_before) = (state.copied()?, memory::twin(has_left)?);
        state.leave(domain, &strays, has_left)?;
        state.fit_all(domain, progress)?;
        for _ in 0..TURNS {
            swap(domain, state, progress)?;
            state.fit_all(domain, progress)?;
        }
        merge(domain, state, progress)?;
        swap(domain, state, progress)?;
        state.fit_all(domain, progress)?;
        let after = state.energy(domain);
        if after.is_nan() || after >= energy {
            *state = before;
            has_left.copy_from_slice(&left_before);
            break;
        }
        energy = after;
    }
    Ok(())
}
