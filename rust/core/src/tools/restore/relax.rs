//! Vertices move within their surfaces and curves until no triangle is folded: noise along a surface folds
//! triangles that lie on it.

use super::constants::{MOST_ROUNDS, THINNED};
use super::place::{surfaces, Placement};
use crate::labelling::{Domain, Labelling, NONE};
use crate::mesh::vector::{add, centroid, distance, quality, scale, Point};
use crate::mesh::{triangle, EdgeKind};
use crate::progress::Progress;
use crate::shape_guard::{is_thinned, is_turned};
use crate::surfaces::meeting;
use crate::{memory, Result};

/// Relaxes around folded faces and slivers; returns how many folded ones are left.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn relax(
    domain: &Domain<'_>,
    state: &Labelling,
    placement: &mut Placement,
    progress: &Progress,
) -> Result<usize> {
    let n = placement.points.len();
    let mut is_rim = memory::repeated(false, n)?;
    for h in 0..domain.connectivity.n_halfedges() {
        if domain.connectivity.kind(h) != EdgeKind::Interior {
            is_rim[domain.connectivity.tail(h) as usize] = true;
            is_rim[domain.connectivity.head(h) as usize] = true;
        }
    }
    let slides =
        |v: usize, placement: &Placement| placement.moves[v] && !is_rim[v] && !placement.on[v].is_empty();
    let mut active = memory::repeated(false, n)?;
    // Once for each vertex, not for each of its faces: many may meet there.
    let mut is_spread = memory::repeated(false, n)?;
    for _ in 0..MOST_ROUNDS {
        progress.check()?;
        let faces = 0..state.labels.len();
        let bad: Vec<usize> = memory::sifted(faces.filter(|&f| is_bad(domain, state, placement, f)))?;
        if bad.is_empty() || progress.is_finishing() {
            break;
        }
        for f in bad {
            for v in domain.connectivity.faces()[f] {
                active[v as usize] = true;
                if !std::mem::replace(&mut is_spread[v as usize], true) {
                    neighbors(domain, v)?.into_iter().for_each(|w| active[w as usize] = true);
                }
            }
        }
        for (v, _) in active.iter().enumerate().filter(|(_, is_active)| **is_active) {
            if !slides(v, placement) {
                continue;
            }
            if let Some(point) = relaxed(domain, state, placement, v)? {
                placement.points[v] = point;
            }
        }
    }
    Ok((0..state.labels.len()).filter(|&f| is_folded(domain, state, placement, f)).count())
}

fn corners(domain: &Domain<'_>, points: &[Point], f: usize) -> [Point; 3] {
    domain.connectivity.faces()[f].map(|v| points[v as usize])
}

fn is_folded(domain: &Domain<'_>, state: &Labelling, placement: &Placement, f: usize) -> bool {
    let label = state.labels[f];
    if label == NONE {
        return false;
    }
    let piece = &state.pieces[label as usize];
    let Some(surface) = &piece.surface else { return false };
    // What had no area has no side to lie on.
    if triangle::is_degenerate(domain.lengths[f]) {
        return false;
    }
    let corners = corners(domain, &placement.points, f);
    let normal = scale(surface.distance(centroid(corners)).1, piece.side);
    is_turned(corners, normal)
}

fn is_bad(domain: &Domain<'_>, state: &Labelling, placement: &Placement, f: usize) -> bool {
    let has_surface = state.pieces.get(state.labels[f] as usize).is_some_and(|piece| piece.surface.is_some());
    has_surface
        && (is_folded(domain, state, placement, f)
            || is_thinned(
                quality(corners(domain, &placement.points, f)),
                THINNED * quality(corners(domain, domain.positions, f)),
            ))
}

/// The vertices that `v` has an edge with, ascending.
fn neighbors(domain: &Domain<'_>, v: u32) -> Result<Vec<u32>> {
    let corners = domain.faces_at(v).iter().flat_map(|&f| domain.connectivity.faces()[f as usize]);
    let mut around: Vec<u32> = memory::sifted(corners.filter(|&w| w != v))?;
    around.sort_unstable();
    around.dedup();
    Ok(around)
}

/// The middle of the neighbors of `v` on its surface, or along its curve, taken back there, if that is within
/// reach.
fn relaxed(domain: &Domain<'_>, state: &Labelling, placement: &Placement, v: usize) -> Result<Option<Point>> {
    let own = &placement.on[v];
    if own.len() > 2 {
        return Ok(None);
    }
    let is_curve = |w: u32| {
        // Of the two, a hub with thousands of faces is not the one to look through.
        let (few, other) = if domain.faces_at(w).len() < domain.faces_at(v as u32).len() {
            (w, v as u32)
        } else {
            (v as u32, w)
        };
        let has = |label: u32| {
            let faces = domain.faces_at(few).iter().map(|&f| f as usize);
            faces
                .filter(|&f| domain.connectivity.faces()[f].contains(&other))
                .any(|f| state.labels[f] == label)
        };
        own.iter().all(|&label| has(label) && placement.on[w as usize].contains(&label))
    };
    let mut around = neighbors(domain, v as u32)?;
    around.retain(|&w| own.len() == 1 || is_curve(w));
    if around.len() < 2 {
        return Ok(None);
    }
    let sum = around.iter().fold([0.0; 3], |sum, &w| add(sum, placement.points[w as usize]));
    let middle = scale(sum, 1.0 / around.len() as f64);
    let point = meeting(&surfaces(state, own), middle, placement.reach);
    Ok(point.filter(|&point| distance(point, domain.positions[v]) <= placement.reach))
}
