//! Facets that cannot stay are not made: the merges that made them are taken back, and merging goes on
//! without.

use std::collections::{HashMap, HashSet};

use super::constants::{STRIKES, TRIES};
use super::faults::Unsound;
use super::hierarchy::{Cut, Hierarchy};
use super::merging::Merges;
use super::regions::Regions;
use super::shape::Shape;
use crate::{memory, Result};

/// What is not to be merged.
#[derive(Debug)]
pub(super) struct Refusals {
    /// Pairs of faces that are not to be in one facet.
    pub apart: Vec<[u32; 2]>,
    /// Faces that stay as they are, or whose neighbors do.
    pub is_held: Vec<bool>,
    /// How often each face was in a facet that could not stay.
    strikes: Vec<u32>,
    /// The same of vertices that were its corners.
    at_corners: HashMap<u32, u32>,
}

impl Refusals {
    /// None yet, beside faces that are held.
    pub(super) fn new(is_held: Vec<bool>) -> Result<Self> {
        let strikes = memory::repeated(0, is_held.len())?;
        Ok(Self { apart: Vec::new(), strikes, is_held, at_corners: HashMap::new() })
    }

    pub(super) fn n_held(&self) -> usize {
        self.is_held.iter().filter(|held| **held).count()
    }

    /// How firmly a corner at this vertex is held.
    pub(super) fn firmness(&self, vertex: u32) -> f64 {
        let strikes = self.at_corners.get(&vertex).copied().unwrap_or(0);
        TRIES.factor.powi(strikes.min(STRIKES) as i32)
    }

    /// Takes back what made the unsound facets of `shape`, which was made of the regions of a cut: of
    /// those that touch, what was merged last. One merge of a region at first; where that does not do, three,
    /// seven, …; at last, or at once where `all` are to, all of them. What is one face then stays where it is
    /// on the mesh: returned. Then merges are taken back that what remains cannot be facets beside.
    pub(super) fn refuse<'a>(
        &mut self,
        merges: &Merges,
        (tree, mut cut): (Hierarchy, Cut),
        shape: &Shape,
        unsound: &Unsound,
        all: bool,
        regions: impl Fn(&[u32], usize) -> Result<Regions<'a>>,
    ) -> Result<Refused> {
        let nodes = tree.nodes(&cut)?;
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
                let pairs = &merges.pairs[tree.merges(latest)];
                memory::extend(&mut self.apart, pairs.len())?;
                self.apart.extend(pairs);
            }
            cut.remove(&node);
            cut.extend(within);
        }
        Refused { tree, cut, stay }.closed(regions)
    }
}

/// What remains of the merges, and the faces that are to stay as on the mesh.
#[derive(Debug)]
pub(super) struct Refused {
    tree: Hierarchy,
    cut: Cut,
    pub stay: Vec<u32>,
}

impl Refused {
    fn closed<'a>(mut self, regions: impl Fn(&[u32], usize) -> Result<Regions<'a>>) -> Result<Self> {
        self.tree.close(&mut self.cut, regions)?;
        Ok(self)
    }

    /// The merges that remain, `held` faces in none of them.
    pub(super) fn remaining<'a>(
        mut self,
        merges: &Merges,
        held: &[bool],
        regions: impl Fn(&[u32], usize) -> Result<Regions<'a>>,
    ) -> Result<Merges> {
        loop {
            let nodes = self.tree.nodes(&self.cut)?;
            let merged = (0..).zip(nodes).filter(|&(f, node)| held[f as usize] && !self.tree.is_face(node));
            let merged: HashSet<u32> = memory::distinct(merged.map(|(_, node)| node))?;
            if merged.is_empty() {
                break;
            }
            merged.into_iter().for_each(|node| self.tree.split(&mut self.cut, node));
        }
        self.tree.close(&mut self.cut, regions)?;
        merges.only(&self.tree.within(&self.cut)?)
    }
}
