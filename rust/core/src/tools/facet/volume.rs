//! The volume that facets enclose is that of the mesh where that is asked for: all planes move outward by the
//! same distance, as far as corners that lie on many of them let them, and only what is left is scaled.

use std::collections::HashMap;

use super::constants::{FITTING, FLAT, TRIES};
use super::faces::Faces;
use super::faults::Inspection;
use super::fitting::settled;
use super::job::Job;
use super::shape::Shape;
use super::solve::flatten;
use super::stage::Stage;
use crate::mesh::vector::{add, cross, dot, scale, sub, unit, Point};
use crate::mesh::FILE_ROUNDING;
use crate::{memory, Error, Result};

/// Distances that are tried at most: the volume is nearly linear in them, so secants take two or three.
const TRIALS: usize = 8;

/// The volume that triangles enclose, six times, and the sum of its first moments, 24 times.
fn enclosed(places: &[[Point; 3]]) -> (f64, Point) {
    places.iter().fold((0.0, [0.0; 3]), |(volume, moment), &[a, b, c]| {
        let part = dot(a, cross(b, c));
        (volume + part, add(moment, scale(add(a, add(b, c)), part)))
    })
}

impl Job<'_> {
    /// The volume that the mesh encloses.
    ///
    /// # Errors
    /// [`Error::Argument`] where it is open, or encloses nothing.
    pub(super) fn volume(&self, places: &[[Point; 3]]) -> Result<f64> {
        let faces = self.working.mesh().connectivity().faces();
        let mut ways: HashMap<[u32; 2], i32> = HashMap::new();
        memory::extend_map(&mut ways, 2 * self.parts.len())?;
        for &f in &self.parts {
            let [a, b, c] = faces[f as usize];
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *ways.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
        if ways.values().any(|&way| way != 0) {
            return Err(Error::argument(
                "keep_volume",
                "needs a mesh that is closed, and whose faces agree on the outside",
            ));
        }
        let (volume, _) = enclosed(places);
        // The box has a diagonal of 1.
        if volume.abs() <= FILE_ROUNDING {
            return Err(Error::argument("keep_volume", "needs a mesh that encloses a volume"));
        }
        Ok(volume / 6.0)
    }
}

/// Gives facets the volume `wanted`, if they can have it and stay sound. Those that do not are not moved.
///
/// # Errors
/// [`Error::Cancelled`], [`Error::Memory`].
pub(super) fn keep(shape: &mut Shape, faces: &Faces<'_>, wanted: f64, stage: &Stage<'_>) -> Result<()> {
    let inspection = Inspection::new(shape, faces, true)?;
    let before = inspection.faults()?;
    let mut moves: Vec<bool> = memory::gathered(shape.facets.iter().map(|facet| !facet.is_held))?;
    for _ in 0..TRIES.count {
        let Some(trial) = with_volume(shape, &moves, &inspection, wanted, stage)? else { break };
        let mut faulty = Inspection::new(&trial, faces, true)?.faults()?;
        faulty.retain(|k| !before.contains(k));
        let is_flat = trial.off_planes() <= FLAT.max(shape.off_planes());
        if faulty.is_empty() && is_flat {
            *shape = trial;
            break;
        }
        let off = |k: &u32| trial.off_plane(*k) > FLAT;
        faulty.extend((0..moves.len() as u32).filter(|k| !is_flat && off(k)));
        faulty.into_iter().for_each(|k| moves[k as usize] = false);
    }
    let (volume, center) = measured(shape, &inspection)?;
    let factor = (wanted / volume).cbrt();
    let is_free = !shape.corners.iter().any(|corner| corner.is_fixed);
    if is_free && factor.is_finite() && factor > 0.0 {
        for corner in &mut shape.corners {
            corner.point = add(center, scale(sub(corner.point, center), factor));
        }
        for plane in shape.facets.iter_mut().map(|facet| &mut facet.plane) {
            plane.offset = factor * plane.offset + (1.0 - factor) * dot(plane.normal, center);
        }
    }
    Ok(())
}

/// The volume that the triangles of facets enclose, and the center of that.
fn measured(shape: &Shape, inspection: &Inspection) -> Result<(f64, Point)> {
    let (six, moment) = enclosed(&inspection.places(shape)?);
    Ok((six / 6.0, scale(moment, 0.25 / six)))
}

/// The shape with planes moved such that it has the volume `wanted`; `None` where it has.
fn with_volume(
    shape: &Shape,
    moves: &[bool],
    inspection: &Inspection,
    wanted: f64,
    stage: &Stage<'_>,
) -> Result<Option<Shape>> {
    let moving = shape.facets.iter().zip(moves).filter(|(_, &moves)| moves);
    let area: f64 = moving.map(|(facet, _)| shape.polygon_moments(facet).area).sum();
    let (mut before, mut now) = ((0.0, measured(shape, inspection)?.0), None);
    let mut by = (wanted - before.1) / area.max(f64::MIN_POSITIVE);
    for _ in 0..TRIALS {
        if (wanted - before.1).abs() <= FILE_ROUNDING * wanted.abs() || !by.is_finite() {
            break;
        }
        let trial = moved(shape, moves, by, stage)?;
        let here = (by, measured(&trial, inspection)?.0);
        let slope = (here.1 - before.1) / (here.0 - before.0);
        (before, now) = (here, Some(trial));
        by += (wanted - here.1) / slope;
    }
    Ok(now)
}

/// The shape fitted to its own polygons moved outward by a distance, which are what it is if that is none.
fn moved(shape: &Shape, moves: &[bool], by: f64, stage: &Stage<'_>) -> Result<Shape> {
    let mut trial = shape.twin()?;
    let mut outward = memory::repeated([0.0; 3], shape.corners.len())?;
    for (facet, &moves) in trial.facets.iter_mut().zip(moves) {
        facet.moments = shape.polygon_moments(facet);
        if moves {
            facet.moments = facet.moments.moved(scale(facet.plane.normal, by));
            facet.corners().for_each(|c| outward[c as usize] = add(outward[c as usize], facet.plane.normal));
        }
    }
    let aim = |(corner, way): (&super::shape::Corner, Point)| add(corner.point, scale(unit(way), by));
    let aims = memory::gathered(shape.corners.iter().zip(outward).map(aim))?;
    flatten(&mut trial, FITTING, &aims, stage)?;
    settled(&mut trial, stage)?;
    for (facet, before) in trial.facets.iter_mut().zip(&shape.facets) {
        facet.moments = before.moments;
    }
    Ok(trial)
}
