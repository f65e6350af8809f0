//! Facets of a sound shape are joined until as few are left as are wanted: always those two that cost least,
//! of those after which all around them is flat and sound again.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap, HashMap};

use super::constants::{FLAT, KEPT, STAY};
use super::faces::Faces;
use super::joining::{joined, Joined};
use super::shape::{Facet, Shape};
use super::skin::{Fresh, Skin};
use super::solve::flatten;
use super::stage::Stage;
use crate::memory;
use crate::ordered::Ordered;
use crate::Result;

/// Two facets that might be joined: what that costs, and how often they had changed.
type Offer = Reverse<(Ordered, [u32; 2], u32)>;

struct Reduction<'a> {
    shape: &'a mut Shape,
    stage: &'a Stage<'a>,
    skin: Skin<'a>,
    /// The facets at each corner.
    at: Vec<Vec<u32>>,
    stamps: Vec<u32>,
    heap: BinaryHeap<Offer>,
    /// What was tried and cost more than what others might, as long as nothing of it has changed.
    tried: BTreeMap<[u32; 2], Trial>,
    n_joins: u32,
    /// After how many joins each facet or one of its corners changed last.
    changed: Vec<u32>,
    /// Pairs whose loops cannot be joined until something around them changes. What was not sound when solved
    /// is tried again where one of both gets other corners.
    waiting: HashMap<u32, BTreeSet<u32>>,
    tolerance: f64,
}

/// What is around two facets once they are one, solved.
struct Trial {
    /// The facets of `shape` in the whole, that of both first.
    facets: Vec<u32>,
    /// The corners of `shape` in the whole.
    corners: Vec<u32>,
    shape: Shape,
    /// Facets whose loops are others.
    reshaped: Vec<u32>,
    /// The triangles of facets with a corner that may move.
    fresh: Fresh,
    cost: f64,
    /// By how much the squared distances grow.
    farther: f64,
    /// The integral of the squared distance from the mesh of the facets around both.
    off_mesh: f64,
    /// After how many joins it was tried.
    n_joins: u32,
}

/// How far facets are joined.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// Until no more are left.
    pub count: usize,
    /// As long as faces are no farther from their facets, in the root mean square, all of them and, with how
    /// far it is from the mesh, those of every facet that is joined.
    pub error: f64,
}

/// Joins facets of `shape` up to a goal, as far as that can be sound. Corners of one facet alone that are
/// within `tolerance` of a line need not be kept.
///
/// # Errors
/// [`crate::Error::Cancelled`], [`crate::Error::Memory`].
pub(super) fn reduce(
    shape: &mut Shape,
    faces: &mut Faces<'_>,
    goal: Goal,
    tolerance: f64,
    stage: &Stage<'_>,
) -> Result<()> {
    let mut n_left = shape.facets.len();
    let most = goal.error.powi(2) * faces.scan.area;
    let mut squares: f64 = shape.facets.iter().map(Facet::squared_distance).sum();
    let mut at = memory::repeated(Vec::new(), shape.corners.len())?;
    for (k, facet) in (0..).zip(&shape.facets) {
        facet.corners().for_each(|c| at[c as usize].push(k));
    }
    let mut name: Vec<u32> = memory::numbers(n_left)?;
    let mut reduction = Reduction {
        skin: Skin::new(shape, faces)?,
        at,
        stamps: memory::repeated(0, n_left)?,
        heap: BinaryHeap::new(),
        tried: BTreeMap::new(),
        n_joins: 0,
        changed: memory::repeated(0, n_left)?,
        waiting: HashMap::new(),
        tolerance,
        shape,
        stage,
    };
    let pairs = all_pairs(&reduction.shape.facets)?;
    reduction.offer(pairs)?;
    while n_left > goal.count && !stage.is_finishing() {
        let Some(Reverse((cost, pair, stamp))) = reduction.heap.pop() else { break };
        if stamp != reduction.stamp(pair) {
            continue;
        }
        let Some(trial) = reduction.trial(pair)? else { continue };
        if trial.cost > cost.0 {
            reduction.heap.push(Reverse((Ordered(trial.cost), pair, stamp)));
            if reduction.tried.len() < KEPT {
                reduction.tried.insert(pair, trial);
            }
            continue;
        }
        let is_beyond =
            |one: &Facet| one.squared_distance() + trial.off_mesh > goal.error.powi(2) * one.moments.area;
        if trial.shape.facets.first().is_some_and(is_beyond) {
            continue;
        }
        squares += trial.farther;
        if squares + trial.off_mesh > most {
            break;
        }
        reduction.take(pair, trial)?;
        name[pair[1] as usize] = pair[0];
        n_left -= 1;
    }
    drop(reduction);
    let left = (0..).zip(&shape.facets).filter(|(_, facet)| !facet.loops.is_empty()).map(|(k, _)| k);
    let mut place = memory::repeated(0, name.len())?;
    (0..).zip(left).for_each(|(fresh, k): (u32, usize)| place[k] = fresh);
    // Each became part of one of a lower number, which may have become part of another.
    for k in 0..name.len() {
        name[k] = name[name[k] as usize];
    }
    faces.labels.iter_mut().for_each(|label| *label = place[name[*label as usize] as usize]);
    shape.facets.retain(|facet| !facet.loops.is_empty());
    Ok(())
}

