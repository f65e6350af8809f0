//! What is done about facets that do not come out sound: ridges that turned around become corners, and facets
//! are divided along a diagonal.

use std::collections::HashSet;

use super::constants::TRIES;
use super::faces::Faces;
use super::moments::Moments;
use super::shape::{sides, Corner, Facet, Shape};
use super::triangulation::triangles;
use crate::mesh::vector::{between, cross, distance, dot, sub};
use crate::ordered::Ordered;
use crate::{memory, Result};

/// Repairs `faulty` facets, as many as do not touch each other; returns whether anything was done.
pub(super) fn repair(shape: &mut Shape, faces: &mut Faces<'_>, faulty: &[u32]) -> Result<bool> {
    let mut touched: HashSet<u32> = HashSet::new();
    let mut gone = Vec::new();
    let mut is_repaired = false;
    for &k in faulty {
        if shape.facets[k as usize].corners().any(|c| touched.contains(&c)) {
            continue;
        }
        is_repaired = true;
        if let Some((around, vanished)) = contracted(shape, k, &touched)? {
            memory::extend_set(&mut touched, around.len())?;
            touched.extend(around);
            memory::extend(&mut gone, 1)?;
            gone.extend(vanished);
        } else {
            let facet = &shape.facets[k as usize];
            memory::extend_set(&mut touched, facet.corners().count())?;
            touched.extend(facet.corners());
            if !divide(shape, faces, k)? {
                hold(shape, k);
            }
        }
    }
    gone.sort_unstable();
    for k in gone.into_iter().rev() {
        remove(shape, faces, k)?;
    }
    faces.fit(shape)?;
    Ok(is_repaired)
}

/// Makes a corner of the first ridge of a facet that has turned around and can become one, away from what was
/// touched: the corners around, and the facet that vanishes.
fn contracted(
    shape: &mut Shape,
    facet: u32,
    touched: &HashSet<u32>,
) -> Result<Option<(Vec<u32>, Option<u32>)>> {
    for ends in turned_ridges(shape, facet)? {
        let around = around(shape, ends)?;
        if around.iter().any(|c| touched.contains(c)) {
            continue;
        }
        if let Some(vanished) = contract(shape, ends)? {
            return Ok(Some((around, vanished)));
        }
    }
    Ok(None)
}

/// The sides of a facet that run the other way than on the mesh, shortest first.
fn turned_ridges(shape: &Shape, facet: u32) -> Result<Vec<[u32; 2]>> {
    let is_turned = |&[a, b]: &[u32; 2]| {
        dot(sub(shape.point(b), shape.point(a)), sub(shape.home(b), shape.home(a))) < 0.0
            && !(shape.corners[a as usize].is_fixed || shape.corners[b as usize].is_fixed)
    };
    let length = |[a, b]: [u32; 2]| Ordered(distance(shape.home(a), shape.home(b)));
    let turned = (0..).zip(shape.facets[facet as usize].sides().filter(is_turned));
    let mut turned: Vec<(Ordered, u32, [u32; 2])> =
        memory::sifted(turned.map(|(i, side)| (length(side), i, side)))?;
    turned.sort_unstable();
    Ok(memory::gathered(turned.into_iter().map(|(_, _, side)| side))?)
}

/// The corners of all facets at two of them.
fn around(shape: &Shape, ends: [u32; 2]) -> Result<Vec<u32>> {
    let at = |facet: &&Facet| facet.corners().any(|c| ends.contains(&c));
    Ok(memory::sifted(shape.facets.iter().filter(at).flat_map(Facet::corners))?)
}

/// Makes one corner of the ends of a ridge, if every facet keeps three corners, but for one that may vanish
/// where another takes its faces: returned.
fn contract(shape: &mut Shape, [a, b]: [u32; 2]) -> Result<Option<Option<u32>>> {
    let mut vanishing = None;
    for (k, facet) in (0..).zip(&shape.facets) {
        let n_loops =
            facet.loops.iter().filter(|corners| corners.contains(&a) || corners.contains(&b)).count();
        if n_loops > 1 {
            return Ok(None);
        }
        for corners in facet.loops.iter().filter(|corners| corners.contains(&a) && corners.contains(&b)) {
            if !sides(corners).any(|side| side == [a, b] || side == [b, a]) {
                return Ok(None);
            }
            if corners.len() == 3 {
                if facet.loops.len() > 1 || vanishing.is_some() {
                    return Ok(None);
                }
                vanishing = Some(k);
            }
        }
    }
    if let Some(k) = vanishing {
        let at_ends = |facet: &Facet| !facet.is_held && facet.corners().any(|c| c == a || c == b);
        if !(0..).zip(&shape.facets).any(|(j, facet)| j != k && at_ends(facet)) {
            return Ok(None);
        }
        // The facets behind its other two sides meet along one ridge then: not if they meet already.
        let side_of =
            |[from, to]: [u32; 2]| shape.facets.iter().find(|f| f.sides().any(|side| side == [to, from]));
        let others =
            shape.facets[k as usize].sides().filter(|side| !(side.contains(&a) && side.contains(&b)));
        let behind: Vec<&Facet> = memory::sifted(others.filter_map(side_of))?;
        if let [p, q] = behind[..] {
            let of_first: HashSet<[u32; 2]> = memory::distinct(p.sides())?;
            if std::ptr::eq(p, q) || q.sides().any(|[from, to]| of_first.contains(&[to, from])) {
                return Ok(None);
            }
        }
    }
    // Whatever is next to both ends must be the third corner of a triangle that vanishes:
    // its sides become one otherwise.
    let beside = |c: u32| {
        let sides = shape.facets.iter().flat_map(Facet::sides).filter(move |side| side.contains(&c));
        memory::distinct(sides.flatten().filter(move |&other| other != c))
    };
    let third = |k: u32| shape.facets[k as usize].corners().find(|c| *c != a && *c != b);
    if beside(a)?.intersection(&beside(b)?).any(|&c| vanishing.and_then(third) != Some(c)) {
        return Ok(None);
    }
    let other = shape.corners[b as usize];
    let corner = &mut shape.corners[a as usize];
    match (corner.across, other.across) {
        (None, Some(_)) => *corner = Corner { firmness: corner.firmness, ..other },
        (Some(_), None) => {}
        _ => {
            corner.point = between(corner.point, other.point, 0.5);
            corner.home = between(corner.home, other.home, 0.5);
        }
    }
    for corners in shape.facets.iter_mut().flat_map(|facet| &mut facet.loops) {
        corners.iter_mut().filter(|c| **c == b).for_each(|c| *c = a);
        corners.dedup();
        if corners.len() > 1 && corners[0] == corners[corners.len() - 1] {
            corners.pop();
        }
    }
    Ok(Some(vanishing))
}

