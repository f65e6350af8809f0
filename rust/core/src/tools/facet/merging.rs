//! Merging faces into ever fewer facets, in the order of what that costs.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use super::constants::{FLAT, PATIENCE};
use super::moments::Moments;
use super::regions::{Regions, Set};
use super::stage::shares;
use crate::mesh::vector::Point;
use crate::ordered::Ordered;
use crate::progress::{Progress, Report};
use crate::{memory, Result};

/// A merge that might be made: its cost, the regions, how often they had changed, and what of the cost is
/// their planes'.
type Offer = Reverse<(Ordered, Set, u32, Ordered)>;

/// From every face a facet to as few as there can be.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Merges {
    /// The region that stays and the one that becomes part of it.
    pub pairs: Vec<[u32; 2]>,
    /// What each merge cost.
    pub costs: Vec<f64>,
    /// The integral of the squared distance from the planes after each of them.
    pub squared_distances: Vec<f64>,
    /// Whether each is the last of those that were made at once: the regions are facets then.
    pub is_last: Vec<bool>,
    /// Whether there are all of them: the caller wished to finish before if not.
    pub are_all: bool,
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
    fn push(&mut self, pair: [u32; 2]) -> Result<()> {
        // Once, however often it was offered: its offers would double whenever both its regions change.
        memory::extend_set(&mut self.waiting, 1)?;
        if self.waiting.insert(pair) {
            memory::extend_map(&mut self.at, 2)?;
            for region in pair {
                memory::push(self.at.entry(region).or_default(), pair)?;
            }
        }
        Ok(())
    }

    fn take(&mut self, region: u32) -> Vec<[u32; 2]> {
        let mut pairs = self.at.remove(&region).unwrap_or_default();
        pairs.retain(|pair| self.waiting.remove(pair));
        pairs
    }
}

/// Merges regions, whose `moments` are given, until none can be merged with another. Regions that are `held`
/// are none of them. `weight` is what a border along a halfedge costs:
/// cheap ones stay. `on_mesh` is the nearest point of the mesh. Ends early where the caller wishes to finish.
pub(super) fn merges(
    regions: &mut Regions<'_>,
    moments: Vec<Moments>,
    held: &[bool],
    weight: impl Fn(u32) -> f64,
    on_mesh: impl Fn(Point) -> Point,
    progress: &Progress,
) -> Result<Merges> {
    let fits: Vec<_> = memory::gathered(moments.iter().map(Moments::fit))?;
    let mut total: f64 = fits.iter().map(|fit| fit.squared_distance).sum();
    let n = moments.len();
    let energies = memory::gathered(fits.iter().map(|fit| fit.energy))?;
    let mut merging = Merging {
        regions,
        moments,
        energies,
        stamps: memory::repeated(0, n)?,
        heap: BinaryHeap::new(),
        refused: Refused::default(),
        weight,
    };
    for p in (0..n as u32).filter(|&p| !held[p as usize]) {
        for (q, border) in merging.regions.neighbors(p)? {
            if q > p && !held[q as usize] {
                merging.propose(p, q, &border)?;
            }
        }
    }
    let mut made = Merges::default();
    let mut n_popped = 0;
    while let Some(Reverse((Ordered(cost), set, stamp, Ordered(of_planes)))) = merging.heap.pop() {
        n_popped += 1;
        if n_popped % PATIENCE == 0 {
            progress.check()?;
            if progress.is_finishing() {
                return Ok(made);
            }
            let [from, to] = shares::MERGING;
            let fraction = from + (to - from) * made.pairs.len() as f64 / n as f64;
            progress.report(Report { fraction, stage: "merging".into(), ..Report::default() });
        }
        if merging.stamp(&set) != stamp {
            if !set.is_pair() {
                merging.propose_again(set.first_two())?;
            }
            continue;
        }
        let closed = merging.regions.closure(set, |r| held[r as usize], |set| merging.cost(set))?;
        let Some(whole) = closed else {
            merging.refused.push(set.first_two())?;
            continue;
        };
        if whole != set {
            merging.refused.push(set.first_two())?;
            merging.offer(whole, cost)?;
            continue;
        }
        // Only now, as it takes a walk along the border: what was offered is the least that it costs.
        let straight = of_planes + merging.regions.straightened(&set, &on_mesh)?;
        // Rounding makes costs of next to nothing less than nothing.
        if straight > cost + f64::EPSILON * cost.abs() {
            merging.push(straight, set, of_planes)?;
            continue;
        }
        let mut members = set.iter();
        let Some(mut kept) = members.next() else { continue };
        for other in members {
            let before = [kept, other].map(|r| merging.moments[r as usize].fit().squared_distance);
            let joined = merging.moments[kept as usize].plus(&merging.moments[other as usize]);
            let [stays, gone] = merging.regions.merge(kept, other)?;
            let fit = joined.fit();
            total += fit.squared_distance - before[0] - before[1];
            merging.moments[stays as usize] = joined;
            merging.energies[stays as usize] = fit.energy;
            [stays, gone].into_iter().for_each(|r| merging.stamps[r as usize] += 1);
            kept = stays;
            memory::push(&mut made.pairs, [stays, gone])?;
            memory::push(&mut made.costs, cost)?;
            memory::push(&mut made.squared_distances, total.max(0.0))?;
            memory::push(&mut made.is_last, false)?;
        }
        made.is_last.last_mut().into_iter().for_each(|last| *last = true);
        for (r, border) in merging.regions.neighbors(kept)? {
            if !held[r as usize] {
                merging.propose(kept, r, &border)?;
            }
            // What could not be merged beside something else may be now.
            for pair in merging.refused.take(r) {
                merging.propose_again(pair)?;
            }
        }
    }
    made.are_all = true;
    Ok(made)
}

