//! Faces that stay together in one region: the triangles of a polygon.

use std::collections::BTreeMap;

use super::constants::LEAST_ISLAND;
use crate::mesh::partition::Partition;
use crate::mesh::Connectivity;
use crate::{memory, Error, Result};

/// Faces that stay together.
pub(super) struct Groups {
    /// The faces of every group.
    pub members: Vec<Vec<u32>>,
    /// The group of every face.
    pub of: Vec<u32>,
}

impl Groups {
    /// Groups by number; each face by itself where there are none.
    pub(super) fn new(numbers: Option<&[u32]>, n_faces: usize) -> Result<Self> {
        let mut order = memory::numbers(n_faces)?;
        let members: Vec<Vec<u32>> = match numbers {
            None => memory::gathered(order.iter().map(|&f| vec![f]))?,
            Some(numbers) if numbers.len() != n_faces => {
                let problem = format!("has {} entries, expected one per face: {n_faces}", numbers.len());
                return Err(Error::argument("face_groups", problem));
            }
            Some(numbers) => {
                order.sort_unstable_by_key(|&f| (numbers[f as usize], f));
                let same = order.chunk_by(|&a, &b| numbers[a as usize] == numbers[b as usize]);
                memory::sifted(same.map(<[u32]>::to_vec))?
            }
        };
        let mut of = memory::repeated(0, n_faces)?;
        for (g, group) in (0..).zip(&members) {
            group.iter().for_each(|&f| of[f as usize] = g);
        }
        Ok(Self { members, of })
    }

    /// Gives every group the label of most of its faces.
    pub(super) fn unify(&self, labels: &mut [i32]) {
        for group in self.members.iter().filter(|group| group.len() > 1) {
            let label = majority(group.iter().map(|&f| labels[f as usize]).collect());
            self.set(labels, group[0] as usize, label);
        }
    }

    /// Gives the group of a face a label.
    pub(super) fn set(&self, labels: &mut [i32], face: usize, label: i32) {
        self.members[self.of[face] as usize].iter().for_each(|&f| labels[f as usize] = label);
    }

    /// The groups that edges connect within their regions.
    fn pieces(&self, connectivity: &Connectivity, labels: &[i32]) -> Result<Partition> {
        let mut pieces = Partition::new(self.members.len())?;
        for (f, g) in neighbors(connectivity).filter(|&(f, g)| labels[f] == labels[g]) {
            pieces.unite(self.of[f], self.of[g]);
        }
        Ok(pieces)
    }

    /// Makes a region of its own of each part of a region that no edge joins to the rest.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing, here and below.
    pub(super) fn split(&self, connectivity: &Connectivity, labels: &mut [i32]) -> Result<()> {
        let mut pieces = self.pieces(connectivity, labels)?;
        for (label, group) in labels.iter_mut().zip(&self.of) {
            *label = pieces.root(*group) as i32;
        }
        Ok(())
    }

    /// Gives islands of fewer than [`LEAST_ISLAND`] groups, cut off from the rest of their region,
    /// to the region around them.
    pub(super) fn absorb_islands(&self, connectivity: &Connectivity, labels: &mut [i32]) -> Result<()> {
        let mut pieces = self.pieces(connectivity, labels)?;
        let label_of = |piece: u32| labels[self.members[piece as usize][0] as usize];
        let mut sizes = memory::repeated(0, self.members.len())?;
        (0..sizes.len()).for_each(|g| sizes[pieces.root(g as u32) as usize] += 1);
        let mut largest = BTreeMap::new();
        for (piece, &size) in (0..).zip(&sizes) {
            let most = largest.entry(label_of(piece)).or_insert(0);
            *most = size.max(*most);
        }
        let island = |piece: u32| {
            let size = sizes[piece as usize];
            size < LEAST_ISLAND && largest.get(&label_of(piece)).is_some_and(|&most| size < most)
        };
        // The labels beyond each edge of each island.
        let mut around: BTreeMap<u32, Vec<i32>> = BTreeMap::new();
        for (f, g) in neighbors(connectivity).filter(|&(f, g)| labels[f] != labels[g]) {
            let piece = pieces.root(self.of[f]);
            if island(piece) && !island(pieces.root(self.of[g])) {
                around.entry(piece).or_default().push(labels[g]);
            }
        }
        let taken: BTreeMap<u32, i32> =
            around.into_iter().map(|(piece, labels)| (piece, majority(labels))).collect();
        for (g, members) in (0..).zip(&self.members) {
            if let Some(&label) = taken.get(&pieces.root(g)) {
                members.iter().for_each(|&f| labels[f as usize] = label);
            }
        }
        Ok(())
    }
}

/// The faces on both sides of every edge that joins two, once from each.
fn neighbors(connectivity: &Connectivity) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..connectivity.n_halfedges()).filter_map(|h| connectivity.mate(h).map(|mate| (h / 3, mate / 3)))
}

/// The label that occurs most often, the least of equals.
pub(super) fn majority(mut labels: Vec<i32>) -> i32 {
    labels.sort_unstable();
    let runs = labels.chunk_by(i32::eq).map(|run| (run.len(), run[0]));
    runs.reduce(|best, run| if run.0 > best.0 { run } else { best }).map_or(0, |(_, label)| label)
}
