//! Merging faces into ever fewer facets, in the order of what that costs.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use super::constants::{FLAT, PATIENCE};
use super::moments::Moments;
use super::regions::{Regions, Set};
use crate::mesh::partition::Partition;
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
    /// Whether the regions are facets after each of them: not in the midst of several that are made at once.
    pub is_whole: Vec<bool>,
    /// Whether each is the last of those that were made at once.
    pub is_last: Vec<bool>,
}

struct Merging<'r, 'a, W> {
    regions: &'r mut Regions<'a>,
    moments: Vec<Moments>,
    energies: Vec<f64>,
    stamps: Vec<u32>,
    heap: BinaryHeap<Offer>,
    refused: Refused,
    /// Regions that are never to be in one facet with a region.
    apart: HashMap<u32, Vec<u32>>,
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
/// are none of them; nor are two that are to be `apart`. `weight` is what a border along a halfedge costs:
/// cheap ones stay. `on_mesh` is the nearest point of the mesh.
pub(super) fn merges(
    regions: &mut Regions<'_>,
    moments: Vec<Moments>,
    held: &[bool],
    apart: &[[u32; 2]],
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
        apart: HashMap::new(),
        weight,
    };
    for &[p, q] in apart {
        memory::extend_map(&mut merging.apart, 2)?;
        memory::push(merging.apart.entry(p).or_default(), q)?;
        memory::push(merging.apart.entry(q).or_default(), p)?;
    }
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
            let fraction = 0.5 * made.pairs.len() as f64 / n as f64;
            progress.report(Report { fraction, stage: "merging".into(), ..Report::default() });
        }
        if merging.stamp(&set) != stamp {
            if !set.is_pair() {
                merging.propose_again(set.first_two())?;
            }
            continue;
        }
        let closed = merging.regions.closure(set, |r| held[r as usize], |set| merging.cost(set))?;
        let Some(whole) = closed.filter(|whole| !merging.is_apart(whole)) else {
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
        if straight > cost * (1.0 + f64::EPSILON) {
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
            merging.rename(gone, stays)?;
            kept = stays;
            memory::push(&mut made.pairs, [stays, gone])?;
            memory::push(&mut made.costs, cost)?;
            memory::push(&mut made.squared_distances, total.max(0.0))?;
            memory::push(&mut made.is_whole, false)?;
            memory::push(&mut made.is_last, false)?;
        }
        made.is_whole.last_mut().into_iter().for_each(|whole| *whole = true);
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
    Ok(made)
}

impl<W: Fn(u32) -> f64> Merging<'_, '_, W> {
    /// Offers to merge two neighbors.
    fn propose(&mut self, p: u32, q: u32, border: &[u32]) -> Result<()> {
        let weight = border.iter().map(|&h| (self.weight)(h)).sum::<f64>() / border.len().max(1) as f64;
        let set = Set::pair(p, q);
        if self.is_apart(&set) {
            return Ok(());
        }
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
        if self.is_apart(set) {
            return f64::INFINITY;
        }
        let joined = self.joined(set);
        // What is flat grows evenly: one region that takes a face at a time is slow.
        FLAT * FLAT * joined.area + joined.fit().energy
            - set.iter().map(|r| self.energies[r as usize]).sum::<f64>()
    }

    /// Whether two of the regions are not to be in one facet.
    fn is_apart(&self, set: &Set) -> bool {
        set.iter().any(|p| self.apart.get(&p).is_some_and(|others| others.iter().any(|&q| set.contains(q))))
    }

    /// What was to be apart from a region that is gone is to be so from the one that it became part of.
    fn rename(&mut self, gone: u32, kept: u32) -> Result<()> {
        let others = self.apart.remove(&gone).unwrap_or_default();
        for other in &others {
            let named = self.apart.get_mut(other).into_iter().flatten();
            named.filter(|r| **r == gone).for_each(|r| *r = kept);
        }
        if !others.is_empty() {
            memory::extend_map(&mut self.apart, 1)?;
            let all = self.apart.entry(kept).or_default();
            memory::extend(all, others.len())?;
            all.extend(others);
        }
        Ok(())
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
            is_whole: memory::twin(&self.is_whole)?,
            is_last: memory::twin(&self.is_last)?,
        })
    }

    /// Some of them, after which all are facets.
    pub(super) fn only(&self, which: &[usize]) -> Result<Self> {
        let mut is_whole = memory::repeated(false, which.len())?;
        is_whole.last_mut().into_iter().for_each(|whole| *whole = true);
        Ok(Self {
            pairs: memory::gathered(which.iter().map(|&i| self.pairs[i]))?,
            costs: memory::gathered(which.iter().map(|&i| self.costs[i]))?,
            squared_distances: memory::gathered(which.iter().map(|&i| self.squared_distances[i]))?,
            is_last: memory::gathered(which.iter().map(|&i| self.is_last[i]))?,
            is_whole,
        })
    }

    /// The same and then others, whose regions have these `names` here.
    pub(super) fn followed_by(mut self, others: Self, names: &[u32]) -> Result<Self> {
        let n = others.pairs.len();
        memory::extend(&mut self.pairs, n)?;
        memory::extend(&mut self.costs, n)?;
        memory::extend(&mut self.squared_distances, n)?;
        memory::extend(&mut self.is_whole, n)?;
        memory::extend(&mut self.is_last, n)?;
        self.pairs.extend(others.pairs.into_iter().map(|pair| pair.map(|r| names[r as usize])));
        self.costs.extend(others.costs);
        self.squared_distances.extend(others.squared_distances);
        self.is_whole.extend(others.is_whole);
        self.is_last.extend(others.is_last);
        Ok(self)
    }

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
