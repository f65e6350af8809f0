//! The regions of a painted surface: segments of its colors,
//! whose borders then follow the paint vertex by vertex.

use super::constants::{REGION_ROUNDS, SHADING};
use super::groups::Groups;
use super::patches::add_patches;
use super::settle::Faces;
use super::sharpen::sharpened;
use super::sorting::{Paint, Sorted};
use super::weak::merge_weak;
use super::{check_labels, check_paint};
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::Mesh;
use crate::progress::{Progress, Report};
use crate::tools::{segment, SegmentOptions};
use crate::unit::Unit;
use crate::Result;

/// The region of each face by the colors at the vertices (n × c): what [`segment`] finds,
/// its borders moved by [`follow_colors`].
///
/// Soft edges of the paint count as sharp ones, or the blends in them would become regions.
///
/// If no number of regions is asked for, patches that it has left in a region of another color get regions of
/// their own, and regions without which the surface comes back as well become part of a neighbor.
///
/// Faces with the same number in `groups`, the triangles of a polygon, come into one region:
/// that of most of them.
///
/// # Errors
/// Groups of the wrong length, and the errors of [`segment`] and [`super::diffusion_curves`].
pub fn color_regions(
    mesh: &Mesh,
    colors: &Columns,
    options: &SegmentOptions,
    groups: Option<&[u32]>,
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<i32>> {
    check_paint(mesh, colors, fidelity)?;
    let connectivity = mesh.connectivity();
    mesh.demand(Tool::DiffusionCurves).admit(options.solve.memory_limit)?;
    let groups = Groups::new(groups, connectivity.n_faces())?;
    let (mesh, colors) =
        (mesh.measured(mesh.unit())?, colors.measured(Unit::of(colors.data.iter().copied())));
    let original = Paint { mesh: &mesh, colors: &colors, fidelity, progress };
    let sharp = sharpened(&original)?;
    let paint = Paint { colors: &sharp, ..original };
    let mut labels = segment(&mesh, Some(&sharp), options, progress)?.labels;
    groups.unify(&mut labels);
    let report = |stage: &str, fraction| {
        progress.report(Report { fraction, stage: stage.into(), ..Report::default() });
        progress.check()
    };
    report("following colors", 0.0)?;
    follow(&paint, &groups, false, &mut labels)?;
    if options.n_segments.is_none() {
        groups.absorb_islands(connectivity, &mut labels)?;
        groups.split(connectivity, &mut labels)?;
        let least = options.min_faces.unwrap_or(1);
        add_patches(&paint, &paint.sort(&labels)?, &groups, least, &mut labels)?;
        // What a border does not show because of a vertex on its wrong side must not count for or against it.
        settle(&paint, &groups, &mut labels)?;
        report("leaving out borders", 0.5)?;
        merge_weak(&paint, &mut labels)?;
    }
    // Where within a blend the border is best, its own colors tell.
    settle(&original, &groups, &mut labels)?;
    renumber(&mut labels);
    Ok(labels)
}

/// Moves the borders of regions until they follow the colors: each vertex is told by its color to which of
/// the regions around it it belongs, and has a face of that region in the end; no face lies in a region that
/// none of its vertices belongs to. Among the borders that do so, short ones are taken.
///
/// # Errors
/// Those of [`super::diffusion_curves`], and groups of the wrong length.
pub fn follow_colors(
    mesh: &Mesh,
    colors: &Columns,
    labels: &[i32],
    groups: Option<&[u32]>,
    fidelity: f64,
    progress: &Progress,
) -> Result<Vec<i32>> {
    check_paint(mesh, colors, fidelity)?;
    let n_faces = mesh.connectivity().n_faces();
    check_labels(labels, n_faces)?;
    let groups = Groups::new(groups, n_faces)?;
    let paint = Paint { mesh, colors, fidelity, progress };
    let mut labels = labels.to_vec();
    follow(&paint, &groups, false, &mut labels)?;
    settle(&paint, &groups, &mut labels)?;
    Ok(labels)
}

/// Moves borders until every face is in a region of one of its vertices, and with `cover` until every vertex
/// has a face of its region; returns where the vertices belong.
fn follow(paint: &Paint<'_>, groups: &Groups, cover: bool, labels: &mut [i32]) -> Result<Sorted> {
    let most = SHADING * paint.scale();
    let mut sorted = paint.sort(labels)?;
    for _ in 0..REGION_ROUNDS {
        paint.progress.check()?;
        let mut faces = Faces::new(paint.mesh, groups, &sorted.regions, labels);
        let moved = faces.follow() | (cover && faces.cover(|v| sorted.off[v] <= most));
        if !moved || paint.progress.is_finishing() {
            break;
        }
        sorted = paint.sort(labels)?;
    }
    Ok(sorted)
}

/// Gives every vertex a face of its region, and shortens the borders.
fn settle(paint: &Paint<'_>, groups: &Groups, labels: &mut [i32]) -> Result<()> {
    groups.absorb_islands(paint.mesh.connectivity(), labels)?;
    let sorted = follow(paint, groups, true, labels)?;
    Faces::new(paint.mesh, groups, &sorted.regions, labels).shorten();
    Ok(())
}

/// Leaves no number out.
fn renumber(labels: &mut [i32]) {
    let mut used = labels.to_vec();
    used.sort_unstable();
    used.dedup();
    for label in labels {
        *label = used.partition_point(|other| other < label) as i32;
    }
}
