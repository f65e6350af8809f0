//! From the finest segmentation to one segment for each connected part: nested, one merge after the other.

use crate::mesh::partition::contiguous;
use crate::mesh::partition::Partition;
use crate::{memory, Error, Result};

/// Nested segmentations of any size.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hierarchy {
    /// The segment of every face in the finest segmentation; `u32::MAX` for faces that took no part.
    leaves: Vec<u32>,
    n_leaves: usize,
    /// The pairs that merge, in order: the second segment becomes part of the first.
    merges: Vec<[u32; 2]>,
    strengths: Vec<f64>,
}

impl Hierarchy {
    /// `leaves` are contiguous labels; of each merge the segment kept, the one gone, and the strength.
    pub(in crate::tools) fn new(
        leaves: Vec<u32>,
        n_leaves: usize,
        merges: impl IntoIterator<Item = ([u32; 2], f64)>,
    ) -> Self {
        let (merges, strengths) = merges.into_iter().unzip();
        Self { leaves, n_leaves, merges, strengths }
    }

    /// The segment of every face in the finest segmentation.
    pub(in crate::tools) fn leaves(&self) -> &[u32] {
        &self.leaves
    }

    /// The merges in order: of each the segment kept, the one gone, and the strength.
    pub(in crate::tools) fn merges(&self) -> impl Iterator<Item = ([u32; 2], f64)> + '_ {
        self.merges.iter().copied().zip(self.strengths.iter().copied())
    }

    /// The same where no border is weaker than one that fell before it.
    pub(in crate::tools) fn ascending(mut self) -> Self {
        let mut most = 0.0_f64;
        for strength in &mut self.strengths {
            most = most.max(*strength);
            *strength = most;
        }
        self
    }

    /// The same for a mesh of which only some faces took part:
    /// face `i` of this hierarchy is face `faces[i]` there, of `n_faces`.
    pub(in crate::tools) fn spread(mut self, faces: &[u32], n_faces: usize) -> Result<Self> {
        let mut leaves = memory::repeated(u32::MAX, n_faces)?;
        for (&face, leaf) in faces.iter().zip(&self.leaves) {
            leaves[face as usize] = *leaf;
        }
        self.leaves = leaves;
        Ok(self)
    }

    /// The same for faces that are each one of those here, `faces[i]`. Segments without a face are none.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing.
    pub(in crate::tools) fn picked(&self, faces: &[u32]) -> Result<Self> {
        let picked: Vec<u32> = memory::gathered(faces.iter().map(|&f| self.leaves[f as usize]))?;
        // The fresh name of each segment that is there,
        // which moves on to the segment that it becomes part of.
        let mut name = memory::repeated(u32::MAX, self.n_leaves)?;
        let mut count = 0;
        let leaves: Vec<u32> = memory::gathered(picked.iter().map(|&leaf| {
            let Some(name) = name.get_mut(leaf as usize) else { return u32::MAX };
            if *name == u32::MAX {
                *name = count;
                count += 1;
            }
            *name
        }))?;
        let mut there = Self { leaves, n_leaves: count as usize, merges: Vec::new(), strengths: Vec::new() };
        for (&[kept, gone], &strength) in self.merges.iter().zip(&self.strengths) {
            let (a, b) = (name[kept as usize], name[gone as usize]);
            if a == u32::MAX {
                name[kept as usize] = b;
            } else if b != u32::MAX {
                memory::push(&mut there.merges, [a, b])?;
                memory::push(&mut there.strengths, strength)?;
            }
        }
        Ok(there)
    }

    /// For every face the first one of the same segment in the finest segmentation; all must take part.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing, here and below.
    pub(in crate::tools) fn first_faces(&self) -> Result<Vec<u32>> {
        let mut first = memory::repeated(u32::MAX, self.n_leaves)?;
        Ok(memory::gathered(self.leaves.iter().enumerate().map(|(f, &leaf)| {
            let first = &mut first[leaf as usize];
            *first = (*first).min(f as u32);
            *first
        }))?)
    }

    /// The same where the pairs of segments `joined`, each named by a face of both, are joined first of the
    /// `n_segments` that there are then.
    pub(in crate::tools) fn joined(
        &self,
        n_segments: usize,
        joined: impl Iterator<Item = ([u32; 2], f64)>,
    ) -> Result<Self> {
        let inner = self.n_leaves.saturating_sub(n_segments).min(self.merges.len());
        let own = self.merges.iter().copied().zip(self.strengths.iter().copied());
        let joined = joined.map(|(pair, strength)| (pair.map(|f| self.leaves[f as usize]), strength));
        let all = own.clone().take(inner).chain(joined).chain(own.skip(inner));
        let mut segments = Partition::new(self.n_leaves)?;
        let (mut merges, mut strengths) =
            (memory::room(self.merges.len())?, memory::room(self.merges.len())?);
        for (pair, strength) in all {
            let [kept, gone] = pair.map(|leaf| segments.root(leaf));
            if kept != gone {
                segments.attach(gone, kept);
                merges.push([kept, gone]);
                strengths.push(strength);
            }
        }
        let leaves = memory::twin(&self.leaves)?;
        Ok(Self { leaves, n_leaves: self.n_leaves, merges, strengths })
    }

    /// Most and fewest segments that there can be: those of the finest segmentation,
    /// and one for each connected part.
    #[must_use]
    pub fn range(&self) -> [usize; 2] {
        [self.n_leaves, self.n_leaves - self.merges.len()]
    }

    /// The strength of the border that falls with each merge, from the finest segmentation on.
    #[must_use]
    pub fn strengths(&self) -> &[f64] {
        &self.strengths
    }

    /// The segmentation with `n_segments` segments, or the nearest number that there is: a label for every
    /// face, from 0 in the order of their first faces, −1 for faces that took no part. Nested: with fewer
    /// segments, borders only vanish.
    ///
    /// # Errors
    /// [`Error::Argument`] for no segments at all.
    pub fn labels_at(&self, n_segments: usize) -> Result<Vec<i32>> {
        if n_segments == 0 {
            return Err(Error::argument("n_segments", "is 0; ask for at least one segment"));
        }
        let count = self.n_leaves.saturating_sub(n_segments).min(self.merges.len());
        let mut name = memory::numbers(self.n_leaves)?;
        for &[kept, gone] in self.merges[..count].iter().rev() {
            name[gone as usize] = name[kept as usize];
        }
        let used = self.leaves.iter().filter(|l| **l != u32::MAX).map(|&l| name[l as usize]);
        let mut renamed = contiguous(&memory::sifted(used)?)?.0.into_iter();
        let label =
            |leaf: &u32| if *leaf == u32::MAX { -1 } else { renamed.next().map_or(-1, u32::cast_signed) };
        Ok(memory::gathered(self.leaves.iter().map(label))?)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn takes_as_many_merges_as_it_needs() {
        let merges = [([0, 1], 0.3), ([2, 3], 0.2), ([0, 2], 0.5)];
        let hierarchy = Hierarchy::new(vec![0, 1, 2, 3, 0], 4, merges).ascending();
        assert_eq!(hierarchy.range(), [4, 1]);
        assert_eq!(hierarchy.strengths(), [0.3, 0.3, 0.5]);
        assert_eq!(hierarchy.labels_at(9).unwrap(), [0, 1, 2, 3, 0]);
        assert_eq!(hierarchy.labels_at(3).unwrap(), [0, 0, 1, 2, 0]);
        assert_eq!(hierarchy.labels_at(2).unwrap(), [0, 0, 1, 1, 0]);
        assert_eq!(hierarchy.labels_at(1).unwrap(), [0; 5]);
        assert!(hierarchy.labels_at(0).is_err());
        let spread = hierarchy.spread(&[1, 2, 3, 5, 6], 7).unwrap();
        assert_eq!(spread.labels_at(2).unwrap(), [-1, 0, 0, 1, -1, 1, 0]);
    }

    #[test]
    fn what_is_joined_comes_first_of_what_was_apart() {
        let merges = [([0, 1], 0.3), ([0, 2], 0.5), ([0, 3], 0.6)];
        let hierarchy = Hierarchy::new(vec![0, 1, 1, 2, 3], 4, merges);
        assert_eq!(hierarchy.first_faces().unwrap(), [0, 1, 1, 3, 4]);
        let joined = hierarchy.joined(3, [([1, 4], 0.9)].into_iter()).unwrap().ascending();
        assert_eq!(joined.labels_at(3).unwrap(), [0, 0, 0, 1, 2]);
        assert_eq!(joined.labels_at(2).unwrap(), [0, 0, 0, 1, 0]);
        assert_eq!(joined.labels_at(1).unwrap(), [0; 5]);
        assert_eq!(joined.strengths(), [0.3, 0.9, 0.9]);
    }

    #[test]
    fn segments_without_a_face_are_none() {
        let merges = [([2, 3], 0.2), ([0, 1], 0.3), ([0, 2], 0.5)];
        let hierarchy = Hierarchy::new(vec![0, 1, 2, 3, u32::MAX, 1], 4, merges);
        assert_eq!(hierarchy.picked(&[0, 1, 2, 3, 4, 5]).unwrap(), hierarchy);
        let picked = hierarchy.picked(&[5, 3, 4]).unwrap();
        assert_eq!(picked.range(), [2, 1]);
        assert_eq!(picked.strengths(), [0.5]);
        assert_eq!(picked.labels_at(2).unwrap(), [0, 1, -1]);
        assert_eq!(picked.labels_at(1).unwrap(), [0, 0, -1]);
    }
}
