//! Which surface each face belongs to: one energy over labels `L` and surfaces `Θ`,
//!
//! `E(L, Θ) = Σ_v Σ_f∋v (A_f / A_v) ρ(d(v, Θ_L(f)) / σ) + Σ_border length / edge`
//! `+ κ Σ_surfaces parameters(Θ)`
//!
//! (PEARL: Isack and Boykov 2012; label costs: Delong et al. 2012). Every vertex is one observation of its
//! surfaces, shared among them by the areas of its faces: so the correlation of neighboring faces, which have
//! corners in common, is taken into account, and `E` is the negative logarithm of a likelihood. `ρ` is
//! [`crate::surfaces::misfit`], `κ` half the logarithm of the number of observations (Schwarz 1978). A piece
//! without a surface of a known kind is free: its vertices cost [`FREE_MISFIT`] each. Few vertices may carry
//! much of a modeled shape, so faces have a say: one with a corner off its surface is no better there than
//! free, and one that lies across it counts as far off.
//!
//! Moves: fit and exchange the kind ([`pieces`]), [`relabel`] faces at borders, [`merge`] neighbors; each is
//! taken only if `E` falls. Then surfaces are sought in pieces that have none ([`mod@seek`]): they [`grow`]
//! from a few faces as far as faces lie on them. Pieces are divided whose surface does not explain them
//! ([`mod@divide`]). In both, borders move by minimum cuts ([`mod@swap`]) toward where surfaces meet or touch
//! ([`contact`]), and that is taken if `E` falls. In the end faces are free that their surface does not
//! explain ([`mod@doubt`]). Segments ask besides whether pieces are patches of one smooth surface
//! ([`mod@smooth`]).

mod constants;
mod contact;
mod divide;
mod domain;
mod doubt;
mod grow;
mod labels;
mod marks;
mod merge;
mod pieces;
mod relabel;
mod seek;
mod smooth;
mod swap;

pub use constants::FREE_MISFIT;
pub use domain::Domain;
pub use labels::{Labelling, Piece, NONE};
pub use smooth::free_patches;

use constants::MOST_ROUNDS;

use crate::progress::Progress;
use crate::{memory, Result};

/// The labels of the faces of a `domain` that begin as `start` (negative: takes no part) and follow the
/// energy downhill.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn labelling(domain: &Domain<'_>, start: &[i32], progress: &Progress) -> Result<Labelling> {
    let labels = memory::gathered(start.iter().map(|&l| u32::try_from(l).unwrap_or(NONE)))?;
    let mut state = Labelling { labels, pieces: Vec::new() };
    state.fit_all(domain, progress)?;
    descend(domain, &mut state, progress)?;
    let mut has_left = memory::repeated(false, state.labels.len())?;
    divide::divide(domain, &mut state, &mut has_left, progress)?;
    doubt::doubt(domain, &mut state, &has_left, progress)?;
    Ok(state)
}

/// Follows the energy downhill from labels with surfaces.
fn descend(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    let mut energy = state.energy(domain);
    for _ in 0..MOST_ROUNDS {
        if progress.is_finishing() {
            break;
        }
        let before = state.copied()?;
        merge::merge(domain, state, progress)?;
        relabel::relabel(domain, state, progress)?;
        state.fit_all(domain, progress)?;
        let after = state.energy(domain);
        if after.is_nan() || after >= energy {
            // Fits are local: what they lose is not taken.
            if after > energy {
                *state = before;
            }
            break;
        }
        energy = after;
    }
    Ok(())
}