/// Takes a facet away; its faces go to the neighbor whose plane is nearest.
fn remove(shape: &mut Shape, faces: &mut Faces<'_>, k: u32) -> Result<()> {
    let corners: HashSet<u32> = memory::distinct(shape.facets[k as usize].corners())?;
    let is_near = |facet: &Facet| !facet.is_held && facet.corners().any(|c| corners.contains(&c));
    let near = (0..).zip(&shape.facets).filter(|(j, facet)| *j != k && is_near(facet));
    let near: Vec<u32> = memory::sifted(near.map(|(j, _)| j))?;
    for (label, &center) in faces.labels.iter_mut().zip(&faces.scan.centers).filter(|(label, _)| **label == k)
    {
        let off = |j: u32| shape.facets[j as usize].plane.height(center).abs();
        if let Some(nearest) = near.iter().copied().min_by(|&i, &j| off(i).total_cmp(&off(j))) {
            *label = nearest;
        }
    }
    let last = shape.facets.len() as u32 - 1;
    shape.facets.swap_remove(k as usize);
    faces.labels.iter_mut().filter(|label| **label == last).for_each(|label| *label = k);
    Ok(())
}

/// A way to divide a facet: whether a part is unsound, and how much the parts are off planes; the parts;
/// of which its faces are.
struct Cut {
    rank: (bool, f64),
    parts: [Facet; 2],
    is_first: Vec<bool>,
}

/// Divides a facet without holes in two along the diagonal that leaves the flattest parts,
/// both sound where there is one.
fn divide(shape: &mut Shape, faces: &mut Faces<'_>, k: u32) -> Result<bool> {
    let facet = shape.facets[k as usize].twin()?;
    let n = facet.corners().count();
    if facet.loops.len() != 1 || n < 4 {
        return Ok(false);
    }
    let corners = &facet.loops[0];
    let own: Vec<usize> = memory::sifted((0..faces.labels.len()).filter(|&f| faces.labels[f] == k))?;
    let home = shape.at_home()?;
    let taken = shape.all_sides()?;
    let mut best: Option<Cut> = None;
    for i in 0..n {
        for j in i + 2..n.min(n + i - 1) {
            let (a, b) = (corners[i], corners[j]);
            if taken.contains(&[a, b]) || taken.contains(&[b, a]) {
                continue;
            }
            // The first part lies to the right of the way from `a` to `b`.
            let wall = cross(sub(home.point(b), home.point(a)), facet.plane.normal);
            let is_first: Vec<bool> = memory::gathered(
                own.iter().map(|&f| dot(sub(faces.scan.centers[f], home.point(a)), wall) > 0.0),
            )?;
            let part = |range: std::ops::Range<usize>, first: bool| -> Result<_> {
                let loops = vec![memory::gathered(range.map(|x| corners[x % n]))?];
                let moments = Moments::default();
                let mut part = Facet { loops, plane: facet.plane, moments, is_held: false, part: facet.part };
                let polygon = home.polygon_moments(&part);
                part.plane = polygon.fit().plane;
                // A part that is turned over lies on top of the other.
                let is_upright = dot(part.plane.normal, facet.plane.normal) > 0.0;
                let is_sound = is_upright && triangles(&home, &part)?.is_some();
                let of_part = own.iter().zip(&is_first).filter(|(_, &is_first)| is_first == first);
                let sum = of_part.fold(Moments::default(), |sum, (&f, _)| sum.plus(&faces.scan.moments[f]));
                let energy = sum.fit().energy + polygon.fit().energy;
                Ok((Facet { plane: polygon.fit().plane, moments: polygon, ..part }, is_sound, energy))
            };
            let (first, second) = (part(i..j + 1, true)?, part(j..n + i + 1, false)?);
            let rank = (!(first.1 && second.1), first.2 + second.2);
            if best.as_ref().is_none_or(|cut| rank < cut.rank) {
                best = Some(Cut { rank, parts: [first.0, second.0], is_first });
            }
        }
    }
    let Some(Cut { parts: [first, second], is_first, .. }) = best else { return Ok(false) };
    let fresh = shape.facets.len() as u32;
    for (&f, _) in own.iter().zip(is_first).filter(|(_, is_first)| !is_first) {
        faces.labels[f] = fresh;
    }
    shape.facets[k as usize] = first;
    memory::push(&mut shape.facets, second)?;
    Ok(true)
}

/// Holds the corners of a facet more firmly.
pub(super) fn hold(shape: &mut Shape, k: u32) {
    let Shape { corners, facets } = shape;
    facets[k as usize].corners().for_each(|c| corners[c as usize].firmness *= TRIES.factor);
}
