//! Merging faces into ever fewer facets, in the order of what that costs.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use super::constants::{FLAT, PATIENCE};
use super::moments::Moments;
use super::regions::{Regions, Set};
use crate::mesh::partition::Partition;
use crate::ordered::Ordered;
use crate::progress::{Progress, Report};
use crate::{memory, Result};

/// A merge that might be made: its cost, the regions, and how often they had changed.
type Offer = Reverse<(Ordered, Set, u32)>;

/// From every face a facet to as few as there can be.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Merges {
    /// The region that stays and the one that becomes part of it.
    pub pairs: Vec<[u32; 2]>,
    /// What each merge cost.
    pub costs: Vec<f64>,
    /// The integral of the squared distance from the planes after each of them.
    pub squared_distances: Vec<f64>,
    /// Whether the regions are facets after each of them: not in the midst of several that are made at once.
    pub is_whole: Vec<bool>,
}

struct Merging<'r, 'a, W> {
    regions: &'r mut Regions<'a>,
    moments: Vec<Moments>,
    energies: Vec<f64>,
    stamps: Vec<u32>,
    heap: BinaryHeap<Offer>,
    refused: Refused,
    weight: W,
}

/// Pairs that could not be merged, or not alone, until something beside them changes.
#[derive(Default)]
struct Refused {
    waiting: HashSet<[u32; 2]>,
    /// The pairs of a region; some no longer wait.
    at: HashMap<u32, Vec<[u32; 2]>>,
}

impl Refused {
    fn push(&mut self, pair: [u32; 2]) {
        // Once, however often it was offered: its offers would double whenever both its regions change.
        if self.waiting.insert(pair) {
            pair.into_iter().for_each(|region| self.at.entry(region).or_default().push(pair));
        }
    }

    fn take(&mut self, region: u32) -> Vec<[u32; 2]> {
        let mut pairs = self.at.remove(&region).unwrap_or_default();
        pairs.retain(|pair| self.waiting.remove(pair));
        pairs
    }
}

/// Merges regions, whose `moments` are given, until none can be merged with another. Regions that are `held`
/// are none of them. `weight` is what a border along a halfedge costs: cheap ones stay.
pub(super) fn merges(
    regions: &mut Regions<'_>,
    moments: Vec<Moments>,
    held: &[bool],
    weight: impl Fn(u32) -> f64,
    progress: &Progress,
) -> Result<Merges> {
    let fits: Vec<_> = moments.iter().map(Moments::fit).collect();
    let mut total: f64 = fits.iter().map(|fit| fit.squared_distance).sum();
    let n = moments.len();
    let energies = fits.iter().map(|fit| fit.energy).collect();
    let mut merging = Merging {
        regions,
        moments,
        energies,
        stamps: vec![0; n],
        heap: BinaryHeap::new(),
        refused: Refused::default(),
        weight,
    };
    for p in (0..n as u32).filter(|&p| !held[p as usize]) {
        for (q, border) in merging.regions.neighbors(p) {
            if q > p && !held[q as usize] {
                merging.propose(p, q, &border);
            }
        }
    }
    let mut made = Merges::default();
    let mut n_popped = 0;
    while let Some(Reverse((Ordered(cost), set, stamp))) = merging.heap.pop() {
        n_popped += 1;
        if n_popped % PATIENCE == 0 {
            progress.check()?;
            let fraction = 0.5 * made.pairs.len() as f64 / n as f64;
            progress.report(Report { fraction, stage: "merging".into(), ..Report::default() });
        }
        if merging.stamp(&set) != stamp {
            if !set.is_pair() {
                merging.propose_again(set.first_two());
            }
            continue;
        }
        let Some(whole) = merging.regions.closure(set, |r| held[r as usize], |set| merging.cost(set)) else {
            merging.refused.push(set.first_two());
            continue;
        };
        if whole != set {
            merging.refused.push(set.first_two());
            merging.offer(whole, cost);
            continue;
        }
        let mut members = set.iter();
        let Some(mut kept) = members.next() else { continue };
        for other in members {
            let before = [kept, other].map(|r| merging.moments[r as usize].fit().squared_distance);
            let joined = merging.moments[kept as usize].plus(&merging.moments[other as usize]);
            let [stays, gone] = merging.regions.merge(kept, other);
            let fit = joined.fit();
            total += fit.squared_distance - before[0] - before[1];
            merging.moments[stays as usize] = joined;
            merging.energies[stays as usize] = fit.energy;
            [stays, gone].into_iter().for_each(|r| merging.stamps[r as usize] += 1);
            kept = stays;
            made.pairs.push([stays, gone]);
            made.costs.push(cost);
            made.squared_distances.push(total.max(0.0));
            made.is_whole.push(false);
        }
        made.is_whole.last_mut().into_iter().for_each(|whole| *whole = true);
        for (r, border) in merging.regions.neighbors(kept) {
            if !held[r as usize] {
                merging.propose(kept, r, &border);
            }
            // What could not be merged beside something else may be now.
            merging.refused.take(r).into_iter().for_each(|pair| merging.propose_again(pair));
        }
    }
    Ok(made)
}

impl<W: Fn(u32) -> f64> Merging<'_, '_, W> {
    /// Offers to merge two neighbors.
    fn propose(&mut self, p: u32, q: u32, border: &[u32]) {
        let weight = border.iter().map(|&h| (self.weight)(h)).sum::<f64>() / border.len().max(1) as f64;
        let set = Set::pair(p, q);
        let cost = self.cost(&set) / weight.max(f64::MIN_POSITIVE);
        self.heap.push(Reverse((Ordered(cost), set, self.stamp(&set))));
    }

    /// Offers to merge a pair that was refused before, if both are still neighbors.
    fn propose_again(&mut self, [p, q]: [u32; 2]) {
        let border = self.regions.between(p, q);
        if !border.is_empty() {
            self.propose(p, q, &border);
        }
    }

    /// Offers to merge several regions, for no less than `least`.
    fn offer(&mut self, set: Set, least: f64) {
        let cost = self.cost(&set).max(least);
        self.heap.push(Reverse((Ordered(cost), set, self.stamp(&set))));
    }

    fn cost(&self, set: &Set) -> f64 {
        let joined = set.iter().fold(Moments::default(), |sum, r| sum.plus(&self.moments[r as usize]));
        // What is flat grows evenly: one region that takes a face at a time is slow.
        FLAT * FLAT * joined.area + joined.fit().energy
            - set.iter().map(|r| self.energies[r as usize]).sum::<f64>()
    }

    /// How often the regions have changed.
    fn stamp(&self, set: &Set) -> u32 {
        set.iter().map(|r| self.stamps[r as usize]).sum()
    }
}

impl Merges {
    /// The regions of `n` that are `count` after the first merges,
    /// numbered in the order of their first members.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn labels(&self, n: usize, count: usize) -> Result<Vec<u32>> {
        let mut sets = Partition::new(n)?;
        self.pairs[..n - count].iter().for_each(|&[kept, gone]| sets.unite(kept, gone));
        let mut names = memory::repeated(u32::MAX, n)?;
        let mut next = 0;
        let label = |f: u32| {
            let name = &mut names[sets.root(f) as usize];
            if *name == u32::MAX {
                *name = next;
                next += 1;
            }
            *name
        };
        Ok(memory::gathered((0..n as u32).map(label))?)
    }
}
