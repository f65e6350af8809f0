//! Neighbors that one surface explains become one piece, those first that lower the energy most.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::constants::{BORDER, JUDGED_BY};
use super::labels::{Labelling, Piece, NONE};
use super::pieces::best;
use super::Domain;
use crate::progress::Progress;
use crate::{memory, Result};

/// Merges as long as the energy falls.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn merge(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    let mut borders = borders(domain, &state.labels);
    let mut gains: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    let mut asked: Vec<(u32, u32)> = memory::gathered(borders.keys().copied())?;
    while !progress.is_finishing() {
        let found = asked.par_iter().map(|&pair| {
            progress.check()?;
            Ok((pair, judged(domain, state, pair, borders[&pair])?))
        });
        gains.extend(memory::all(memory::joined(found)?)?);
        let best = gains.iter().filter(|(_, gain)| **gain > 0.0).max_by(|a, b| a.1.total_cmp(b.1));
        let Some((&(a, b), _)) = best else { break };
        gains.remove(&(a, b));
        let joined = union(state, (a, b))?;
        let piece = Piece::of(domain, joined)?;
        let parts = state.pieces[a as usize].energy + state.pieces[b as usize].energy;
        let border = borders.get(&(a, b)).copied().unwrap_or(0.0);
        asked = Vec::new();
        if piece.energy < parts + border && piece.surface.is_some() {
            piece.faces.iter().for_each(|&f| state.labels[f as usize] = a);
            state.pieces[a as usize] = piece;
            state.pieces[b as usize] = Piece::default();
            let touched: Vec<((u32, u32), f64)> = borders
                .iter()
                .filter(|((x, y), _)| [*x, *y].iter().any(|l| *l == a || *l == b))
                .map(|(&pair, &length)| (pair, length))
                .collect();
            for ((x, y), length) in touched {
                borders.remove(&(x, y));
                gains.remove(&(x, y));
                let renamed = |l: u32| if l == b { a } else { l };
                let (x, y) = (renamed(x).min(renamed(y)), renamed(x).max(renamed(y)));
                if x != y {
                    *borders.entry((x, y)).or_insert(0.0) += length;
                }
            }
            asked.extend(borders.keys().filter(|(x, y)| *x == a || *y == a).copied());
        }
    }
    Ok(())
}

/// What the border of each pair of pieces costs.
fn borders(domain: &Domain<'_>, labels: &[u32]) -> BTreeMap<(u32, u32), f64> {
    let mut borders = BTreeMap::new();
    for h in domain.connectivity.edges() {
        let Some(mate) = domain.connectivity.mate(h) else { continue };
        let (a, b) = (labels[h / 3], labels[mate / 3]);
        if a != b && a != NONE && b != NONE {
            let length = domain.lengths[h / 3][h % 3] / domain.mean_edge;
            *borders.entry((a.min(b), a.max(b))).or_insert(0.0) += BORDER * length;
        }
    }
    borders
}

fn union(state: &Labelling, (a, b): (u32, u32)) -> Result<Vec<u32>> {
    let [first, second] = [a, b].map(|label| &state.pieces[label as usize].faces);
    let mut faces = memory::room(first.len() + second.len())?;
    faces.extend_from_slice(first);
    faces.extend_from_slice(second);
    faces.sort_unstable();
    Ok(faces)
}

/// By how much the energy would fall, about: surfaces are fitted to some of the points.
fn judged(domain: &Domain<'_>, state: &Labelling, pair: (u32, u32), border: f64) -> Result<f64> {
    let faces = union(state, pair)?;
    let samples = domain.samples(&faces)?;
    let limit = state.pieces[pair.0 as usize].energy + state.pieces[pair.1 as usize].energy + border;
    let thin = samples.thinned(JUDGED_BY)?;
    Ok(best(domain, &faces, &thin, limit)?.map_or(0.0, |(_, energy)| limit - energy))
}
