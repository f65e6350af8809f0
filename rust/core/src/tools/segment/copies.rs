//! Faces that lie on others with the same three vertices, as second lids do: segmented once, so that edges
//! with three faces are no borders there.

use super::segmentation::Segmentation;
use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

/// Faces that are there more than once.
pub(super) struct Copies {
    /// Which face each face is, the first of its copies.
    first: Vec<u32>,
}

impl Copies {
    /// The copies among the `faces` that take part; nothing where there are none.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn among(connectivity: &Connectivity, faces: Option<&[bool]>) -> Result<Option<Self>> {
        if !connectivity.has_any(&[EdgeKind::NonManifold]) {
            return Ok(None);
        }
        let takes_part = |f: u32| faces.is_none_or(|mask| mask[f as usize]);
        let sorted = |(f, &(mut key)): (u32, &[u32; 3])| {
            key.sort_unstable();
            (key, f)
        };
        let taken = (0..).zip(connectivity.faces()).filter(|&(f, _)| takes_part(f));
        let mut keys: Vec<([u32; 3], u32)> = memory::sifted(taken.map(sorted))?;
        keys.sort_unstable();
        let mut first = memory::numbers(connectivity.n_faces())?;
        for same in keys.chunk_by(|a, b| a.0 == b.0) {
            same.iter().for_each(|&(_, f)| first[f as usize] = same[0].1);
        }
        Ok((0..).zip(&first).any(|(f, &first): (u32, _)| f != first).then_some(Self { first }))
    }

    /// The faces that take part without their copies.
    pub(super) fn others(&self, faces: Option<&[bool]>) -> Result<Vec<bool>> {
        let takes_part = |f: u32| faces.is_none_or(|mask| mask[f as usize]);
        let kept =
            (0..self.first.len() as u32).zip(&self.first).map(|(f, &first)| f == first && takes_part(f));
        Ok(memory::gathered(kept)?)
    }

    /// A segmentation in which copies are what the face is that they are copies of.
    pub(super) fn given(&self, found: Segmentation) -> Result<Segmentation> {
        Ok(Segmentation {
            labels: memory::gathered(self.first.iter().map(|&f| found.labels[f as usize]))?,
            indicator: memory::gathered(self.first.iter().map(|&f| found.indicator[f as usize]))?,
            hierarchy: found.hierarchy.picked(&self.first)?,
            ..found
        })
    }
}
