//! Surfaces are sought where no surface explains the faces: they grow from the middle of what is not known,
//! and are taken where they lower the energy, those first that lower it most.

use super::constants::{GOING_ON, LEAST_DEPTH, LEAST_FOUND, STARTS, TRIES, UNLIMITED};
use super::grow::Grown;
use super::labels::{Labelling, Piece, NONE};
use super::marks::Marks;
use super::pieces::best;
use super::Domain;
use crate::mesh::vector::norm;
use crate::progress::Progress;
use crate::{memory, Result};

/// Gives the faces without a label, but for those that are `out`, to surfaces that are found one by one; what
/// is left is free, each connected piece by itself. Says whether the first tries find enough to go on.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn seek(
    domain: &Domain<'_>,
    state: &mut Labelling,
    out: &[bool],
    progress: &Progress,
) -> Result<bool> {
    let mut marks = Marks::new(domain.areas.len())?;
    let Some(found) = found(domain, &state.labels, out, &mut marks, progress)? else { return Ok(false) };
    take(domain, state, out, found)?;
    let is_open = |(label, out): (&u32, &bool)| *label == NONE && !*out;
    let mut open: Vec<bool> = memory::gathered(state.labels.iter().zip(out).map(is_open))?;
    for _ in 0..state.name_apart(domain, &mut open)? {
        memory::push(&mut state.pieces, Piece { side: 1.0, ..Piece::default() })?;
    }
    Ok(true)
}

/// Whether enough of the surfaces that are fitted to faces here and there go on beyond them; on most free
/// shapes they do not, and nothing is sought.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn goes_on(domain: &Domain<'_>, open: &[bool]) -> Result<bool> {
    let open: Vec<u32> = memory::sifted((0..open.len() as u32).filter(|&f| open[f as usize]))?;
    if open.is_empty() {
        return Ok(false);
    }
    let (mut marks, mut count) = (Marks::new(domain.areas.len())?, 0);
    for k in 0..TRIES {
        let f = open[(2 * k + 1) * open.len() / (2 * TRIES)];
        let seed = domain.nearest(&mut marks, f, STARTS[1])?;
        if let Some((surface, _)) = best(domain, &seed, &domain.samples(&seed)?, UNLIMITED)? {
            count += usize::from(domain.flood(&mut marks, &seed, &surface)?.len() >= 2 * STARTS[1]);
        }
    }
    Ok(count as f64 >= GOING_ON * TRIES as f64)
}

/// Surfaces that grow from the middle of what has no label; `None` where the first tries find little.
fn found(
    domain: &Domain<'_>,
    labels: &[u32],
    out: &[bool],
    marks: &mut Marks,
    progress: &Progress,
) -> Result<Option<Vec<Grown>>> {
    let mut known: Vec<bool> = memory::gathered(labels.iter().zip(out).map(|(l, out)| *l != NONE || *out))?;
    let open_area = |known: &[bool]| -> f64 {
        domain.areas.iter().zip(known).filter(|(_, known)| !**known).map(|(a, _)| norm(*a)).sum()
    };
    let total = open_area(&known);
    let mut found: Vec<Grown> = Vec::new();
    let (mut tries, mut before) = (0, total);
    while let Some(f) = domain.deepest(&known)? {
        progress.check()?;
        if progress.is_finishing() {
            break;
        }
        if tries == TRIES {
            let now = open_area(&known);
            if before == total && before - now < LEAST_FOUND[0] * total {
                return Ok(None);
            }
            if before - now < LEAST_FOUND[1] * total {
                break;
            }
            (tries, before) = (0, now);
        }
        tries += 1;
        let mut held: Option<Grown> = None;
        for most in STARTS {
            let seed = domain.nearest(marks, f, most)?;
            let grown = domain.grown(marks, &seed)?.filter(|grown| grown.gain > 0.0);
            if let Some(grown) = grown {
                if held.as_ref().is_none_or(|held| grown.gain > held.gain) {
                    held = Some(grown);
                }
            }
        }
        domain.nearest(marks, f, STARTS[0] / 2)?.iter().for_each(|&g| known[g as usize] = true);
        if let Some(held) = held {
            held.faces.iter().for_each(|&g| known[g as usize] = true);
            memory::push(&mut found, held)?;
        }
    }
    Ok(Some(found))
}

/// Gives faces to the surfaces that gain most by them.
fn take(domain: &Domain<'_>, state: &mut Labelling, out: &[bool], mut found: Vec<Grown>) -> Result<()> {
    found.sort_by(|a, b| a.gain.total_cmp(&b.gain));
    while let Some(mut top) = found.pop() {
        let all = top.faces.len();
        top.faces.retain(|&f| state.labels[f as usize] == NONE && !out[f as usize]);
        if top.faces.len() < all {
            top.gain = domain.gain(&top.faces, &top.surface);
            if top.gain > 0.0 {
                let place = found.partition_point(|other| other.gain <= top.gain);
                found.insert(place, top);
            }
            continue;
        }
        let name = state.pieces.len() as u32;
        top.faces.iter().for_each(|&f| state.labels[f as usize] = name);
        let piece = Piece { faces: top.faces, surface: Some(top.surface), side: 1.0, ..Piece::default() };
        memory::push(&mut state.pieces, piece)?;
    }
    Ok(())
}

impl Domain<'_> {
    /// The face that most edges part from what is `known`, if some do.
    fn deepest(&self, known: &[bool]) -> Result<Option<u32>> {
        let n = known.len() as u32;
        let mut depth = memory::repeated(NONE, known.len())?;
        let mut queue: Vec<u32> = memory::sifted((0..n).filter(|&f| known[f as usize]))?;
        queue.iter().for_each(|&f| depth[f as usize] = 0);
        let mut next = 0;
        while let Some(&f) = queue.get(next) {
            next += 1;
            for (_, g) in self.around(f as usize) {
                if depth[g] == NONE {
                    depth[g] = depth[f as usize] + 1;
                    memory::push(&mut queue, g as u32)?;
                }
            }
        }
        let has_area = |f: &u32| norm(self.areas[*f as usize]) > 0.0;
        let deepest = (0..n).filter(has_area).max_by_key(|&f| (depth[f as usize], n - f));
        Ok(deepest.filter(|&f| depth[f as usize] >= LEAST_DEPTH))
    }
}
