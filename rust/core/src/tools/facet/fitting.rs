//! Facets that are sound, then facets that fit.

use std::collections::HashSet;

use super::constants::{AT_CORNERS, FLAT, PULL, REPAIRS, ROUNDS, STAY, TRIES};
use super::faces::Faces;
use super::faults::Inspection;
use super::moments::{Moments, Plane};
use super::repair::{hold, repair};
use super::shape::{Corner, Facet, Shape};
use super::solve::flatten;
use crate::mesh::vector::{area_vector, between, distance, norm, unit, Point};
use crate::progress::Progress;
use crate::Result;

/// Flattens the facets near where they were on the mesh, and repairs those that cross themselves or others.
pub(super) fn settle(shape: &mut Shape, faces: &mut Faces, progress: &Progress) -> Result<()> {
    for round in 0..=REPAIRS {
        progress.check()?;
        *shape = shape.at_home();
        shape.facets.iter_mut().for_each(|facet| facet.plane = facet.moments.fit().plane);
        // What crosses on the mesh itself is not held against the facets.
        let before = Inspection::new(shape, true).pairs;
        let homes: Vec<Point> = shape.corners.iter().map(|corner| corner.home).collect();
        flatten(shape, STAY[0], &homes)?;
        let faulty = Inspection::new(shape, false).faults(&before);
        if faulty.is_empty() || round == REPAIRS || progress.is_finishing() || !repair(shape, faces, &faulty) {
            break;
        }
    }
    Ok(())
}

/// Gives every face to the nearest facet and fits the planes anew, in turns, as long as facets stay sound; the nearest shape stays.
pub(super) fn refine(shape: &mut Shape, faces: &mut Faces, progress: &Progress) -> Result<()> {
    let mut inspection = Inspection::new(shape, true);
    let (mut labels, mut least) = measured(shape, faces, &inspection);
    let mut best = shape.clone();
    for _ in 0..ROUNDS {
        faces.labels = labels;
        faces.fit(shape);
        let Some(next) = fitted(shape, faces, &inspection, progress)? else { break };
        *shape = next;
        inspection = Inspection::new(shape, true);
        let distance;
        (labels, distance) = measured(shape, faces, &inspection);
        if distance < least {
            (least, best) = (distance, shape.clone());
        }
        if progress.is_finishing() {
            break;
        }
    }
    *shape = best;
    Ok(())
}

/// The facet nearest to each face, and the distance of both surfaces from each other: from the faces to the facets, and from the
/// corners to the mesh, where facets are farthest from it.
fn measured(shape: &Shape, faces: &Faces, inspection: &Inspection) -> (Vec<u32>, f64) {
    let (labels, distances) = faces.nearest(shape, inspection);
    let off = |corner: &Corner| distance(corner.point, faces.on_mesh(corner.point)).powi(2);
    let corners = shape.corners.iter().map(off).sum::<f64>() / shape.corners.len().max(1) as f64;
    (labels, (distances.rms.powi(2) + AT_CORNERS * corners).sqrt())
}

/// The shape with planes fitted to its faces, if that can be had without facets that cross where none did.
fn fitted(shape: &mut Shape, faces: &Faces, before: &Inspection, progress: &Progress) -> Result<Option<Shape>> {
    let aim = |corner: &Corner| between(corner.point, faces.on_mesh(corner.point), PULL);
    let aims: Vec<Point> = shape.corners.iter().map(aim).collect();
    for _ in 0..TRIES {
        progress.check()?;
        let mut trial = shape.clone();
        let off = flatten(&mut trial, STAY[1], &aims)?;
        let mut faulty = Inspection::new(&trial, false).faults(&before.pairs);
        faulty.retain(|k| !before.crossed.contains(k));
        if faulty.is_empty() {
            return Ok((off <= FLAT.max(shape.off_planes())).then_some(trial));
        }
        faulty.into_iter().for_each(|k| hold(shape, k));
    }
    Ok(None)
}

/// Leaves triangles of the facets that did not come out flat or simple.
pub(super) fn fold(shape: &mut Shape) {
    let inspection = Inspection::new(shape, false);
    let crossed: HashSet<u32> = inspection.crossed.iter().copied().collect();
    let mut facets = Vec::with_capacity(shape.facets.len());
    for (k, facet) in (0..).zip(&shape.facets) {
        let off = facet.corners().map(|c| facet.plane.height(shape.point(c)).abs()).fold(0.0, f64::max);
        if off <= FLAT && !crossed.contains(&k) {
            facets.push(facet.clone());
            continue;
        }
        let own = inspection.triangles.iter().zip(&inspection.owners).filter(|(_, &owner)| owner == k);
        for (triangle, _) in own {
            let corners = triangle.map(|c| shape.point(c));
            let area = area_vector(corners);
            let plane = if norm(area) > 0.0 { Plane::through(corners[0], unit(area)) } else { facet.plane };
            facets.push(Facet { loops: vec![triangle.to_vec()], plane, moments: Moments::of(corners) });
        }
    }
    shape.facets = facets;
}
