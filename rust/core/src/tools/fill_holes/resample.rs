//! The patch with edges as long as those of its rim again, its ridges kept.

use std::collections::{HashMap, HashSet};

use super::region::Region;
use crate::memory;
use crate::mesh::vector::{distance, norm};
use crate::progress::Progress;
use crate::remesh::budget;
use crate::remesh::curves::Keep;
use crate::remesh::editable::{key, Edge};
use crate::remesh::isotropic::run;
use crate::remesh::remesher::{Reference, Remesher};
use crate::remesh::sizing::{length_and_growth, Sizing};
use crate::remesh::EditableMesh;
use crate::Result;

/// What a remeshing keeps and joins.
pub(super) struct Kept<'a> {
    /// Edges bent by more than this (radians) stay as curves,
    pub ridge: f64,
    /// and so do these, smaller vertex first.
    pub borders: &'a [[u32; 2]],
    /// Free vertices and the neighbors with which they are joined first.
    pub merges: &'a [[u32; 2]],
}

impl Kept<'_> {
    /// Keeps edges bent by more than `ridge` radians.
    pub(super) fn ridges(ridge: f64) -> Self {
        Self { ridge, borders: &[], merges: &[] }
    }
}

/// What a remeshing is to reach.
pub(super) struct Target {
    /// The edge length; that of the patch where `None`.
    pub edge_length: Option<f64>,
    /// About how many faces the patch may have: where it would have more,
    /// edges grow with their distance from the rim.
    pub max_faces: usize,
    /// Rounds of all passes.
    pub rounds: usize,
}

/// Remeshes the patch [Botsch and Kobbelt 2004]: where vertices have met on a ridge edges collapse, where the
/// ridge has stretched the patch they split.
pub(super) fn resample(
    region: &mut Region,
    kept: &Kept<'_>,
    target: &Target,
    progress: &Progress,
) -> Result<()> {
    let &Target { edge_length, max_faces, rounds } = target;
    let (points, faces, rim) = region.patch()?;
    let n = rim.len();
    let mut mesh = EditableMesh::new(points, faces)?;
    let place = |v: u32| rim.binary_search(&v).ok().map(|i| i as u32);
    let outside = |&[a, b]: &[u32; 2]| match region.mesh.edge(a, b) {
        Edge::Border(f, _) => !region.is_patch(f),
        Edge::Interior(wings) => wings.faces.iter().all(|&f| !region.is_patch(f)),
        Edge::NonManifold => true,
        Edge::None => false,
    };
    let edges = region.mesh.edges()?.into_iter().filter(outside).chain(region.forbidden.iter().copied());
    for [a, b] in edges {
        if let (Some(a), Some(b)) = (place(a), place(b)) {
            mesh.forbid_edge(a, b);
        }
    }
    for (f, [a, b, c]) in region.patch_faces() {
        for (tail, head) in [(a, b), (b, c), (c, a)] {
            let across = region.mesh.wings(tail, head).and_then(|w| w.faces.into_iter().find(|&g| g != f));
            if let (Some(across), Some(a), Some(b)) = (across, place(tail), place(head)) {
                if !region.is_patch(across) {
                    mesh.set_beyond(a, b, region.mesh.area_vector(across));
                }
            }
        }
    }
    let shift = region.anchors.len() as u32 - n as u32;
    let number = |v: u32| if region.is_anchor(v) { place(v) } else { Some(v - shift) };
    let mut merged = HashMap::new();
    for &[from, to] in kept.merges {
        if let (Some(from), Some(to)) = (number(from), number(to)) {
            if !merged.contains_key(&to) && mesh.collapse(from, to, mesh.position(to)) {
                merged.insert(from, to);
            }
        }
    }
    let number = |v: u32| number(v).map(|v| merged.get(&v).copied().unwrap_or(v));
    let features: HashSet<[u32; 2]> = kept
        .borders
        .iter()
        .filter_map(|&[a, b]| Some(key(number(a)?, number(b)?)))
        .filter(|[a, b]| a != b)
        .collect();
    let surface = Reference::of(&mesh)?;
    let fixed = memory::gathered((0..mesh.n_vertices()).map(|v| v < n))?;
    let keep = Keep {
        fixed: &fixed,
        fixed_faces: false,
        feature_cosine: kept.ridge.cos(),
        features: Some(&features),
    };
    let typical = typical_edge(&mesh)?;
    let (length, growth) = lengths(&mesh, edge_length, max_faces)?;
    let mut remesher = Remesher::new(mesh, &surface, &keep, |mesh, curves| match edge_length {
        Some(_) => Sizing::uniform(length, growth, mesh, curves),
        None if growth > 0.0 => Sizing::grown(length, growth, mesh, curves),
        None => Sizing::graded(memory::repeated(typical, mesh.n_vertices())?, 0.0, mesh, curves),
    })?;
    run(&mut remesher, rounds, budget::patch_faces(max_faces, n), &progress.quiet())?;
    let (points, faces, _) = remesher.mesh.into_parts(|v| (v as usize) < n)?;
    region.replace_patch(&points, &faces, &rim)
}

