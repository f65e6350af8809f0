//! Facets that are sound, then facets that fit.

use super::constants::{FITTING, FLAT, IDLE, NOISE, PROMISED, PULL, REPAIRS, SPREAD, STAY, TRIES};
use super::faces::Faces;
use super::faults::Inspection;
use super::moments::{Moments, Plane};
use super::repair::{hold, repair};
use super::shape::{Corner, Facet, Shape};
use super::solve::flatten;
use super::stage::Stage;
use super::triangulation::{forced, triangles};
use crate::memory;
use crate::mesh::vector::{area_vector, between, distance, norm, unit};
use crate::Result;

/// Flattens the facets near where they were on the mesh, and repairs those that cross themselves or others
/// if they `are_repaired`; where faults spread by that, what had the fewest is left. Says whether they did.
pub(super) fn settle(
    shape: &mut Shape,
    faces: &mut Faces<'_>,
    are_repaired: bool,
    stage: &Stage<'_>,
) -> Result<bool> {
    let mut n_first = 0;
    let mut fewest: Option<((bool, usize), Shape, Vec<u32>)> = None;
    for round in 0..=REPAIRS {
        *shape = shape.at_home()?;
        shape.facets.iter_mut().for_each(|facet| facet.plane = facet.moments.fit().plane);
        let homes = memory::gathered(shape.corners.iter().map(|corner| corner.home))?;
        flatten(shape, STAY, &homes, stage)?;
        let inspection = Inspection::new(shape, faces, false)?;
        let faulty = inspection.faults()?;
        let is_last = faulty.is_empty() || round == REPAIRS || stage.is_finishing();
        if is_last {
            break;
        }
        if faces.scan.borders.is_some() {
            if round == TRIES.count {
                break;
            }
            faulty.iter().for_each(|&k| hold(shape, k));
            continue;
        }
        if !are_repaired {
            break;
        }
        if round == 0 {
            n_first = faulty.len();
        }
        if faulty.len() > SPREAD * n_first {
            if let Some((_, least, labels)) = fewest {
                (*shape, faces.labels) = (least, labels);
            }
            return Ok(true);
        }
        // Pairs are only looked for where no facet is crossed.
        let rank = (!inspection.crossed.is_empty(), faulty.len());
        if fewest.as_ref().is_none_or(|(least, ..)| rank < *least) {
            fewest = Some((rank, shape.twin()?, memory::twin(&faces.labels)?));
        }
        if !repair(shape, faces, &faulty)? {
            break;
        }
    }
    Ok(false)
}

/// Gives every face to the nearest facet and fits the planes anew, in turns,
/// as long as facets stay sound and come nearer.
pub(super) fn refine(shape: &mut Shape, faces: &mut Faces<'_>, stage: &Stage<'_>) -> Result<()> {
    if let Some(borders) = &faces.scan.borders {
        borders.share(shape, &mut faces.labels, None)?;
    }
    let mut inspection = Inspection::new(shape, faces, true)?;
    let (mut labels, distance) = measured(shape, faces, &inspection)?;
    let mut best = (distance, shape.twin()?, memory::twin(&faces.labels)?);
    let mut n_idle = 0;
    while n_idle < IDLE.count && !stage.is_finishing() {
        match &faces.scan.borders {
            Some(borders) => borders.share(shape, &mut faces.labels, Some(&labels))?,
            None => faces.labels = labels,
        }
        faces.fit(shape)?;
        let faults = inspection.faults()?;
        let Some(next) = fitted(shape, faces, &faults, NOISE * best.0, stage)? else { break };
        *shape = next;
        inspection = Inspection::new(shape, faces, true)?;
        let distance;
        (labels, distance) = measured(shape, faces, &inspection)?;
        n_idle = if distance < IDLE.factor * best.0 && best.0 > PROMISED { 0 } else { n_idle + 1 };
        if distance < best.0 {
            best = (distance, shape.twin()?, memory::twin(&faces.labels)?);
        }
    }
    *shape = best.1;
    if faces.scan.borders.is_some() {
        faces.labels = best.2;
    }
    Ok(())
}

/// The facet nearest to each face, and the distance of both surfaces from each other: from the faces to the
/// facets, and from the facets to the mesh.
fn measured(shape: &Shape, faces: &Faces<'_>, inspection: &Inspection) -> Result<(Vec<u32>, f64)> {
    let (labels, distances) = faces.nearest(shape, inspection)?;
    let (mut squares, mut total) = (0.0, 0.0);
    for triangle in inspection.places(shape)? {
        squares += faces.scan.off_mesh(triangle);
        total += norm(area_vector(triangle));
    }
    Ok((labels, (distances.rms.powi(2) + squares / f64::max(total, f64::MIN_POSITIVE)).sqrt()))
}

