//! Two facets of a shape as one: which loops are left, and which corners vanish.

use std::collections::{BTreeMap, HashSet};

use super::shape::{sides, Facet, Shape};
use super::verdict::on_line;
use crate::mesh::vector::{distance, Point};
use crate::remesh::closest::closest_on_segment;

/// The loops that facets have once two of them are one: of that first, then of those around it that lose
/// corners.
pub(super) type Joined = Vec<(u32, Vec<Vec<u32>>)>;

/// Joins facets `p` and `q`, if every loop keeps three corners and none meets itself, no side is there
/// twice, and the corners shared with another facet lie on one line. Corners between two facets vanish, and
/// those of one alone that are no farther than `tolerance` from the line. `at` are the facets at each corner.
pub(super) fn joined(shape: &Shape, at: &[Vec<u32>], [p, q]: [u32; 2], tolerance: f64) -> Option<Joined> {
    let [first, second] = [p, q].map(|k| &shape.facets[k as usize]);
    let before: HashSet<[u32; 2]> = first.sides().chain(second.sides()).collect();
    let mut all: Joined = vec![(p, border(first, second, &before)?)];
    let of_both: HashSet<u32> = first.corners().collect();
    for c in second.corners().filter(|c| of_both.contains(c)) {
        let others: Vec<u32> = at[c as usize].iter().copied().filter(|k| *k != p && *k != q).collect();
        let Some([a, b]) = beside(&all[0].1, c) else { continue };
        match others[..] {
            [] => {
                let [here, from, to] = [c, a, b].map(|c| shape.home(c));
                let is_near = distance(here, closest_on_segment(here, from, to)) <= tolerance;
                let ring = all[0].1.iter_mut().find(|ring| ring.contains(&c))?;
                if is_near && ring.len() > 3 && !shape.corners[c as usize].is_fixed {
                    ring.retain(|corner| *corner != c);
                }
            }
            [k] => {
                let place = all.iter().position(|(other, _)| *other == k).unwrap_or(all.len());
                if place == all.len() {
                    all.push((k, shape.facets[k as usize].loops.clone()));
                }
                if beside(&all[place].1, c) == Some([b, a]) {
                    [0, place].into_iter().for_each(|i| without(&mut all[i].1, c));
                }
            }
            _ => {}
        }
    }
    let has_corners = all.iter().flat_map(|(_, loops)| loops).all(|ring| ring.len() >= 3);
    (has_corners && is_new(shape, at, &all, q, &before) && meets_on_lines(shape, at, &all[0].1, [p, q]))
        .then_some(all)
}

/// The loops around two facets, of whose `sides` those that both have are gone.
fn border(first: &Facet, second: &Facet, sides: &HashSet<[u32; 2]>) -> Option<Vec<Vec<u32>>> {
    let mut next = BTreeMap::new();
    for [a, b] in first.sides().chain(second.sides()).filter(|[a, b]| !sides.contains(&[*b, *a])) {
        if next.insert(a, b).is_some() {
            return None;
        }
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let (mut ring, mut c) = (Vec::new(), start);
        while let Some(after) = next.remove(&c) {
            ring.push(c);
            c = after;
        }
        if c != start {
            return None;
        }
        loops.push(ring);
    }
    (!loops.is_empty()).then_some(loops)
}

/// The corners before and after one.
fn beside(loops: &[Vec<u32>], c: u32) -> Option<[u32; 2]> {
    loops.iter().find_map(|ring| {
        let (i, n) = (ring.iter().position(|corner| *corner == c)?, ring.len());
        Some([ring[(i + n - 1) % n], ring[(i + 1) % n]])
    })
}

fn without(loops: &mut [Vec<u32>], c: u32) {
    loops.iter_mut().for_each(|ring| ring.retain(|corner| *corner != c));
}

/// Whether no side that was not there before is one of another facet as well.
fn is_new(shape: &Shape, at: &[Vec<u32>], all: &Joined, gone: u32, before: &HashSet<[u32; 2]>) -> bool {
    let is_changed = |k: &u32| *k == gone || all.iter().any(|(other, _)| other == k);
    let fresh = all[0].1.iter().flat_map(|ring| sides(ring)).filter(|side| !before.contains(side));
    fresh.into_iter().all(|[a, b]| {
        let mut others = at[a as usize].iter().filter(|k| !is_changed(k));
        let is_taken =
            |k: &u32| shape.facets[*k as usize].sides().any(|side| side == [a, b] || side == [b, a]);
        let n_changed = all.iter().flat_map(|(_, loops)| loops).flat_map(|ring| sides(ring));
        let n_along = n_changed.filter(|side| *side == [a, b] || *side == [b, a]).count();
        n_along <= 2 && !others.any(is_taken)
    })
}

/// Whether the corners shared with every other facet lie on one line.
fn meets_on_lines(shape: &Shape, at: &[Vec<u32>], loops: &[Vec<u32>], own: [u32; 2]) -> bool {
    let mut met: BTreeMap<u32, Vec<Point>> = BTreeMap::new();
    for &c in loops.iter().flatten() {
        for &k in at[c as usize].iter().filter(|k| !own.contains(k)) {
            met.entry(k).or_default().push(shape.home(c));
        }
    }
    met.values().all(|points| points.len() < 3 || on_line(points))
}