/// How long the edges of the patch `mesh` should be at its rim, and by how much longer for every unit of
/// distance from there.
fn lengths(mesh: &EditableMesh, edge_length: Option<f64>, max_faces: usize) -> Result<(f64, f64)> {
    let is_border = |&[a, b]: &[u32; 2]| matches!(mesh.edge(a, b), Edge::Border(..));
    let length = |[a, b]: [u32; 2]| distance(mesh.position(a), mesh.position(b));
    let rim = memory::sifted(mesh.edges()?.into_iter().filter(is_border).map(length))?;
    let total: f64 = rim.iter().sum();
    let area: f64 = mesh.faces().map(|(f, _)| norm(mesh.area_vector(f))).sum();
    Ok(length_and_growth(area, total, total / rim.len().max(1) as f64, edge_length, max_faces))
}

/// The mean edge length.
pub(super) fn typical_edge(mesh: &EditableMesh) -> Result<f64> {
    let edges = mesh.edges()?;
    let sum: f64 = edges.iter().map(|&[a, b]| distance(mesh.position(a), mesh.position(b))).sum();
    Ok(sum / f64::max(edges.len() as f64, 1.0))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::collections::HashSet;

    use super::super::neighborhoods::Neighborhoods;
    use super::*;
    use crate::hole_filling::{faces_at, fill_loops, find_holes, FillOptions};
    use crate::shapes::grid;

    #[test]
    fn the_patch_of_a_wide_hole_stays_coarse_until_it_may_be_fine() {
        let inside = |f: usize| (2..62).contains(&(f / 2 % 64)) && (2..62).contains(&(f / 128));
        let mesh = grid(64, 64).without_faces(inside).mesh().unwrap();
        let hole =
            find_holes(&mesh).unwrap().into_iter().find(|hole| !hole.is_outer_border).unwrap().vertices;
        let (progress, coarse) = (Progress::new(), FillOptions { max_faces: 1500, ..FillOptions::default() });
        let at = faces_at(&mesh, std::slice::from_ref(&hole)).unwrap();
        let patch = fill_loops(&mesh, &[hole], &at, &coarse, &progress).unwrap().remove(0).unwrap();
        let near = Neighborhoods::new(mesh.connectivity(), &at).unwrap();
        let n = mesh.connectivity().n_vertices() as u32;
        let mut region = Region::new(&mesh, &near, &patch, n, 2, &HashSet::new()).unwrap();
        let mut faces_after = |max_faces| {
            let target = Target { edge_length: None, max_faces, rounds: 4 };
            resample(&mut region, &Kept::ridges(1.0), &target, &progress).unwrap();
            assert!(region.patch_faces().all(|(f, _)| norm(region.mesh.area_vector(f)) > 0.0));
            region.patch_faces().count()
        };
        let counts = [faces_after(1500), faces_after(1500), faces_after(100_000)];
        assert!(counts[0] < 2500 && counts[1] < 2500, "{counts:?}");
        assert!(counts[2] > 5000, "{counts:?}");
    }
}
