//! Facets that are sound, then facets that fit.

use std::collections::HashSet;

use super::constants::{FLAT, REPAIRS, ROUNDS, STAY, TRIES};
use super::faces::Faces;
use super::faults::Inspection;
use super::moments::Moments;
use super::repair::{hold, repair};
use super::shape::{Facet, Shape};
use super::solve::flatten;
use crate::mesh::vector::{area_vector, norm, unit};
use crate::progress::Progress;
use crate::tools::facet::moments::Plane;
use crate::Result;

/// Flattens the facets near where they were on the mesh, and repairs those that cross themselves or others.
pub(super) fn settle(shape: &mut Shape, faces: &mut Faces, progress: &Progress) -> Result<()> {
    for round in 0..=REPAIRS {
        progress.check()?;
        *shape = shape.at_home();
        shape.facets.iter_mut().for_each(|facet| facet.plane = facet.moments.fit().plane);
        // What crosses on the mesh itself is not held against the facets.
        let before = Inspection::new(shape, true).pairs;
        flatten(shape, STAY[0])?;
        let faulty = Inspection::new(shape, false).faults(&before);
        if faulty.is_empty() || round == REPAIRS || progress.is_finishing() || !repair(shape, faces, &faulty) {
            break;
        }
    }
    Ok(())
}

/// Gives every face to the nearest facet and fits the planes anew, in turns, as long as facets stay sound.
pub(super) fn refine(shape: &mut Shape, faces: &mut Faces, progress: &Progress) -> Result<()> {
    for _ in 0..ROUNDS {
        let inspection = Inspection::new(shape, true);
        let excused: HashSet<[u32; 2]> = inspection.pairs.clone();
        let crossed: HashSet<u32> = inspection.crossed.iter().copied().collect();
        faces.labels = faces.nearest(shape, &inspection).0;
        faces.fit(shape);
        let mut is_better = false;
        for _ in 0..TRIES {
            progress.check()?;
            let mut trial = shape.clone();
            let off = flatten(&mut trial, STAY[1])?;
            let mut faulty = Inspection::new(&trial, false).faults(&excused);
            faulty.retain(|k| !crossed.contains(k));
            if faulty.is_empty() {
                is_better = off <= FLAT.max(shape.off_planes());
                if is_better {
                    *shape = trial;
                }
                break;
            }
            faulty.into_iter().for_each(|k| _ = hold(shape, k));
        }
        if !is_better || progress.is_finishing() {
            break;
        }
    }
    Ok(())
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