/// All facets with each of their neighbors that they may be joined with. Not facet by facet: where thousands
/// meet at one corner, each would look at all of them.
fn all_pairs(facets: &[Facet]) -> Result<BTreeSet<[u32; 2]>> {
    let free = || (0_u32..).zip(facets).filter(|(_, facet)| !facet.is_held);
    let sides = || free().flat_map(|(k, facet)| facet.sides().map(move |side| (side, k)));
    let mut of_sides: Vec<([u32; 2], u32)> = memory::sifted(sides())?;
    of_sides.sort_unstable();
    let mut pairs = BTreeSet::new();
    for ([a, b], k) in sides() {
        let from = of_sides.partition_point(|(side, _)| *side < [b, a]);
        let behind = of_sides[from..].iter().take_while(|(side, _)| *side == [b, a]);
        pairs.extend(behind.filter(|(_, j)| *j != k).map(|&(_, j)| [k.min(j), k.max(j)]));
    }
    Ok(pairs)
}

impl Reduction<'_> {
    fn stamp(&self, pair: [u32; 2]) -> u32 {
        pair.into_iter().map(|k| self.stamps[k as usize]).sum()
    }

    /// Facets and those that share a corner with one of them.
    fn around(&self, facets: &BTreeSet<u32>) -> BTreeSet<u32> {
        let corners = facets.iter().flat_map(|&k| self.shape.facets[k as usize].corners());
        corners.flat_map(|c| self.at[c as usize].iter().copied()).collect()
    }

    /// A facet with each of its neighbors that it may be joined with.
    fn pairs(&self, k: u32) -> BTreeSet<[u32; 2]> {
        let facet = |k: u32| &self.shape.facets[k as usize];
        let behind = |[a, b]: [u32; 2]| {
            let others = self.at[a as usize].iter().copied().filter(|&j| j != k && !facet(j).is_held);
            others.filter(move |&j| facet(j).sides().any(|side| side == [b, a]))
        };
        let neighbors = facet(k).sides().filter(|_| !facet(k).is_held).flat_map(behind);
        neighbors.map(|j| [k.min(j), k.max(j)]).collect()
    }

    /// Offers to join them.
    fn offer(&mut self, pairs: BTreeSet<[u32; 2]>) -> Result<()> {
        memory::extend_heap(&mut self.heap, pairs.len())?;
        for pair in pairs {
            self.heap.push(Reverse((Ordered(self.least(pair)), pair, self.stamp(pair))));
        }
        Ok(())
    }

    /// What two facets cost as one at least.
    fn least(&self, [p, q]: [u32; 2]) -> f64 {
        let [p, q] = [p, q].map(|k| &self.shape.facets[k as usize]);
        let energies: f64 = [p, q].iter().map(|facet| facet.moments.energy(&facet.plane)).sum();
        p.moments.plus(&q.moments).fit().energy - energies
    }

    /// Whether nothing that a trial stands on has changed since.
    fn is_current(&self, [_, gone]: [u32; 2], trial: &Trial) -> bool {
        trial.facets.iter().chain([&gone]).all(|&k| self.changed[k as usize] <= trial.n_joins)
    }

    /// Joins two facets and solves what is around them; `None` where that is not sound.
    fn trial(&mut self, pair: [u32; 2]) -> Result<Option<Trial>> {
        if let Some(trial) = self.tried.remove(&pair) {
            // Others may have moved into its way.
            let is_clear = self.skin.is_clear(&trial.fresh, pair[1], trial.n_joins)?;
            return Ok(is_clear.then_some(trial));
        }
        let Some(all) = joined(self.shape, &self.at, pair, self.tolerance) else {
            let [p, q] = pair;
            self.waiting.entry(p).or_default().insert(q);
            self.waiting.entry(q).or_default().insert(p);
            return Ok(None);
        };
        let (mut trial, changed) = self.patch(pair, &all)?;
        let homes: Vec<_> = trial.shape.corners.iter().map(|corner| corner.home).collect();
        let off = flatten(&mut trial.shape, STAY, &homes, self.stage)?;
        if off.is_nan() || off > FLAT {
            return Ok(None);
        }
        let of = (&trial.shape, &trial.facets[..], &trial.corners[..]);
        let Some((fresh, off_mesh)) = self.skin.tried(of, &changed, pair[1])? else { return Ok(None) };
        trial.fresh = fresh;
        let all = || trial.facets.iter().chain([&pair[1]]).map(|&k| &self.shape.facets[k as usize]);
        let grown = |of: fn(&Facet) -> f64| {
            trial.shape.facets.iter().map(of).sum::<f64>() - all().map(of).sum::<f64>()
        };
        let cost = grown(|facet| facet.moments.energy(&facet.plane)) + off_mesh;
        let farther = grown(Facet::squared_distance);
        (trial.cost, trial.farther, trial.off_mesh) = (cost, farther, off_mesh);
        Ok(trial.cost.is_finite().then_some(trial))
    }

    /// Two facets as one, with those around them and those around these, and which of all these have a corner
    /// that may move: those of others do not.
    fn patch(&self, [p, q]: [u32; 2], all: &Joined) -> Result<(Trial, Vec<u32>)> {
        let near = self.around(&self.around(&[p, q].into()));
        let facets: Vec<u32> =
            [p].into_iter().chain(near.iter().copied().filter(|k| *k != p && *k != q)).collect();
        let (mut names, mut corners) = (HashMap::new(), Vec::new());
        let mut shape = Shape::default();
        let mut changed = Vec::new();
        for (i, &k) in (0..).zip(&facets) {
            let mut facet = self.shape.facets[k as usize].twin()?;
            if let Some((_, loops)) = all.iter().find(|(other, _)| *other == k) {
                facet.loops.clone_from(loops);
            }
            if k == p {
                let other = &self.shape.facets[q as usize];
                facet.moments = facet.moments.plus(&other.moments);
                facet.plane = facet.moments.fit().plane;
            }
            let mut is_changed = all.iter().any(|(other, _)| *other == k);
            for c in facet.loops.iter_mut().flatten() {
                let name = *names.entry(*c).or_insert_with(|| {
                    let mut corner = self.shape.corners[*c as usize];
                    corner.is_fixed |= !self.at[*c as usize].iter().all(|k| near.contains(k));
                    corners.push(*c);
                    shape.corners.push(corner);
                    corners.len() as u32 - 1
                });
                is_changed |= !shape.corners[name as usize].is_fixed;
                *c = name;
            }
            if is_changed {
                changed.push(i);
            }
            shape.facets.push(facet);
        }
        let reshaped = all.iter().map(|(k, _)| *k).collect();
        let trial = Trial {
            facets,
            corners,
            shape,
            reshaped,
            fresh: Vec::new(),
            cost: 0.0,
            farther: 0.0,
            off_mesh: 0.0,
            n_joins: self.n_joins,
        };
        Ok((trial, changed))
    }

    /// Puts what was tried in its place.
    fn take(&mut self, [p, q]: [u32; 2], trial: Trial) -> Result<()> {
        for (&c, corner) in trial.corners.iter().zip(&trial.shape.corners) {
            self.shape.corners[c as usize].point = corner.point;
        }
        let before: BTreeSet<u32> =
            trial.facets.iter().chain([&q]).flat_map(|&k| self.shape.facets[k as usize].corners()).collect();
        self.shape.facets[q as usize].loops = Vec::new();
        self.skin.remove(q, p);
        for (&k, facet) in trial.facets.iter().zip(trial.shape.facets) {
            let mut facet = facet;
            facet.loops.iter_mut().flatten().for_each(|c| *c = trial.corners[*c as usize]);
            self.shape.facets[k as usize] = facet;
        }
        for c in before {
            let facets = &self.shape.facets;
            self.at[c as usize].retain(|&k| facets[k as usize].corners().any(|corner| corner == c));
            if facets[p as usize].corners().any(|corner| corner == c) && !self.at[c as usize].contains(&p) {
                self.at[c as usize].push(p);
            }
        }
        self.n_joins += 1;
        trial.fresh.into_iter().for_each(|(k, patch)| self.skin.put(k, patch, self.n_joins));
        trial.facets.iter().chain([&q]).for_each(|&k| self.changed[k as usize] = self.n_joins);
        let mut tried = std::mem::take(&mut self.tried);
        tried.retain(|&pair, trial| self.is_current(pair, trial));
        self.tried = tried;
        self.waiting.remove(&q);
        trial.reshaped.iter().chain([&q]).for_each(|&k| self.stamps[k as usize] += 1);
        let mut pairs: BTreeSet<[u32; 2]> = trial.reshaped.iter().flat_map(|&k| self.pairs(k)).collect();
        for k in self.around(&[p].into()) {
            let waiting = self.waiting.remove(&k).unwrap_or_default();
            pairs.extend(waiting.into_iter().map(|j| [k.min(j), k.max(j)]));
        }
        pairs.retain(|pair| pair.iter().all(|&k| !self.shape.facets[k as usize].loops.is_empty()));
        self.offer(pairs)
    }
}
