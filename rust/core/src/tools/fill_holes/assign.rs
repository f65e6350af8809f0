//! Which of the parts around a hole goes on in which faces of its patch.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::constants::{FIXED_WEIGHT, RIM_BORDER_COST, SWEEPS};
use super::parts::{SmoothParts, NONE};
use super::region::Region;
use crate::memory;
use crate::mesh::vector::{area_vector, centroid, distance, dot, norm};
use crate::ordered::Ordered;
use crate::{Error, Result};

/// The part of every face of the patch.
///
/// Parts flood the patch from the rim, the face that fits best first (Cohen-Steiner et al. 2004), so that
/// each stays joined to what it continues; then faces change sides where that makes the borders shorter than
/// it makes the fit worse.
pub(super) fn assign(region: &Region, parts: &SmoothParts, edge: f64) -> Result<Vec<u32>> {
    let mut labels = memory::repeated(NONE, region.mesh.n_faces() - region.n_outer)?;
    flood(region, parts, edge, &mut labels)?;
    shorten(region, parts, edge, &mut labels);
    keep_joined(region, parts, &mut labels)?;
    flood(region, parts, edge, &mut labels)?;
    Ok(labels)
}

/// How badly face `f` fits to `part`: squared distance in edge lengths, and direction,
/// where a right angle counts as one edge.
fn misfit(region: &Region, parts: &SmoothParts, edge: f64, f: u32, part: u32) -> f64 {
    let Some(face) = region.mesh.face(f) else { return 0.0 };
    let model = &parts.models[part as usize];
    let corners = region.mesh.corners(face);
    let (mut squares, mut total) = (0.0, 0.0);
    for (v, p) in face.into_iter().zip(corners) {
        let weight = if region.is_anchor(v) { FIXED_WEIGHT } else { 1.0 };
        squares += weight * (model.at(p).0 / edge).powi(2);
        total += weight;
    }
    let area = area_vector(corners);
    let cosine = if norm(area) > 0.0 { dot(area, model.at(centroid(corners)).1) / norm(area) } else { 1.0 };
    squares / total + (1.0 - cosine)
}

/// For each edge of a face of the patch: its ends and the face beyond.
fn across(region: &Region, f: u32) -> impl Iterator<Item = ([u32; 2], u32)> + '_ {
    let face = region.mesh.face(f).unwrap_or_default();
    (0..3).filter_map(move |i| {
        let ends = [face[i], face[(i + 1) % 3]];
        let wings = region.mesh.wings(ends[0], ends[1])?;
        Some((ends, if wings.faces[0] == f { wings.faces[1] } else { wings.faces[0] }))
    })
}

/// The part of a face, in or around the patch.
fn part_of(region: &Region, parts: &SmoothParts, labels: &[u32], f: u32) -> u32 {
    match (f as usize).checked_sub(region.n_outer) {
        Some(place) => labels[place],
        None => parts.of_face[f as usize],
    }
}

/// Gives every face without a part that of a neighbor, best fits first.
fn flood(region: &Region, parts: &SmoothParts, edge: f64, labels: &mut [u32]) -> Result<()> {
    let first = region.n_outer as u32;
    let mut heap = BinaryHeap::new();
    let offer = |heap: &mut BinaryHeap<_>, f: u32, part: u32| {
        memory::extend_heap(heap, 1)?;
        heap.push(Reverse((Ordered(misfit(region, parts, edge, f, part)), f, part)));
        Ok::<(), Error>(())
    };
    for f in (first..region.mesh.n_faces() as u32).filter(|&f| labels[(f - first) as usize] == NONE) {
        for (_, g) in across(region, f) {
            let part = part_of(region, parts, labels, g);
            if part != NONE {
                offer(&mut heap, f, part)?;
            }
        }
    }
    while let Some(Reverse((_, f, part))) = heap.pop() {
        let label = &mut labels[(f - first) as usize];
        if *label != NONE {
            continue;
        }
        *label = part;
        for (_, g) in across(region, f) {
            if g >= first && labels[(g - first) as usize] == NONE {
                offer(&mut heap, g, part)?;
            }
        }
    }
    Ok(())
}

