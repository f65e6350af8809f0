//! One hierarchy of two segmentations: by surfaces, and by bends. Inside of segments by surfaces are the
//! leaves that bends tell, in their order; then fillets are joined, then what one segment by bends is made
//! of, and beyond that segments merge in the order of bends.

use std::collections::BTreeMap;

use super::hierarchy::Hierarchy;
use super::merge::Merge;
use super::surface::Surface;
use super::tangent;
use crate::mesh::partition::{contiguous, Partition};
use crate::{memory, Result};

/// The hierarchy in which `labels`, from 0, are nested with the segments `found` by bends, of which there are
/// `n_found`; `joined` are the fillets, each with the side that it goes to. Where `is_whole`, nothing is
/// nested in `labels`.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing, here and below.
pub(super) fn nested(
    surface: &Surface<'_>,
    found: &Hierarchy,
    n_found: usize,
    labels: &[u32],
    joined: &[[u32; 2]],
    is_whole: bool,
) -> Result<Hierarchy> {
    let (leaves, n_leaves) =
        if is_whole { contiguous(labels)? } else { nested_leaves(surface, found.leaves(), labels)? };
    let mut nest = Nest { roots: Partition::new(n_leaves)?, merges: Vec::new() };
    if !is_whole {
        nest.within(found, &leaves, labels)?;
    }
    let n_labels = labels.iter().map(|label| *label as usize + 1).max().unwrap_or(0);
    let mut leaf_of = memory::repeated(0, n_labels)?;
    labels.iter().zip(&leaves).for_each(|(&label, &leaf)| leaf_of[label as usize] = leaf);
    for pair in joined {
        let [gone, kept] = pair.map(|label| leaf_of[label as usize]);
        nest.merge(kept, gone, 0.0)?;
    }
    nest.beyond(surface, found, n_found, &leaves)?;
    let merges = nest.merges.iter().map(|m| ([m.kept, m.gone], m.strength));
    Ok(Hierarchy::new(leaves, n_leaves, merges).ascending())
}

/// The merges so far, each of segments that were there.
struct Nest {
    roots: Partition,
    merges: Vec<Merge>,
}

impl Nest {
    /// Makes two segments, each named by one of its leaves, one.
    fn merge(&mut self, kept: u32, gone: u32, strength: f64) -> Result<()> {
        let (kept, gone) = (self.roots.root(kept), self.roots.root(gone));
        if kept != gone {
            self.roots.attach(gone, kept);
            memory::push(&mut self.merges, Merge { kept, gone, strength })?;
        }
        Ok(())
    }

    /// Merges the `leaves` inside of each of `labels` in the order in which bends do.
    fn within(&mut self, found: &Hierarchy, leaves: &[u32], labels: &[u32]) -> Result<()> {
        // For each segment by bends one leaf in each segment by surfaces that it has leaves in.
        let mut there: Vec<BTreeMap<u32, u32>> = memory::repeated(BTreeMap::new(), found.range()[0])?;
        let mut first: BTreeMap<u32, u32> = BTreeMap::new();
        for ((&leaf, &label), &bent) in leaves.iter().zip(labels).zip(found.leaves()) {
            there[bent as usize].entry(label).or_insert(leaf);
            first.entry(label).or_insert(leaf);
        }
        for ([kept, gone], strength) in found.merges() {
            for (label, leaf) in std::mem::take(&mut there[gone as usize]) {
                let own = *there[kept as usize].entry(label).or_insert(leaf);
                self.merge(own, leaf, strength)?;
            }
        }
        for (label, leaf) in labels.iter().zip(leaves) {
            self.merge(first[label], *leaf, 0.0)?;
        }
        Ok(())
    }

    /// Merges what is left as far as it goes: first what has most of its area in one segment by bends, in the
    /// order of [`tangent`], then in the order of bends.
    fn beyond(
        &mut self,
        surface: &Surface<'_>,
        found: &Hierarchy,
        n_found: usize,
        leaves: &[u32],
    ) -> Result<()> {
        let mut current: Vec<u32> = memory::gathered(leaves.iter().map(|&leaf| self.roots.root(leaf)))?;
        let n_inner = found.range()[0].saturating_sub(n_found);
        let mut bent = Partition::new(found.range()[0])?;
        found.merges().take(n_inner).for_each(|([kept, gone], _)| bent.attach(gone, kept));
        let mut areas: BTreeMap<u32, BTreeMap<u32, f64>> = BTreeMap::new();
        for (f, (&name, &leaf)) in current.iter().zip(found.leaves()).enumerate() {
            let area = areas.entry(name).or_default().entry(bent.root(leaf)).or_default();
            *area += surface.areas[f];
        }
        let largest = |areas: &BTreeMap<u32, f64>| {
            areas.iter().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(root, _)| *root)
        };
        let groups: BTreeMap<u32, u32> = areas.iter().map(|(&name, areas)| (name, largest(areas))).collect();
        let merges = tangent::merged(surface, &mut current, |a, b| groups[&a] == groups[&b])?;
        for merge in &merges {
            self.merge(merge.kept, merge.gone, merge.strength)?;
        }
        let mut members: Vec<Vec<u32>> = memory::repeated(Vec::new(), found.range()[0])?;
        for (&name, &group) in &groups {
            memory::push(&mut members[group as usize], name)?;
        }
        for ([kept, gone], strength) in found.merges().skip(n_inner) {
            let gone = std::mem::take(&mut members[gone as usize]);
            for name in gone {
                memory::push(&mut members[kept as usize], name)?;
            }
            for k in 1..members[kept as usize].len() {
                let [first, other] = [0, k].map(|k| members[kept as usize][k]);
                self.merge(first, other, strength)?;
            }
            members[kept as usize].truncate(1);
        }
        Ok(())
    }
}

/// The `leaves` and how many there are, each in the segment of `labels` that has most of its faces; faces
/// elsewhere go to the nearest leaf of their own segment.
pub(super) fn nested_leaves(
    surface: &Surface<'_>,
    leaves: &[u32],
    labels: &[u32],
) -> Result<(Vec<u32>, usize)> {
    let n_leaves = leaves.iter().map(|l| *l as usize + 1).max().unwrap_or(0);
    let mut pairs: Vec<(u32, u32)> = memory::gathered(leaves.iter().copied().zip(labels.iter().copied()))?;
    pairs.sort_unstable();
    let mut owner = memory::repeated((0, u32::MAX), n_leaves)?;
    for same in pairs.chunk_by(|a, b| a == b) {
        let held = &mut owner[same[0].0 as usize];
        if same.len() > held.0 {
            *held = (same.len(), same[0].1);
        }
    }
    // Names that no leaf has stand for segments without a leaf of their own.
    let own = |(&leaf, &label): (&u32, &u32)| {
        if owner[leaf as usize].1 == label {
            leaf
        } else {
            u32::MAX
        }
    };
    let mut nested: Vec<u32> = memory::gathered(leaves.iter().zip(labels).map(own))?;
    let mut queue: Vec<usize> = memory::sifted((0..nested.len()).filter(|&f| nested[f] != u32::MAX))?;
    let mut next = 0;
    while let Some(&f) = queue.get(next) {
        next += 1;
        for (_, g) in surface.around(f) {
            if nested[g] == u32::MAX && labels[g] == labels[f] {
                nested[g] = nested[f];
                memory::push(&mut queue, g)?;
            }
        }
    }
    for (nested, label) in nested.iter_mut().zip(labels) {
        if *nested == u32::MAX {
            *nested = n_leaves as u32 + label;
        }
    }
    Ok(contiguous(&nested)?)
}
