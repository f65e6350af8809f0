//! Faces that lie on others with the same three vertices, as second lids do: segmented once, so that edges
//! with three faces are no borders there.

use super::segmentation::Segmentation;
use crate::mesh::{Connectivity, EdgeKind};

/// Faces that are there more than once.
pub(super) struct Copies {
    /// Which face each face is, the first of its copies.
    first: Vec<u32>,
}

impl Copies {
    /// The copies among the `faces` that take part; nothing where there are none.
    pub(super) fn among(connectivity: &Connectivity, faces: Option<&[bool]>) -> Option<Self> {
        if !connectivity.has_any(&[EdgeKind::NonManifold]) {
            return None;
        }
        let takes_part = |f: u32| faces.is_none_or(|mask| mask[f as usize]);
        let mut keys: Vec<([u32; 3], u32)> = (0..)
            .zip(connectivity.faces())
            .filter(|&(f, _)| takes_part(f))
            .map(|(f, &(mut key))| {
                key.sort_unstable();
                (key, f)
            })
            .collect();
        keys.sort_unstable();
        let mut first: Vec<u32> = (0..connectivity.n_faces() as u32).collect();
        for same in keys.chunk_by(|a, b| a.0 == b.0) {
            same.iter().for_each(|&(_, f)| first[f as usize] = same[0].1);
        }
        (0..).zip(&first).any(|(f, &first): (u32, _)| f != first).then_some(Self { first })
    }

    /// The faces that take part without their copies.
    pub(super) fn others(&self, faces: Option<&[bool]>) -> Vec<bool> {
        let takes_part = |f: u32| faces.is_none_or(|mask| mask[f as usize]);
        (0..).zip(&self.first).map(|(f, &first)| f == first && takes_part(f)).collect()
    }

    /// A segmentation in which copies are what the face is that they are copies of.
    pub(super) fn given(&self, found: Segmentation) -> Segmentation {
        Segmentation {
            labels: self.first.iter().map(|&f| found.labels[f as usize]).collect(),
            indicator: self.first.iter().map(|&f| found.indicator[f as usize]).collect(),
            hierarchy: found.hierarchy.picked(&self.first),
            ..found
        }
    }
}
