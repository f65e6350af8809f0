//! Merging segments across their weakest borders.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::constants::MERGE_SHARES;
use super::crease::Border;
use super::slopes::Slopes;
use super::surface::Surface;
use crate::mesh::partition::Partition;
use crate::ordered::Ordered;
use crate::progress::Progress;
use crate::{memory, Result};

/// Two segments that became one: `gone` is `kept` from then on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Merge {
    pub kept: u32,
    pub gone: u32,
    /// The strength of the border that fell.
    pub strength: f64,
}

/// Which segments may merge, and how far.
pub(super) struct Merging<'a> {
    pub surface: &'a Surface<'a>,
    pub slopes: &'a Slopes,
    /// Only segments of the same group merge, where given: a group for each face.
    pub groups: Option<&'a [u32]>,
    pub progress: &'a Progress,
}

impl Merging<'_> {
    /// Merges across borders weaker than `threshold`, weakest first, and measures them again as segments
    /// grow, unless the caller wishes to finish. `labels` become the names of the segments that are kept.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn below(&self, labels: &mut [u32], threshold: f64) -> Result<Vec<Merge>> {
        let mut merges = Vec::new();
        for share in MERGE_SHARES {
            if self.progress.is_finishing() {
                merges.extend(self.round(labels, threshold)?);
                break;
            }
            merges.extend(self.round(labels, share * threshold)?);
        }
        Ok(merges)
    }

    /// Merges until nothing that may merge touches.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn all(&self, labels: &mut [u32]) -> Result<Vec<Merge>> {
        let mut merges: Vec<Merge> = Vec::new();
        loop {
            let borders = self.borders(labels)?;
            // A fifth of the borders at a time: the later ones change with the segments. Where the caller
            // wishes to finish, they are not measured again.
            let mut strengths: Vec<f64> = memory::gathered(borders.iter().map(|b| b.strength))?;
            strengths.sort_unstable_by(f64::total_cmp);
            let most = match strengths.get(strengths.len() / 5) {
                Some(_) if self.progress.is_finishing() => f64::INFINITY,
                Some(strength) => strength * (1.0 + 1e-9) + f64::MIN_POSITIVE,
                None => return Ok(merges),
            };
            let round = greedy(&borders, most)?;
            if round.is_empty() {
                return Ok(merges);
            }
            rename(labels, &round);
            memory::extend(&mut merges, round.len())?;
            merges.extend(round);
        }
    }

    fn round(&self, labels: &mut [u32], threshold: f64) -> Result<Vec<Merge>> {
        let merges = greedy(&self.borders(labels)?, threshold)?;
        rename(labels, &merges);
        Ok(merges)
    }

    fn borders(&self, labels: &[u32]) -> Result<Vec<Border>> {
        self.progress.check()?;
        let mut borders = self.slopes.borders(self.surface, labels)?;
        if let Some(groups) = self.groups {
            let mut group = BTreeMap::new();
            for (label, g) in labels.iter().zip(groups) {
                group.insert(*label, *g);
            }
            borders.retain(|b| group.get(&b.labels[0]) == group.get(&b.labels[1]));
        }
        Ok(borders)
    }

    /// Gives every segment of fewer than `least` faces to the neighbor behind its weakest border,
    /// smallest first.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn absorb_small(&self, labels: &mut [u32], least: usize) -> Result<Vec<Merge>> {
        let mut merges = Vec::new();
        let mut borders = Vec::new();
        loop {
            let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
            for label in labels.iter() {
                *sizes.entry(*label).or_default() += 1;
            }
            if borders.is_empty() || !self.progress.is_finishing() {
                borders = self.borders(labels)?;
            }
            let mut weakest: BTreeMap<u32, (f64, u32)> = BTreeMap::new();
            for border in &borders {
                for (own, other) in [(0, 1), (1, 0)].map(|(i, j)| (border.labels[i], border.labels[j])) {
                    let better = |held: &(f64, u32)| border.strength < held.0;
                    if sizes[&own] < least && weakest.get(&own).is_none_or(better) {
                        weakest.insert(own, (border.strength, other));
                    }
                }
            }
            let mut small: Vec<(usize, u32)> =
                memory::gathered(weakest.keys().map(|label| (sizes[label], *label)))?;
            small.sort_unstable();
            // Each segment takes part in one merge of a round, so that the measured borders are still theirs.
            let mut busy: BTreeMap<u32, ()> = BTreeMap::new();
            let mut round = Vec::new();
            for (_, gone) in small {
                let (strength, kept) = weakest[&gone];
                if busy.contains_key(&gone) || busy.contains_key(&kept) {
                    continue;
                }
                busy.insert(gone, ());
                if sizes[&kept] < least {
                    busy.insert(kept, ());
                }
                memory::push(&mut round, Merge { kept, gone, strength })?;
            }
            if round.is_empty() {
                return Ok(merges);
            }
            rename(labels, &round);
            if self.progress.is_finishing() {
                borders = renamed(&borders, &round);
            }
            merges.extend(round);
        }
    }
}

