//! No patch is left folded, facing inwards, or sharp and passing through itself or the mesh: where one came
//! out so, the next simpler one takes its place.

use super::complete::complete;
use super::completion::Watch;
use super::constants::DEEP;
use super::filled::Completed;
use super::region::Region;
use super::{FillHolesOptions, PatchShape};
use crate::hole_filling::Patch;
use crate::mesh::vector::{area_vector, distance, dot, norm, sub, unit, Point};
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
    let is_wished = options.shape == PatchShape::Sharp;
    let mut best = order(region, patch.lid_normal, is_wished)?;
    if best >= 0.0 {
        return Ok(completed);
    }
    let mut simpler = Vec::new();
    if completed.sharpness > 0.0 && !progress.is_finishing() {
        let mut smooth = start.twin()?;
        let options = FillHolesOptions { shape: PatchShape::Smooth, ..options.clone() };
        complete(&mut smooth, &options, progress, watch)?;
        simpler.push(smooth);
    }
    simpler.push(start);
    for other in simpler {
        let order = order(&other, patch.lid_normal, is_wished)?;
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
/// patch, which go on with the surface around, look across it. One that is sharp since that `is_wished`, not
/// because of the ridges around it, may pass through itself or the mesh, and is worse the more of it does.
fn order(region: &Region, lid: Option<Point>, is_wished: bool) -> Result<f64> {
    let passing = if is_wished { n_passing(region)? } else { 0 };
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
    let pairs = crossings(&faces, &places)?.into_iter();
    let is_of_patch = |pair: &[u32; 2]| pair.iter().any(|&f| is_patch[f as usize]);
    let is_deep = |&[f, g]: &[u32; 2]| {
        let [f, g] = [f, g].map(|f| &places[f as usize]);
        reaches_through(f, g) && reaches_through(g, f)
    };
    Ok(pairs.filter(is_of_patch).filter(is_deep).count())
}

/// Whether corners of a triangle lie on both sides of the plane of another by more than rounding: faces that
/// fill a plane up to the rim may overlap by that.
fn reaches_through(corners: &[Point; 3], other: &[Point; 3]) -> bool {
    let normal = unit(area_vector(*other));
    let heights = corners.map(|p| dot(sub(p, other[0]), normal));
    let size = distance(corners[0], corners[1]).max(distance(corners[1], corners[2]));
    let (low, high) = heights.iter().fold((0.0_f64, 0.0_f64), |(low, high), h| (low.min(*h), high.max(*h)));
    low < -DEEP * size && high > DEEP * size
}
