//! Pieces and their surfaces: the kind is the one with the least energy.

use rayon::prelude::*;

use super::constants::{ENOUGH, FREE_MISFIT, UNLIMITED};
use super::labels::{Labelling, Piece, NONE};
use super::marks::Marks;
use super::Domain;
use crate::progress::Progress;
use crate::surfaces::{fit, FittedSurface, Kind, Samples, Surface};
use crate::{memory, Result};

impl Piece {
    /// The piece of these faces on the surface that costs least, or free.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn of(domain: &Domain<'_>, faces: Vec<u32>) -> Result<Self> {
        let samples = domain.samples(&faces)?;
        let free = FREE_MISFIT * samples.total();
        Ok(match best(domain, &faces, &samples, free)? {
            Some((found, energy)) => {
                let (side, rms) = (samples.side(&found), samples.rms(&found));
                Self { faces, surface: Some(found), side, rms, energy, is_doubted: false, is_fitted: true }
            }
            None => Self { faces, side: 1.0, energy: free, is_fitted: true, ..Self::default() },
        })
    }

    /// The piece of these faces, which keeps the surface that it had where that costs less than another.
    fn again(domain: &Domain<'_>, faces: Vec<u32>, old: Self) -> Result<Self> {
        if old.is_fitted && old.faces == faces {
            return Ok(Self { is_doubted: false, ..old });
        }
        let mut piece = Self::of(domain, faces)?;
        if let Some(old) = &old.surface {
            let samples = domain.samples(&piece.faces)?;
            let kept = samples.cost(old, domain.sigma)
                + domain.strain(&piece.faces, old)
                + domain.kappa * old.kind().n_parameters() as f64;
            if kept < piece.energy {
                piece.surface = Some(*old);
                piece.energy = kept;
                (piece.side, piece.rms) = (samples.side(old), samples.rms(old));
            }
        }
        Ok(piece)
    }
}

/// The surface of `faces` with the least energy, and that energy, if it is under `limit`; `samples` are their
/// vertices, or some of them.
pub(super) fn best(
    domain: &Domain<'_>,
    faces: &[u32],
    samples: &Samples,
    limit: f64,
) -> Result<Option<(Surface, f64)>> {
    let thin = samples.thinned(ENOUGH)?;
    let price = |kind: Kind| domain.kappa * kind.n_parameters() as f64;
    let mut found: Option<(Kind, FittedSurface)> = None;
    let mut least = limit;
    for kind in Kind::ALL {
        // More parameters than that cannot pay, however well they fit.
        if price(kind) >= least {
            break;
        }
        let Some(fitted) = fit(kind, &thin, domain.sigma)? else { continue };
        let energy = fitted.cost + price(kind);
        let energy = if energy < least { energy + domain.strain(faces, &fitted.surface) } else { energy };
        if energy < least {
            (found, least) = (Some((kind, fitted)), energy);
        }
        // Noise alone costs half of one for each observation; what is left to gain is no more than chance.
        if fitted.cost <= 0.5 * thin.total() && energy <= least {
            break;
        }
    }
    let Some((kind, mut fitted)) = found else { return Ok(None) };
    if thin.len() < samples.len() {
        let Some(whole) = fit(kind, samples, domain.sigma)? else { return Ok(None) };
        fitted = whole;
        least = fitted.cost + price(kind) + domain.strain(faces, &fitted.surface);
    }
    Ok((least < limit).then_some((fitted.surface, least)))
}

impl Labelling {
    /// Fits the pieces with surfaces to some points of their faces, or of the faces inside.
    pub(super) fn fit_again(&mut self, domain: &Domain<'_>, inside: bool) -> Result<()> {
        self.regroup()?;
        let mut marks = Marks::new(domain.areas.len())?;
        for piece in self.pieces.iter_mut().filter(|p| !p.faces.is_empty() && p.surface.is_some()) {
            let faces =
                if inside { domain.inner(&mut marks, &piece.faces)? } else { memory::twin(&piece.faces)? };
            let samples = domain.samples(&faces)?.thinned(ENOUGH)?;
            if let Some((surface, _)) = best(domain, &faces, &samples, UNLIMITED)? {
                piece.surface = Some(surface);
            }
            piece.is_fitted = false;
        }
        Ok(())
    }

    /// Lists the faces of all pieces anew; those without have none.
    fn regroup(&mut self) -> Result<()> {
        self.pieces.iter_mut().for_each(|piece| piece.faces.clear());
        for (f, &label) in (0_u32..).zip(&self.labels).filter(|(_, label)| **label != NONE) {
            memory::push(&mut self.pieces[label as usize].faces, f)?;
        }
        Ok(())
    }

    /// Fits all pieces to their faces, and numbers them without gaps in the order of their first faces.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn fit_all(&mut self, domain: &Domain<'_>, progress: &Progress) -> Result<()> {
        let n = self.labels.iter().filter(|l| **l != NONE).map(|l| *l as usize + 1).max().unwrap_or(0);
        let mut names = memory::repeated(NONE, n)?;
        let mut members: Vec<Vec<u32>> = Vec::new();
        let mut old: Vec<Piece> = Vec::new();
        let mut before = std::mem::take(&mut self.pieces);
        for (f, label) in (0_u32..).zip(&mut self.labels).filter(|(_, label)| **label != NONE) {
            let name = &mut names[*label as usize];
            if *name == NONE {
                *name = members.len() as u32;
                memory::push(&mut members, Vec::new())?;
                memory::extend(&mut old, 1)?;
                old.push(before.get_mut(*label as usize).map(std::mem::take).unwrap_or_default());
            }
            *label = *name;
            memory::push(&mut members[*name as usize], f)?;
        }
        let again = |(faces, old): (Vec<u32>, Piece)| {
            progress.check()?;
            Piece::again(domain, faces, old)
        };
        self.pieces = memory::all(memory::joined(members.into_par_iter().zip(old).map(again))?)?;
        Ok(())
    }
}
