//! Neighbors that one surface explains become one piece, those first that lower the energy most.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::constants::{BORDER, FREE_MISFIT, GROWN, JUDGED_BY, NOISE_MISFIT};
use super::labels::{Labelling, Piece, NONE};
use super::pieces::best;
use super::Domain;
use crate::progress::Progress;
use crate::surfaces::{Kind, Surface};
use crate::{memory, Result};

/// What is known of two neighbors.
#[derive(Debug, Clone, Copy)]
struct Judged {
    /// By how much the energy would fall, about.
    gain: f64,
    /// How many faces both had.
    n_faces: usize,
    /// Whether neither has changed since.
    is_current: bool,
}

/// Merges as long as the energy falls.
///
/// A piece that has taken a small one in is hardly another, so what was known of it and its other neighbors
/// is asked again only once it matters: when they would be the next to merge, or the piece has another kind
/// of surface or [`GROWN`] times as many faces. Otherwise a side with a thousand small neighbors would be
/// compared with all of them a thousand times.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn merge(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    let mut borders = borders(domain, &state.labels);
    let mut known: BTreeMap<(u32, u32), Judged> = BTreeMap::new();
    let mut asked: Vec<(u32, u32)> = memory::gathered(borders.keys().copied())?;
    while !progress.is_finishing() {
        let found = asked.par_iter().map(|&pair| {
            progress.check()?;
            Ok((pair, judged(domain, state, pair, borders[&pair])?))
        });
        known.extend(memory::all(memory::joined(found)?)?);
        asked = Vec::new();
        let best = known.iter().filter(|(_, known)| known.gain > 0.0);
        let Some((&(a, b), judged)) = best.max_by(|a, b| a.1.gain.total_cmp(&b.1.gain)) else { break };
        if !judged.is_current {
            asked.push((a, b));
            continue;
        }
        known.remove(&(a, b));
        let joined = union(state, (a, b))?;
        let piece = Piece::of(domain, joined)?;
        let parts = state.pieces[a as usize].energy + state.pieces[b as usize].energy;
        let border = borders.get(&(a, b)).copied().unwrap_or(0.0);
        if piece.energy < parts + border && piece.surface.is_some() {
            let kind = |piece: &Piece| piece.surface.as_ref().map(Surface::kind);
            let is_like = |label: u32| kind(&state.pieces[label as usize]) == kind(&piece);
            let are_like = [a, b].map(is_like);
            let n_faces = piece.faces.len();
            piece.faces.iter().for_each(|&f| state.labels[f as usize] = a);
            state.pieces[a as usize] = piece;
            state.pieces[b as usize] = Piece::default();
            let touched: Vec<((u32, u32), f64)> = borders
                .iter()
                .filter(|((x, y), _)| [*x, *y].iter().any(|l| *l == a || *l == b))
                .map(|(&pair, &length)| (pair, length))
                .collect();
            let mut before: BTreeMap<(u32, u32), Option<Judged>> = BTreeMap::new();
            for ((x, y), length) in touched {
                borders.remove(&(x, y));
                let old = known.remove(&(x, y));
                let is_like = are_like[usize::from(x == b || y == b)];
                let renamed = |l: u32| if l == b { a } else { l };
                let pair = (renamed(x).min(renamed(y)), renamed(x).max(renamed(y)));
                if pair.0 != pair.1 {
                    *borders.entry(pair).or_insert(0.0) += length;
                    // A neighbor of both has a longer border than what is known of it says.
                    let is_first = !before.contains_key(&pair);
                    before.insert(pair, old.filter(|_| is_first && is_like));
                }
            }
            for (pair, old) in before {
                let other = if pair.0 == a { pair.1 } else { pair.0 };
                let n_now = n_faces + state.pieces[other as usize].faces.len();
                match old.filter(|old| (n_now as f64) < GROWN * old.n_faces as f64) {
                    Some(old) => drop(known.insert(pair, Judged { is_current: false, ..old })),
                    None => asked.push(pair),
                }
            }
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

impl Domain<'_> {
    /// Whether a piece is free although it would pay to have a surface of the dearest kind, were there one
    /// beside which its vertices are off by noise alone. Then none explains it with a neighbor either.
    fn is_none_for(&self, piece: &Piece) -> bool {
        let dearest = self.kappa * Kind::Torus.n_parameters() as f64;
        piece.surface.is_none() && (1.0 - NOISE_MISFIT / FREE_MISFIT) * piece.energy > dearest
    }
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
fn judged(domain: &Domain<'_>, state: &Labelling, pair: (u32, u32), border: f64) -> Result<Judged> {
    if [pair.0, pair.1].iter().any(|label| domain.is_none_for(&state.pieces[*label as usize])) {
        let n_faces = [pair.0, pair.1].iter().map(|label| state.pieces[*label as usize].faces.len()).sum();
        return Ok(Judged { gain: 0.0, n_faces, is_current: true });
    }
    let faces = union(state, pair)?;
    let samples = domain.samples(&faces)?;
    let limit = state.pieces[pair.0 as usize].energy + state.pieces[pair.1 as usize].energy + border;
    let thin = samples.thinned(JUDGED_BY)?;
    let gain = best(domain, &faces, &thin, limit)?.map_or(0.0, |(_, energy)| limit - energy);
    Ok(Judged { gain, n_faces: faces.len(), is_current: true })
}
