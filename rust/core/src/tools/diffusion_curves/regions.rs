//! The regions of a painted surface: segments of its colors,
//! whose borders then follow the paint vertex by vertex.

use super::check_paint;
use super::constants::{REGION_ROUNDS, SHADING};
use super::groups::Groups;
use super::patches::add_patches;
use super::settle::Faces;
use super::sharpen::sharpened;
use super::sorting::{Paint, Sorted};
use super::weak::merge_weak;
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::Mesh;
use crate::progress::{Progress, Report};
use crate::tools::{segment, SegmentOptions};
use crate::unit::Unit;
use crate::Result;

/// The region of each face by the colors at the vertices (n × c): what [`segment`] finds,
/// its borders moved until they follow the colors: each vertex is told by its color to which of the regions
/// around it it belongs, and has a face of that region in the end; no face lies in a region that none of its
/// vertices belongs to. Among the borders that do so, short ones are taken.
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
    if !progress.is_finishing() {
        follow(&paint, &groups, false, &mut labels)?;
    }
    if options.n_segments.is_none() && !progress.is_finishing() {
        groups.absorb_islands(connectivity, &mut labels)?;
        groups.split(connectivity, &mut labels)?;
        let least = options.min_faces.unwrap_or(1);
        add_patches(&paint, &paint.sort(&labels)?, &groups, least, &mut labels)?;
        if !progress.is_finishing() {
            // What a border does not show because of a vertex on its wrong side must not count for or against
            // it.
            settle(&paint, &groups, &mut labels)?;
            report("leaving out borders", 0.5)?;
            merge_weak(&paint, &mut labels)?;
        }
    }
    // Where within a blend the border is best, its own colors tell. That is all that is left to do where the
    // caller wishes to finish.
    settle(&original, &groups, &mut labels)?;
    renumber(&mut labels);
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{diffusion_curves, DiffusionCurvesOptions};
    use super::*;
    use crate::shapes::{self, Shape};

    /// A square with a color a vertex, and with regions by the centers of its faces.
    struct Painted {
        mesh: Mesh,
        colors: Columns,
        labels: Vec<i32>,
    }

    impl Painted {
        fn new(shape: &Shape, color: impl Fn(f64, f64) -> [f64; 3], label: impl Fn(f64, f64) -> i32) -> Self {
            let colors: Vec<[f64; 3]> = shape.vertices.iter().map(|p| color(p[0], p[1])).collect();
            let center =
                |f: &[u32; 3], k: usize| f.map(|v| shape.vertices[v as usize][k]).iter().sum::<f64>() / 3.0;
            let labels = shape.faces.iter().map(|f| label(center(f, 0), center(f, 1))).collect();
            Self { mesh: shape.mesh().unwrap(), colors: Columns::from_points(&colors).unwrap(), labels }
        }

        fn followed(&self, labels: &[i32], groups: Option<&[u32]>) -> Vec<i32> {
            let groups = Groups::new(groups, labels.len()).unwrap();
            let progress = Progress::new();
            let paint = Paint { mesh: &self.mesh, colors: &self.colors, fidelity: 1e3, progress: &progress };
            let mut labels = labels.to_vec();
            follow(&paint, &groups, false, &mut labels).unwrap();
            settle(&paint, &groups, &mut labels).unwrap();
            labels
        }

        fn error(&self, labels: &[i32]) -> f64 {
            let options = DiffusionCurvesOptions::default();
            diffusion_curves(&self.mesh, &self.colors, labels, &options, &Progress::new()).unwrap().error
        }
    }

    #[test]
    fn borders_follow_the_paint() {
        let shape = shapes::grid(20, 20);
        let is_inside = |x: f64, y: f64| (x - 10.0).hypot(y - 10.0) < 6.0;
        let color = |x, y| if is_inside(x, y) { [0.9, 0.3, 0.1] } else { [0.1, 0.4, 0.8] };
        // Regions that are off by up to three rows of faces; in pairs, as the triangles of squares.
        let shifted = |x: f64, y: f64| i32::from((x.floor() - 8.0).hypot(y.floor() - 9.0) < 6.5);
        let painted = Painted::new(&shape, color, shifted);
        assert!(painted.error(&painted.labels) > 1e-3);
        let groups: Vec<u32> = (0..shape.faces.len() as u32).map(|f| f / 2).collect();
        for groups in [None, Some(&groups[..])] {
            let labels = painted.followed(&painted.labels, groups);
            assert!(painted.error(&labels) < 1e-20, "{}", painted.error(&labels));
            assert!(groups.is_none() || labels.chunks(2).all(|pair| pair[0] == pair[1]));
            assert_eq!(painted.followed(&labels, groups), labels);
        }
    }

    #[test]
    fn borders_follow_a_strip_of_single_vertices_that_goes_on_to_where_it_is_wide() {
        let shape = shapes::grid(30, 30);
        let is_flag = |x: f64, y: f64| (x - 15.0).abs() < 0.5 || y > 20.0;
        let side = |x: f64| if x > 15.0 { [0.04, 0.18, 0.65] } else { [0.8, 0.1, 0.05] };
        let color = |x, y| if is_flag(x, y) { [0.85, 0.85, 0.8] } else { side(x) };
        let label = |x: f64, y: f64| if y > 20.0 { 2 } else { i32::from(x > 15.0) };
        let painted = Painted::new(&shape, color, label);
        assert!(painted.error(&painted.labels) > 1e-4);
        assert!(painted.error(&painted.followed(&painted.labels, None)) < 1e-20);
    }
}
