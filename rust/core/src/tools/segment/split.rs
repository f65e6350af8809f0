//! Segmenting a mesh whose faces were split at T-junctions: what comes out is given back for its faces.

use super::options::SegmentOptions;
use super::segmentation::{boundary_edges, Segmentation};
use super::surface::contiguous;
use crate::mesh::{triangle, Mesh, SplitFaces};

/// The options for the parts of faces: what was asked for a face holds for its parts, and for an edge too; a
/// border through a face costs as much as its edges do on average.
pub(super) fn options_of_parts(split: &SplitFaces, options: &SegmentOptions) -> SegmentOptions {
    let of_edge = |weights: &Vec<[f64; 3]>, f: usize| {
        let own = weights[split.parent[f] as usize];
        let mean = own.iter().sum::<f64>() / 3.0;
        split.edge[f].map(|h| h.map_or(mean, |h| own[h as usize % 3]))
    };
    SegmentOptions {
        face_weights: options
            .face_weights
            .as_ref()
            .map(|w| split.parent.iter().map(|&f| w[f as usize]).collect()),
        edge_weights: options
            .edge_weights
            .as_ref()
            .map(|w| (0..split.parent.len()).map(|f| of_edge(w, f)).collect()),
        faces: options.faces.as_ref().map(|mask| split.parent.iter().map(|&f| mask[f as usize]).collect()),
        ..options.clone()
    }
}

/// The segmentation of `mesh` from that of its parts: each face is what the largest of its parts is.
pub(super) fn of_whole_faces(split: &SplitFaces, mesh: &Mesh, found: Segmentation) -> Segmentation {
    let area = |f: u32| triangle::area(split.mesh.edge_lengths()[f as usize]);
    let mut largest: Vec<u32> = Vec::with_capacity(mesh.connectivity().n_faces());
    for (f, &parent) in (0..).zip(&split.parent) {
        match largest.get_mut(parent as usize) {
            Some(held) if area(f) > area(*held) => *held = f,
            Some(_) => {}
            None => largest.push(f),
        }
    }
    let hierarchy = found.hierarchy.picked(&largest);
    let picked: Vec<i32> = largest.iter().map(|&f| found.labels[f as usize]).collect();
    let used: Vec<u32> =
        picked.iter().filter(|label| **label >= 0).map(|label| label.cast_unsigned()).collect();
    let (renamed, n_segments) = contiguous(&used);
    let mut renamed = renamed.into_iter();
    let labels: Vec<i32> = picked
        .iter()
        .map(|&label| if label < 0 { -1 } else { renamed.next().map_or(-1, u32::cast_signed) })
        .collect();
    Segmentation {
        boundary_edges: boundary_edges(mesh, &labels),
        labels,
        n_segments,
        indicator: largest.iter().map(|&f| found.indicator[f as usize]).collect(),
        hierarchy,
        ..found
    }
}
