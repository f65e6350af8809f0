//! Facets that cannot stay are not made: the merges that made them are taken back.

use std::collections::{HashMap, HashSet};

use super::constants::{STRIKES, TRIES};
use super::faults::Unsound;
use super::hierarchy::{Cut, Hierarchy};
use super::regions::Regions;
use super::shape::Shape;
use crate::{memory, Result};

/// What is not to be merged.
#[derive(Debug)]
pub(super) struct Refusals {
    /// Faces that stay as they are, or whose neighbors do.
    pub is_held: Vec<bool>,
    /// Whether facets that cross are repaired before what made them is refused: not once faults spread by
    /// that.
    pub are_repaired: bool,
    /// How often each face was in a facet that could not stay.
    strikes: Vec<u32>,
    /// The same of vertices that were its corners.
    at_corners: HashMap<u32, u32>,
}

impl Refusals {
    /// None yet, beside faces that are held.
    pub(super) fn new(is_held: &[bool]) -> Result<Self> {
        Ok(Self {
            is_held: memory::twin(is_held)?,
            are_repaired: true,
            strikes: memory::repeated(0, is_held.len())?,
            at_corners: HashMap::new(),
        })
    }

    /// How firmly a corner at this vertex is held.
    pub(super) fn firmness(&self, vertex: u32) -> f64 {
        let strikes = self.at_corners.get(&vertex).copied().unwrap_or(0);
        TRIES.factor.powi(strikes.min(STRIKES) as i32)
    }

    /// Takes back what made the unsound facets of `shape`, which was made of the regions of a cut: of
    /// those that touch, what was merged last. One merge of a region at first; where that does not do, three,
    /// seven, …; at last, or at once where `all` are to, all of them. What is one face then stays where it is
    /// on the mesh: returned.
    pub(super) fn refuse(
        &mut self,
        (tree, cut): (&Hierarchy, &mut Cut),
        shape: &Shape,
        unsound: &Unsound,
        all: bool,
    ) -> Result<Vec<u32>> {
        let nodes = tree.nodes(cut)?;
        let node = |k: u32| nodes[shape.facets[k as usize].part as usize];
        let chosen = if all { memory::twin(&unsound.facets)? } else { unsound.latest(shape, node)? };
        let struck = memory::distinct(chosen.iter().map(|&k| node(k)))?;
        let mut left: HashMap<u32, u32> = HashMap::new();
        let mut stay = Vec::new();
        for (f, node) in (0..).zip(&nodes).filter(|(_, node)| struck.contains(node)) {
            self.strikes[f as usize] += 1;
            let strikes = self.strikes[f as usize];
            let is_last = all || strikes > STRIKES;
            memory::extend_map(&mut left, 1)?;
            let most = left.entry(*node).or_default();
            *most = (*most).max(if is_last { u32::MAX } else { (1 << strikes) - 1 });
            if is_last || tree.is_face(*node) {
                memory::push(&mut stay, f)?;
            }
        }
        for c in memory::distinct(chosen.iter().flat_map(|&k| shape.facets[k as usize].corners()))? {
            memory::extend_map(&mut self.at_corners, 1)?;
            *self.at_corners.entry(shape.corners[c as usize].vertex).or_default() += 1;
        }
        for (node, most) in left {
            let mut within: Cut = [node].into();
            for _ in 0..most {
                let Some(&latest) = within.last().filter(|node| !tree.is_face(**node)) else { break };
                tree.split(&mut within, latest);
            }
            cut.remove(&node);
            cut.extend(within);
        }
        Ok(stay)
    }

    /// Takes back all merges of faces that are held, and those that what remains cannot be facets beside.
    pub(super) fn close<'a>(
        &self,
        (tree, cut): (&Hierarchy, &mut Cut),
        regions: impl Fn(&[u32], usize) -> Result<Regions<'a>>,
    ) -> Result<()> {
        loop {
            let nodes = tree.nodes(cut)?;
            let is_merged = |&(f, node): &(usize, u32)| self.is_held[f] && !tree.is_face(node);
            let merged = (0..).zip(nodes).filter(is_merged).map(|(_, node)| node);
            let merged: HashSet<u32> = memory::distinct(merged)?;
            if merged.is_empty() {
                return tree.close(cut, regions);
            }
            merged.into_iter().for_each(|node| tree.split(cut, node));
        }
    }
}
