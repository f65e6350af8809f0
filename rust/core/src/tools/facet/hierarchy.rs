//! The merges as a tree: a region is a node, and what it was made of are the nodes below.

use std::collections::{BTreeSet, HashMap};

use super::merging::Merges;
use super::moments::Moments;
use super::regions::Regions;
use crate::mesh::partition::Partition;
use crate::{memory, Result};

/// Nodes below `n` are faces; the others come in the order in which they were made.
#[derive(Debug)]
pub(super) struct Hierarchy {
    n: usize,
    /// Of each node that is no face: the nodes that it was made of.
    made: Vec<Vec<u32>>,
}

/// Disjoint nodes that hold all faces.
pub(super) type Cut = BTreeSet<u32>;

impl Hierarchy {
    /// The tree of the first `n_merges` that were made of `n` faces, and the regions that they leave. What
    /// was made at once is whole.
    pub(super) fn new(merges: &Merges, n: usize, n_merges: usize) -> Result<(Self, Cut)> {
        let n_merges = (0..=n_merges).rev().find(|&i| i == 0 || merges.is_last[i - 1]).unwrap_or(0);
        let mut sets = Partition::new(n)?;
        let mut node: Vec<u32> = memory::numbers(n)?;
        let mut cut: Cut = node.iter().copied().collect();
        let mut made = Vec::new();
        let mut parts = BTreeSet::new();
        for (i, &[kept, gone]) in merges.pairs[..n_merges].iter().enumerate() {
            let of = [kept, gone].map(|f| node[sets.root(f) as usize]);
            // In the midst of several merges the node is not made yet.
            parts.extend(of.into_iter().filter(|part| cut.remove(part)));
            sets.unite(kept, gone);
            let fresh = (n + made.len()) as u32;
            node[sets.root(kept) as usize] = fresh;
            if merges.is_last[i] {
                let whole = memory::gathered(std::mem::take(&mut parts))?;
                memory::push(&mut made, whole)?;
                cut.insert(fresh);
            }
        }
        Ok((Self { n, made }, cut))
    }

    /// What a node was made of; nothing where it is a face.
    fn parts(&self, node: u32) -> &[u32] {
        (node as usize).checked_sub(self.n).map_or(&[], |i| self.made[i].as_slice())
    }

    pub(super) fn is_face(&self, node: u32) -> bool {
        (node as usize) < self.n
    }

    /// Puts the parts of a node in its place.
    pub(super) fn split(&self, cut: &mut Cut, node: u32) {
        if !self.is_face(node) && cut.remove(&node) {
            cut.extend(self.parts(node));
        }
    }

    /// The nodes from this one on are made when fewer than `count` regions are left.
    pub(super) fn above(&self, merges: &Merges, count: usize) -> u32 {
        let n_made = merges.is_last[..self.n - count].iter().filter(|is_last| **is_last).count();
        (self.n + n_made) as u32
    }

    /// Splits a node into those below `above`.
    pub(super) fn split_to(&self, cut: &mut Cut, node: u32, above: u32) {
        let mut within: Cut = [node].into();
        if cut.remove(&node) {
            while let Some(&latest) = within.last().filter(|latest| **latest >= above.max(self.n as u32)) {
                self.split(&mut within, latest);
            }
            cut.extend(within);
        }
    }

    /// Puts in the place of every node that is `beyond`, by the moments of its faces, the largest nodes below
    /// it that are not.
    pub(super) fn split_beyond(
        &self,
        cut: &mut Cut,
        of_faces: &[Moments],
        is_beyond: impl Fn(&Moments) -> bool,
    ) -> Result<()> {
        let mut of_made: Vec<Moments> = memory::room(self.made.len())?;
        let of = |node: u32, of_made: &[Moments]| match (node as usize).checked_sub(self.n) {
            Some(i) => of_made[i],
            None => of_faces[node as usize],
        };
        for parts in &self.made {
            let sum = parts.iter().fold(Moments::default(), |sum, &part| sum.plus(&of(part, &of_made)));
            of_made.push(sum);
        }
        let mut stack: Vec<u32> = memory::gathered(cut.iter().copied())?;
        while let Some(node) = stack.pop() {
            if !self.is_face(node) && is_beyond(&of(node, &of_made)) {
                self.split(cut, node);
                memory::extend(&mut stack, self.parts(node).len())?;
                stack.extend(self.parts(node));
            }
        }
        Ok(())
    }

    /// The node of the cut that holds each face.
    pub(super) fn nodes(&self, cut: &Cut) -> Result<Vec<u32>> {
        let mut nodes = memory::repeated(0, self.n)?;
        for &top in cut {
            let mut stack = vec![top];
            while let Some(node) = stack.pop() {
                memory::extend(&mut stack, self.parts(node).len())?;
                stack.extend(self.parts(node));
                if self.is_face(node) {
                    nodes[node as usize] = top;
                }
            }
        }
        Ok(nodes)
    }

    /// The regions of a cut, numbered in the order of their first faces, and their nodes.
    pub(super) fn labels(&self, cut: &Cut) -> Result<(Vec<u32>, Vec<u32>)> {
        let nodes = self.nodes(cut)?;
        let (mut names, mut tops) = (HashMap::new(), memory::room(cut.len())?);
        memory::extend_map(&mut names, cut.len())?;
        let mut name = |node: &u32| {
            *names.entry(*node).or_insert_with(|| {
                tops.push(*node);
                tops.len() as u32 - 1
            })
        };
        let labels = memory::gathered(nodes.iter().map(&mut name))?;
        Ok((labels, tops))
    }

    /// Splits nodes until all can be facets beside each other, always the latest of those in the way: where
    /// all are as when a node was made, it can.
    pub(super) fn close<'a>(
        &self,
        cut: &mut Cut,
        regions: impl Fn(&[u32], usize) -> Result<Regions<'a>>,
    ) -> Result<()> {
        loop {
            let (labels, tops) = self.labels(cut)?;
            let regions = regions(&labels, tops.len())?;
            let latest = |of: Vec<u32>| of.into_iter().map(|r| tops[r as usize]).max();
            let mut split: BTreeSet<u32> = BTreeSet::new();
            for region in 0..tops.len() as u32 {
                let node = regions.in_the_way(region)?.and_then(latest);
                split.extend(node.filter(|&node| !self.is_face(node)));
            }
            if split.is_empty() {
                return Ok(());
            }
            split.into_iter().for_each(|node| self.split(cut, node));
        }
    }
}
