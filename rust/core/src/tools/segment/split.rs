//! Segmenting a mesh whose faces were split at T-junctions: what comes out is given back for its faces.

use super::options::SegmentOptions;
use super::segmentation::{boundary_edges, Segmentation};
use crate::mesh::partition::contiguous;
use crate::mesh::{triangle, Mesh, SplitFaces};
use crate::{memory, Result};

/// The options for the parts of faces: what was asked for a face holds for its parts, and for an edge too; a
/// border through a face costs as much as its edges do on average.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing, here and below.
pub(super) fn options_of_parts(split: &SplitFaces, options: &SegmentOptions) -> Result<SegmentOptions> {
    let of_edge = |weights: &Vec<[f64; 3]>, f: usize| {
        let own = weights[split.parent[f] as usize];
        let mean = own.iter().sum::<f64>() / 3.0;
        split.edge[f].map(|h| h.map_or(mean, |h| own[h as usize % 3]))
    };
    let of_face = |w: &Vec<f64>| memory::gathered(split.parent.iter().map(|&f| w[f as usize]));
    let of_edges = |w: &Vec<[f64; 3]>| memory::gathered((0..split.parent.len()).map(|f| of_edge(w, f)));
    let of_mask = |mask: &Vec<bool>| memory::gathered(split.parent.iter().map(|&f| mask[f as usize]));
    Ok(SegmentOptions {
        face_weights: options.face_weights.as_ref().map(of_face).transpose()?,
        edge_weights: options.edge_weights.as_ref().map(of_edges).transpose()?,
        faces: options.faces.as_ref().map(of_mask).transpose()?,
        ..options.without_arrays()
    })
}

/// The segmentation of `mesh` from that of its parts: each face is what the largest of its parts is.
pub(super) fn of_whole_faces(split: &SplitFaces, mesh: &Mesh, found: Segmentation) -> Result<Segmentation> {
    let area = |f: u32| triangle::area(split.mesh.edge_lengths()[f as usize]);
    let mut largest: Vec<u32> = memory::room(mesh.connectivity().n_faces())?;
    for (f, &parent) in (0..).zip(&split.parent) {
        match largest.get_mut(parent as usize) {
            Some(held) if area(f) > area(*held) => *held = f,
            Some(_) => {}
            None => memory::push(&mut largest, f)?,
        }
    }
    let hierarchy = found.hierarchy.picked(&largest)?;
    let picked: Vec<i32> = memory::gathered(largest.iter().map(|&f| found.labels[f as usize]))?;
    let used = picked.iter().filter(|label| **label >= 0).map(|label| label.cast_unsigned());
    let (renamed, n_segments) = contiguous(&memory::sifted(used)?)?;
    let mut renamed = renamed.into_iter();
    let label = |&label: &i32| if label < 0 { -1 } else { renamed.next().map_or(-1, u32::cast_signed) };
    let labels: Vec<i32> = memory::gathered(picked.iter().map(label))?;
    Ok(Segmentation {
        boundary_edges: boundary_edges(mesh, &labels)?,
        labels,
        n_segments,
        indicator: memory::gathered(largest.iter().map(|&f| found.indicator[f as usize]))?,
        hierarchy,
        ..found
    })
}
