//! The patch with edges as long as those of its rim again, its ridges kept.

use super::region::Region;
use crate::mesh::vector::distance;
use crate::progress::Progress;
use crate::remesh::curves::Keep;
use crate::remesh::editable::Edge;
use crate::remesh::isotropic::run;
use crate::remesh::remesher::{Remesher, Surface};
use crate::remesh::sizing::Sizing;
use crate::remesh::EditableMesh;
use crate::Result;

/// Remeshes the patch [Botsch and Kobbelt 2004] in `rounds` rounds: where vertices have met on a ridge edges collapse, where the
/// ridge has stretched the patch they split. Edges bent by more than `ridge` radians stay as curves.
pub(super) fn resample(
    region: &mut Region,
    edge_length: Option<f64>,
    ridge: f64,
    rounds: usize,
    progress: &Progress,
) -> Result<()> {
    let (points, faces, rim) = region.patch();
    let n = rim.len();
    let mut mesh = EditableMesh::new(points, faces)?;
    let place = |v: u32| rim.binary_search(&v).ok().map(|i| i as u32);
    let outside = |&[a, b]: &[u32; 2]| match region.mesh.edge(a, b) {
        Edge::Border(f, _) => !region.is_patch(f),
        Edge::Interior(wings) => wings.faces.iter().all(|&f| !region.is_patch(f)),
        Edge::NonManifold => true,
        Edge::None => false,
    };
    let edges = region.mesh.edges().into_iter().filter(outside).chain(region.forbidden.iter().copied());
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
    let surface = Surface::of(&mesh);
    let fixed: Vec<bool> = (0..mesh.n_vertices()).map(|v| v < n).collect();
    let keep = Keep { fixed: &fixed, fixed_faces: false, feature_cosine: ridge.cos() };
    let typical = typical_edge(&mesh);
    let mut remesher = Remesher::new(mesh, &surface, &keep, |mesh, curves| match edge_length {
        Some(length) => Sizing::uniform(length, 0.0, mesh, curves),
        None => Sizing::graded(vec![typical; mesh.n_vertices()], 0.0, mesh, curves),
    });
    run(&mut remesher, rounds, &progress.quiet())?;
    let (points, faces, _) = remesher.mesh.into_parts(|v| (v as usize) < n);
    Ok(region.replace_patch(&points, &faces, &rim)?)
}

/// The mean edge length.
pub(super) fn typical_edge(mesh: &EditableMesh) -> f64 {
    let edges = mesh.edges();
    let sum: f64 = edges.iter().map(|&[a, b]| distance(mesh.position(a), mesh.position(b))).sum();
    sum / f64::max(edges.len() as f64, 1.0)
}
