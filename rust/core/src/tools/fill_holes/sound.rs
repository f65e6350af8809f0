//! No patch is left folded, facing inwards, or passing through itself or the mesh: where one came out so, the
//! next simpler one takes its place.

use super::complete::complete;
use super::completion::Watch;
use super::filled::Completed;
use super::region::Region;
use super::{FillHolesOptions, PatchShape};
use crate::hole_filling::Patch;
use crate::mesh::vector::{dot, norm, Point};
use crate::progress::Progress;
use crate::remesh::crossings::crossings;
use crate::remesh::guard::worst_bend_of;
use crate::shape_guard::{FOLDED, TURNED};
use crate::{memory, Result};

/// [`complete`], and if that leaves a patch out of order, the smooth patch, or the triangulation that it
/// started from: the first that is in order, or else the one that is least out of it.
pub(super) fn completed_in_order(
    region: &mut Region,
    patch: &Patch,
    options: &FillHolesOptions,
    progress: &Progress,
    watch: &mut Watch<'_>,
) -> Result<Completed> {
    if patch.is_flat {
        watch(region, 1.0, 0, None)?;
        return Ok(Completed { shape: PatchShape::Flat, ..Completed::smooth() });
    }
    let start = region.twin()?;
    let mut completed = complete(region, options, progress, watch)?;
    let mut best = order(region, patch.lid_normal)?;
    if best >= 0.0 {
        return Ok(completed);
    }
    let mut simpler = Vec::new();
    if completed.sharpness > 0.0 {
        let mut smooth = start.twin()?;
        let options = FillHolesOptions { shape: PatchShape::Smooth, ..options.clone() };
        complete(&mut smooth, &options, progress, watch)?;
        simpler.push(smooth);
    }
    simpler.push(start);
    for other in simpler {
        let order = order(&other, patch.lid_normal)?;
        if order > best {
            best = order;
            *region = other;
            completed = Completed { status: completed.status, ..Completed::smooth() };
        }
        if best >= 0.0 {
            break;
        }
    }
    watch(region, 1.0, completed.iterations, None)?;
    Ok(completed)
}

/// By how much the worst bend of the patch, or its face that looks inwards most, is within the limits;
/// negative if not. A face looks inwards that looks against the lid to [`TURNED`]: the flanks of a smooth
/// patch, which go on with the surface around, look across it. A patch that passes through anything is worse
/// the more of it does.
fn order(region: &Region, lid: Option<Point>) -> Result<f64> {
    let passing = n_passing(region)?;
    if passing > 0 {
        return Ok(-1.0 - passing as f64);
    }
    let bend = worst_bend_of(&region.mesh, region.patch_faces().map(|(f, _)| f));
    let looks = |(f, _): (u32, [u32; 3])| {
        let area = region.mesh.area_vector(f);
        lid.map_or(1.0, |lid| if norm(area) > 0.0 { dot(area, lid) / norm(area) } else { 1.0 })
    };
    let least = region.patch_faces().map(looks).fold(1.0, f64::min);
    Ok((bend - FOLDED).min(least + TURNED))
}

/// How many pairs of faces pass through each other one of which is of the patch.
fn n_passing(region: &Region) -> Result<usize> {
    let (mut faces, mut is_patch) =
        (memory::room(region.mesh.n_faces())?, memory::room(region.mesh.n_faces())?);
    for (f, face) in region.mesh.faces() {
        faces.push(face);
        is_patch.push(region.is_patch(f));
    }
    let places = memory::gathered(faces.iter().map(|&face| region.mesh.corners(face)))?;
    let pairs = crossings(&faces, &places)?;
    Ok(pairs.into_iter().filter(|pair| pair.iter().any(|&f| is_patch[f as usize])).count())
}