/// The shape with planes fitted to its faces, and corners drawn back that are farther than `reach` from the
/// mesh, if that can be had without facets that cross where none did.
fn fitted(
    shape: &mut Shape,
    faces: &Faces<'_>,
    before: &[u32],
    reach: f64,
    stage: &Stage<'_>,
) -> Result<Option<Shape>> {
    let aim = |corner: &Corner| {
        let near = faces.scan.on_mesh(corner.point);
        let beyond = 1.0 - reach / distance(near, corner.point).max(f64::MIN_POSITIVE);
        between(corner.point, near, PULL * beyond.max(0.0))
    };
    let aims = memory::gathered(shape.corners.iter().map(aim))?;
    for _ in 0..TRIES.count {
        let mut trial = shape.twin()?;
        let off = flatten(&mut trial, FITTING, &aims, stage)?;
        let mut faulty = Inspection::new(&trial, faces, false)?.faults()?;
        faulty.retain(|k| !before.contains(k));
        if faulty.is_empty() {
            return Ok((off <= FLAT.max(shape.off_planes())).then_some(trial));
        }
        faulty.into_iter().for_each(|k| hold(shape, k));
    }
    Ok(None)
}

/// Flattens facets where they are until they are flat, if a few times do.
///
/// # Errors
/// [`crate::Error::Cancelled`], those of the linear solver.
pub(super) fn settled(shape: &mut Shape, stage: &Stage<'_>) -> Result<()> {
    for _ in 0..TRIES.count {
        if shape.off_planes() <= FLAT {
            break;
        }
        let here = memory::gathered(shape.corners.iter().map(|corner| corner.point))?;
        flatten(shape, STAY, &here, stage)?;
    }
    Ok(())
}

/// Leaves triangles of the facets that do not come out flat or simple.
///
/// # Errors
/// [`crate::Error::Cancelled`], those of the linear solver.
pub(super) fn fold(shape: &mut Shape, faces: &mut Faces<'_>, stage: &Stage<'_>) -> Result<()> {
    settled(shape, stage)?;
    if faces.scan.borders.is_some() {
        return Ok(());
    }
    let home = shape.at_home()?;
    let mut facets = Vec::new();
    let mut place = memory::room(shape.facets.len())?;
    for (k, facet) in (0..).zip(&shape.facets) {
        place.push(facets.len() as u32);
        let here = triangles(shape, facet)?;
        if facet.is_held || facet.is_triangle() || (here.is_some() && shape.off_plane(k) <= FLAT) {
            memory::push(&mut facets, facet.twin()?)?;
            continue;
        }
        let found = match here {
            Some(found) => Some(found),
            None => triangles(&home, facet)?,
        };
        let triangles = match found {
            Some(found) => found,
            None => forced(facet)?,
        };
        for triangle in triangles {
            let corners = triangle.map(|c| shape.point(c));
            let area = area_vector(corners);
            let plane = if norm(area) > 0.0 { Plane::through(corners[0], unit(area)) } else { facet.plane };
            // One that comes out turned over is seen by where it was.
            let moments = Moments::of(triangle.map(|c| shape.home(c)));
            let loops = vec![triangle.to_vec()];
            memory::push(&mut facets, Facet { loops, plane, moments, is_held: false, part: facet.part })?;
        }
    }
    // One without corners, as of two faces that lie on each other, leaves nothing; its faces go to another.
    if let Some(last) = facets.len().checked_sub(1) {
        shape.facets = facets;
        faces.labels.iter_mut().for_each(|label| *label = place[*label as usize].min(last as u32));
    }
    Ok(())
}

/// Puts the facets that were made before the faces that stay; returns how many they are.
pub(super) fn order(shape: &mut Shape, faces: &mut Faces<'_>) -> Result<usize> {
    let n_made = shape.facets.iter().filter(|facet| !facet.is_held).count();
    let mut place = memory::room(shape.facets.len())?;
    let (mut made, mut held) = (0..n_made as u32, n_made as u32..);
    place.extend(shape.facets.iter().filter_map(|f| if f.is_held { held.next() } else { made.next() }));
    faces.labels.iter_mut().for_each(|label| *label = place[*label as usize]);
    let (mut facets, mut held) = (memory::room(place.len())?, memory::room(place.len() - n_made)?);
    for facet in std::mem::take(&mut shape.facets) {
        if facet.is_held { &mut held } else { &mut facets }.push(facet);
    }
    facets.append(&mut held);
    shape.facets = facets;
    Ok(n_made)
}