/// The borders that are left after merges, those that became one with their mean strength by length.
fn renamed(borders: &[Border], merges: &[Merge]) -> Vec<Border> {
    let mut joined: BTreeMap<[u32; 2], (f64, f64)> = BTreeMap::new();
    let mut sides: Vec<u32> = borders.iter().flat_map(|border| border.labels).collect();
    rename(&mut sides, merges);
    for (border, sides) in borders.iter().zip(sides.chunks_exact(2)) {
        if sides[0] != sides[1] {
            let labels = [sides[0].min(sides[1]), sides[0].max(sides[1])];
            let (length, weighted) = joined.entry(labels).or_default();
            *length += border.length;
            *weighted += border.length * border.strength;
        }
    }
    let mean = |(labels, (length, weighted))| {
        let strength: f64 = weighted / f64::max(length, f64::MIN_POSITIVE);
        Border { labels, length, strength }
    };
    joined.into_iter().map(mean).collect()
}

/// Names every segment that is gone after the one that it became.
pub(super) fn rename(labels: &mut [u32], merges: &[Merge]) {
    let mut names: BTreeMap<u32, u32> = BTreeMap::new();
    for merge in merges.iter().rev() {
        let kept = names.get(&merge.kept).copied().unwrap_or(merge.kept);
        names.insert(merge.gone, kept);
    }
    for label in labels {
        if let Some(name) = names.get(label) {
            *label = *name;
        }
    }
}

/// The same merges in the order given, each named by segments that are still there.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn within_order(labels: &[u32], n: usize, merges: &[Merge]) -> Result<Vec<Merge>> {
    debug_assert!(labels.iter().all(|l| (*l as usize) < n));
    let mut segments = Partition::new(n)?;
    let mut ordered = memory::room(merges.len())?;
    for merge in merges {
        let (kept, gone) = (segments.root(merge.kept), segments.root(merge.gone));
        if kept != gone {
            segments.attach(gone, kept);
            ordered.push(Merge { kept, gone, strength: merge.strength });
        }
    }
    Ok(ordered)
}

/// Removes borders weaker than `threshold`, weakest first; borders that two segments had with a third become
/// one, with their mean strength by length.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn greedy(borders: &[Border], threshold: f64) -> Result<Vec<Merge>> {
    let mut around: BTreeMap<u32, BTreeMap<u32, (f64, f64)>> = BTreeMap::new();
    let mut heap = BinaryHeap::new();
    memory::extend_heap(&mut heap, borders.len())?;
    for &Border { labels: [a, b], length, strength } in borders {
        around.entry(a).or_default().insert(b, (length, strength));
        around.entry(b).or_default().insert(a, (length, strength));
        heap.push(Reverse((Ordered(strength), [a, b])));
    }
    let mut merges = Vec::new();
    while let Some(Reverse((Ordered(strength), [a, b]))) = heap.pop() {
        if strength >= threshold {
            break;
        }
        let now = around.get(&a).and_then(|row| row.get(&b)).map(|border| border.1);
        if now != Some(strength) {
            continue;
        }
        let size = |label: u32| around.get(&label).map_or(0, BTreeMap::len);
        let (kept, gone) = if size(a) >= size(b) { (a, b) } else { (b, a) };
        let row = around.remove(&gone).unwrap_or_default();
        for (third, (length, strength)) in row {
            if let Some(other) = around.get_mut(&third) {
                other.remove(&gone);
            }
            if third == kept {
                continue;
            }
            let held = around.get(&kept).and_then(|row| row.get(&third)).copied().unwrap_or((0.0, 0.0));
            let total = held.0 + length;
            let mean = (held.0 * held.1 + length * strength) / total.max(f64::MIN_POSITIVE);
            around.entry(kept).or_default().insert(third, (total, mean));
            around.entry(third).or_default().insert(kept, (total, mean));
            memory::extend_heap(&mut heap, 1)?;
            heap.push(Reverse((Ordered(mean), [kept.min(third), kept.max(third)])));
        }
        memory::push(&mut merges, Merge { kept, gone, strength })?;
    }
    Ok(merges)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn border(a: u32, b: u32, strength: f64) -> Border {
        Border { labels: [a, b], length: 1.0, strength }
    }

    #[test]
    fn weak_borders_fall_first_and_joint_ones_have_the_mean_strength() {
        let borders = [border(0, 1, 0.1), border(0, 2, 1.0), border(1, 2, 0.4), border(2, 3, 0.6)];
        let merges = greedy(&borders, 0.65).unwrap();
        assert_eq!(merges.len(), 2);
        assert_eq!((merges[0].strength, merges[1].strength), (0.1, 0.6));
        // 0 and 1 against 2: (1.0 + 0.4) / 2 = 0.7, which stands.
        let mut labels = vec![0, 1, 2, 3];
        rename(&mut labels, &merges);
        assert_eq!(labels[0], labels[1]);
        assert_eq!(labels[2], labels[3]);
        assert_ne!(labels[0], labels[2]);
    }
}
