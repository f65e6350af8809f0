//! Free pieces that several surfaces explain are divided: a fillet and the plane that it is tangent to have no crease between
//! them.

use std::collections::VecDeque;

use super::pieces::best;
use super::{Domain, Labelling, Piece, FREE_MISFIT, NONE};
use crate::progress::Progress;
use crate::surfaces::{misfit, Surface};
use crate::Result;

/// Faces of a patch that surfaces are tried on: few and many, since narrow fillets are hidden by large patches, and noise hides
/// the curvature of small ones.
const PATCHES: [usize; 3] = [24, 80, 300];

/// Patches for each size and piece; large enough that a surface of a tenth of the piece is missed once in a thousand times.
const SEEDS: usize = 64;

/// How far, in standard deviations, the corners of a face may be off a surface that grows over it.
const GROWN: f64 = 3.0;

/// Divides free pieces as long as a surface explains a part of one for less than it costs free.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn split(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    let mut open: Vec<u32> = (0..state.pieces.len() as u32).filter(|&k| is_free(state, k)).collect();
    while let Some(k) = open.pop() {
        let candidates = candidates(domain, state, k, progress)?;
        divide(domain, state, k, candidates, progress)?;
    }
    Ok(())
}

fn is_free(state: &Labelling, k: u32) -> bool {
    state.pieces[k as usize].surface.is_none()
}

/// Surfaces of patches all over the piece, each grown once.
fn candidates(domain: &Domain<'_>, state: &Labelling, k: u32, progress: &Progress) -> Result<Vec<Surface>> {
    let faces = &state.pieces[k as usize].faces;
    let mut found = Vec::new();
    for size in PATCHES.into_iter().filter(|size| *size <= faces.len()) {
        let step = (faces.len() / SEEDS).max(1);
        for &seed in faces.iter().step_by(step) {
            progress.check()?;
            let patch = grown(domain, state, seed, size, |_| true);
            let samples = domain.samples(&patch);
            let limit = FREE_MISFIT * samples.total();
            found.extend(best(domain, &samples, limit).map(|(surface, _)| (surface, seed)));
        }
    }
    Ok(found.into_iter().map(|(surface, _)| surface).collect())
}

/// The faces around `seed` with its label that `fits`, the nearest first, so many at most.
fn grown(domain: &Domain<'_>, state: &Labelling, seed: u32, most: usize, fits: impl Fn(usize) -> bool) -> Vec<u32> {
    let label = state.labels[seed as usize];
    let mut seen = std::collections::HashSet::from([seed]);
    let mut queue = VecDeque::from([seed]);
    let mut faces = Vec::new();
    while let Some(f) = queue.pop_front() {
        faces.push(f);
        if faces.len() >= most {
            break;
        }
        for (_, g) in domain.around(f as usize) {
            if state.labels[g] == label && fits(g) && seen.insert(g as u32) {
                queue.push_back(g as u32);
            }
        }
    }
    faces
}

/// The largest connected part of a free piece on a surface.
fn largest_part(domain: &Domain<'_>, state: &Labelling, k: u32, surface: &Surface) -> Vec<u32> {
    let on = |f: usize| {
        let corners = domain.connectivity.faces()[f];
        corners.iter().all(|&v| surface.distance(domain.positions[v as usize]).0.abs() <= GROWN * domain.sigma)
    };
    let mut seen = std::collections::HashSet::new();
    let mut largest = Vec::new();
    for &seed in &state.pieces[k as usize].faces {
        if state.labels[seed as usize] != k || seen.contains(&seed) || !on(seed as usize) {
            continue;
        }
        let part = grown(domain, state, seed, usize::MAX, on);
        seen.extend(part.iter().copied());
        if part.len() > largest.len() {
            largest = part;
        }
    }
    largest
}

/// How much a surface saves on a free piece, whatever hangs together: an upper bound for [`largest_part`].
fn saving(domain: &Domain<'_>, state: &Labelling, k: u32, surface: &Surface) -> f64 {
    let faces = state.pieces[k as usize].faces.iter().filter(|f| state.labels[**f as usize] == k);
    let each = faces.map(|&f| {
        let corners = domain.connectivity.faces()[f as usize];
        corners
            .iter()
            .map(|&v| {
                let off = misfit(surface.distance(domain.positions[v as usize]).0, domain.sigma);
                domain.share(f as usize, v) * (FREE_MISFIT - off).max(0.0)
            })
            .sum::<f64>()
    });
    each.sum::<f64>() - domain.kappa * surface.kind().n_parameters() as f64
}

/// Takes parts off piece `k`, the one first that saves most.
fn divide(
    domain: &Domain<'_>,
    state: &mut Labelling,
    k: u32,
    mut candidates: Vec<Surface>,
    progress: &Progress,
) -> Result<()> {
    loop {
        progress.check()?;
        let mut savings: Vec<(f64, Surface)> =
            candidates.iter().map(|surface| (saving(domain, state, k, surface), *surface)).collect();
        savings.retain(|(saving, _)| *saving > 0.0);
        savings.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut taken = false;
        // The bound may be far off where a surface crosses the piece in many places.
        for (_, surface) in savings.iter().take(8) {
            let mut part = largest_part(domain, state, k, surface);
            part.sort_unstable();
            let piece = Piece::of(domain, part);
            if piece.surface.is_none() || piece.energy >= FREE_MISFIT * domain.samples(&piece.faces).total() {
                continue;
            }
            let label = state.pieces.len() as u32;
            piece.faces.iter().for_each(|&f| state.labels[f as usize] = label);
            state.pieces.push(piece);
            taken = true;
            break;
        }
        if !taken {
            break;
        }
        candidates = savings.into_iter().map(|(_, surface)| surface).collect();
    }
    let labels = &state.labels;
    let left: Vec<u32> = state.pieces[k as usize].faces.iter().copied().filter(|f| labels[*f as usize] == k).collect();
    state.pieces[k as usize] = if left.is_empty() { Piece::default() } else { Piece::of(domain, left) };
    debug_assert!(state.labels.iter().all(|l| *l == NONE || (*l as usize) < state.pieces.len()));
    Ok(())
}