impl<W: Fn(u32) -> f64> Merging<'_, '_, W> {
    /// Offers to merge two neighbors.
    fn propose(&mut self, p: u32, q: u32, border: &[u32]) -> Result<()> {
        let weight = border.iter().map(|&h| (self.weight)(h)).sum::<f64>() / border.len().max(1) as f64;
        let set = Set::pair(p, q);
        let cost = self.cost(&set) / weight.max(f64::MIN_POSITIVE);
        self.push(cost, set, cost)
    }

    /// Offers to merge a pair that was refused before, if both are still neighbors.
    fn propose_again(&mut self, [p, q]: [u32; 2]) -> Result<()> {
        let border = self.regions.between(p, q)?;
        if border.is_empty() {
            return Ok(());
        }
        self.propose(p, q, &border)
    }

    /// Offers to merge several regions, for no less than `least`.
    fn offer(&mut self, set: Set, least: f64) -> Result<()> {
        let cost = self.cost(&set).max(least);
        self.push(cost, set, cost)
    }

    fn push(&mut self, cost: f64, set: Set, of_planes: f64) -> Result<()> {
        let stamp = self.stamp(&set);
        memory::extend_heap(&mut self.heap, 1)?;
        self.heap.push(Reverse((Ordered(cost), set, stamp, Ordered(of_planes))));
        Ok(())
    }

    fn joined(&self, set: &Set) -> Moments {
        set.iter().fold(Moments::default(), |sum, r| sum.plus(&self.moments[r as usize]))
    }

    fn cost(&self, set: &Set) -> f64 {
        let joined = self.joined(set);
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
    /// The same.
    pub(super) fn twin(&self) -> Result<Self> {
        Ok(Self {
            pairs: memory::twin(&self.pairs)?,
            costs: memory::twin(&self.costs)?,
            squared_distances: memory::twin(&self.squared_distances)?,
            is_last: memory::twin(&self.is_last)?,
            are_all: self.are_all,
        })
    }
}
