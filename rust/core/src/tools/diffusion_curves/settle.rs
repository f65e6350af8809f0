//! Faces for vertices: every vertex has a face of its region, and the borders between are short.

use super::constants::{REGION_ROUNDS, SHORTER_BY};
use super::groups::{majority, Groups};
use crate::mesh::{Connectivity, Mesh};

/// Labels of faces that are changed, and which region each vertex has the color of.
pub(super) struct Faces<'a> {
    connectivity: &'a Connectivity,
    lengths: &'a [[f64; 3]],
    groups: &'a Groups,
    regions: &'a [Option<i32>],
    labels: &'a mut [i32],
    /// For every vertex with a region the number of its corners in faces of it.
    covers: Vec<u32>,
    /// The faces around every vertex.
    around: Vec<Vec<u32>>,
    /// For every vertex twice the number of its edges on borders; a rim counts once on each side of the
    /// vertex. Kept, since around one vertex of thousands of faces it would be counted for each of them.
    ends: Vec<u32>,
}

impl<'a> Faces<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        groups: &'a Groups,
        regions: &'a [Option<i32>],
        labels: &'a mut [i32],
    ) -> Self {
        let connectivity = mesh.connectivity();
        let mut covers = vec![0; regions.len()];
        let mut around = vec![Vec::new(); regions.len()];
        for ((f, face), &label) in (0..).zip(connectivity.faces()).zip(labels.iter()) {
            face.iter().for_each(|&v| around[v as usize].push(f));
            face.iter()
                .filter(|&&v| regions[v as usize] == Some(label))
                .for_each(|&v| covers[v as usize] += 1);
        }
        let (lengths, ends) = (mesh.edge_lengths(), vec![0; regions.len()]);
        let mut faces = Self { connectivity, lengths, groups, regions, labels, covers, around, ends };
        for h in 0..connectivity.n_halfedges() {
            if faces.is_border(h) {
                faces.at_ends(h, |count| *count += 1);
            }
        }
        faces
    }

    /// Gives every group of faces without a vertex of its region to the region of most of its vertices;
    /// returns whether any changed.
    pub(super) fn follow(&mut self) -> bool {
        let mut changed = false;
        for group in 0..self.groups.members.len() {
            let found: Vec<i32> = self.corners(group).filter_map(|v| self.regions[v as usize]).collect();
            if !found.is_empty() && !found.contains(&self.label(group)) {
                self.set(group, majority(found));
                changed = true;
            }
        }
        changed
    }

    /// Gives every vertex that is `sure` of its region, and has no face of it, one of those around it, which
    /// no other vertex needs; of several the one that makes the borders shortest. Returns whether any
    /// changed.
    pub(super) fn cover(&mut self, sure: impl Fn(usize) -> bool) -> bool {
        let mut changed = false;
        for v in 0..self.regions.len() {
            let Some(region) = self.regions[v].filter(|_| self.covers[v] == 0 && sure(v)) else { continue };
            let groups = self.around[v].iter().map(|&f| self.groups.of[f as usize] as usize);
            let able = groups.filter(|&group| !self.is_needed(group));
            let change = |group: usize| (group, self.change(group, region)[1]);
            let best = able.map(change).min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            if let Some((group, _)) = best {
                self.set(group, region);
                changed = true;
            }
        }
        changed
    }

    /// Shortens the borders by giving groups of faces to other regions that their vertices belong to. An edge
    /// of a border more than two at a vertex counts as much as all edges around the group, so that regions
    /// are not pinched off where it can be helped.
    pub(super) fn shorten(&mut self) {
        for _ in 0..REGION_ROUNDS {
            let mut changed = false;
            for group in 0..self.groups.members.len() {
                let old = self.label(group);
                let mut others: Vec<i32> =
                    self.corners(group).filter_map(|v| self.regions[v as usize]).collect();
                others.sort_unstable();
                others.dedup();
                others.retain(|&region| region != old);
                if others.is_empty() || self.is_needed(group) {
                    continue;
                }
                let before = self.pinches(group);
                let mut best = (-SHORTER_BY, old);
                for region in others {
                    let [around, change] = self.change(group, region);
                    self.set(group, region);
                    let pinched = self.pinches(group) - before;
                    self.set(group, old);
                    let worse = change / around.max(f64::MIN_POSITIVE) + pinched;
                    best = if worse < best.0 { (worse, region) } else { best };
                }
                if best.1 != old {
                    self.set(group, best.1);
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    fn label(&self, group: usize) -> i32 {
        self.labels[self.groups.members[group][0] as usize]
    }

    fn corners(&self, group: usize) -> impl Iterator<Item = u32> + '_ {
        self.groups.members[group].iter().flat_map(|&f| self.connectivity.faces()[f as usize])
    }

    /// Whether a vertex would be left without a face of its region.
    fn is_needed(&self, group: usize) -> bool {
        let label = self.label(group);
        let here = |v: u32| self.corners(group).filter(|&u| u == v).count() as u32;
        self.corners(group)
            .any(|v| self.regions[v as usize] == Some(label) && self.covers[v as usize] <= here(v))
    }

    /// The length of the edges around a group, and how much longer borders become if it goes over to
    /// `region`.
    fn change(&self, group: usize, region: i32) -> [f64; 2] {
        let mut sums = [0.0, 0.0];
        for h in self.groups.members[group].iter().flat_map(|&f| 3 * f as usize..3 * f as usize + 3) {
            let Some(mate) =
                self.connectivity.mate(h).filter(|mate| self.groups.of[mate / 3] as usize != group)
            else {
                continue;
            };
            let (length, other) = (self.lengths[h / 3][h % 3], self.labels[mate / 3]);
            sums[0] += length;
            sums[1] += length * f64::from(i8::from(other != region) - i8::from(other != self.label(group)));
        }
        sums
    }

    /// How many edges of borders more than two there are at the vertices of a group.
    fn pinches(&self, group: usize) -> f64 {
        self.corners(group).map(|v| self.borders_at(v).saturating_sub(2) as f64).sum()
    }

    /// The edges of borders at a vertex, and one for the rim of the mesh: every edge is seen from both of its
    /// faces, those of a rim from one.
    fn borders_at(&self, v: u32) -> usize {
        self.ends[v as usize] as usize / 2
    }

    fn is_border(&self, h: usize) -> bool {
        self.connectivity.mate(h).is_none_or(|mate| self.labels[mate / 3] != self.labels[h / 3])
    }

    /// Changes the counts of the vertices that a halfedge joins.
    fn at_ends(&mut self, h: usize, change: impl Fn(&mut u32)) {
        for v in self.connectivity.faces()[h / 3] {
            if self.connectivity.opposite(h) != v {
                change(&mut self.ends[v as usize]);
            }
        }
    }

    /// Gives one face to a region.
    fn give(&mut self, f: u32, region: i32) {
        for h in 3 * f as usize..3 * f as usize + 3 {
            let Some(mate) = self.connectivity.mate(h) else { continue };
            if mate / 3 == h / 3 {
                continue;
            }
            let (was, is) = (self.is_border(h), self.labels[mate / 3] != region);
            for side in [h, mate] {
                match (was, is) {
                    (false, true) => self.at_ends(side, |count| *count += 1),
                    (true, false) => self.at_ends(side, |count| *count -= 1),
                    _ => {}
                }
            }
        }
        self.labels[f as usize] = region;
    }

    fn set(&mut self, group: usize, region: i32) {
        let old = self.label(group);
        let groups = self.groups;
        for &f in &groups.members[group] {
            self.give(f, region);
            for &v in &self.connectivity.faces()[f as usize] {
                if self.regions[v as usize] == Some(old) {
                    self.covers[v as usize] -= 1;
                } else if self.regions[v as usize] == Some(region) {
                    self.covers[v as usize] += 1;
                }
            }
        }
    }
}