fn shorten(region: &Region, parts: &SmoothParts, edge: f64, labels: &mut [u32]) {
    let first = region.n_outer as u32;
    for _ in 0..SWEEPS {
        let mut changed = false;
        for f in first..region.mesh.n_faces() as u32 {
            let here = labels[(f - first) as usize];
            let around: Vec<([u32; 2], u32)> =
                across(region, f).map(|(ends, g)| (ends, part_of(region, parts, labels, g))).collect();
            let area = norm(region.mesh.area_vector(f)) / edge;
            let border = |ends: [u32; 2], here: u32, there: u32| {
                let points = ends.map(|v| region.mesh.position(v));
                let is_on = |part: u32| part != NONE && points.iter().all(|&p| parts.has(part, p, edge));
                let fixed = ends.iter().all(|&v| region.is_anchor(v)) && is_on(here) && is_on(there);
                distance(points[0], points[1]) * if fixed { RIM_BORDER_COST } else { 1.0 }
            };
            let cost = |part: u32| {
                let others = around.iter().filter(|(_, other)| *other != part);
                let length: f64 = others.map(|&(ends, other)| border(ends, part, other)).sum();
                length + area * misfit(region, parts, edge, f, part)
            };
            let mut best = (cost(here), here);
            for &(_, part) in around.iter().filter(|(_, part)| *part != NONE && *part != here) {
                let other = cost(part);
                if other < best.0 - 1e-9 * edge {
                    best = (other, part);
                }
            }
            if best.1 != here {
                labels[(f - first) as usize] = best.1;
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

/// Takes their part from faces that are not joined to the faces around the patch that have it.
fn keep_joined(region: &Region, parts: &SmoothParts, labels: &mut [u32]) -> Result<()> {
    let first = region.n_outer as u32;
    let mut joined = memory::repeated(false, labels.len())?;
    let is_joined = |&f: &u32| {
        let part = labels[(f - first) as usize];
        across(region, f).any(|(_, g)| g < first && parts.of_face[g as usize] == part)
    };
    let mut front = memory::sifted((first..region.mesh.n_faces() as u32).filter(is_joined))?;
    front.iter().for_each(|&f| joined[(f - first) as usize] = true);
    while let Some(f) = front.pop() {
        for (_, g) in across(region, f) {
            if g >= first
                && !joined[(g - first) as usize]
                && labels[(g - first) as usize] == labels[(f - first) as usize]
            {
                joined[(g - first) as usize] = true;
                memory::push(&mut front, g)?;
            }
        }
    }
    labels.iter_mut().zip(joined).filter(|(_, joined)| !joined).for_each(|(label, _)| *label = NONE);
    Ok(())
}

/// The edges at the patch between two parts, smaller vertex first, ascending.
pub(super) fn borders(region: &Region, parts: &SmoothParts, labels: &[u32]) -> Result<Vec<[u32; 2]>> {
    let part = |f: u32| part_of(region, parts, labels, f);
    let mut edges = region.mesh.edges()?;
    edges.retain(|&[a, b]| {
        region.mesh.wings(a, b).is_some_and(|wings| {
            wings.faces.iter().any(|&f| region.is_patch(f)) && part(wings.faces[0]) != part(wings.faces[1])
        })
    });
    Ok(edges)
}

/// The parts that meet at every vertex, ascending: of the patch and of the faces around it.
pub(super) fn parts_at(region: &Region, parts: &SmoothParts, labels: &[u32], v: u32) -> Vec<u32> {
    let faces = region.mesh.faces_of(v).iter();
    let mut found: Vec<u32> =
        faces.map(|&f| part_of(region, parts, labels, f)).filter(|&part| part != NONE).collect();
    found.sort_unstable();
    found.dedup();
    found
}
