//! In which order the finest parts become one: nested divisions of every count.
//!
//! The cheapest cuts say what is a part, but not which part to give up where fewer are wanted: hands are cut
//! off more cheaply than arms. Two parts that touch are two for people the more surely the cheaper the cut
//! is, as surely as not at the limit: the logarithm of limit over price is the evidence. The Rand index says
//! what a merge is worth: it joins as many pairs of points as the product of both areas, which is right or
//! wrong for all of them. The merge with the least evidence against it, times those pairs, comes next; but a
//! part goes only to that larger one from which it is set apart least, else strips beside a border painted by
//! hand would go over it to the limb, since fewer pairs are joined there than with the body.
//!
//! Once the count is found, there is no evidence for more: weighed by pairs, specks and strips would come
//! first beyond it, since they join the fewest. There the shape of a part is all that counts, whatever its
//! size: the merge whose border is longest for the root of the smaller area comes first. Where a border
//! follows nothing, its length all around the smaller part counts against the area of that: round shapes fall
//! into pieces of about one size.

use std::collections::BTreeMap;

use super::constants::UNSEEN_BORDER;
use super::cut::Side;
use super::graph::Graph;
use crate::mesh::partition::Partition;
use crate::Result;

/// Two parts that become one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Merge {
    /// The one that stays, and the one that becomes a piece of it.
    pub pair: [u32; 2],
    /// What the cut between them costs, and what it would through no hollow and with no step.
    pub price: f64,
    pub plain_price: f64,
    /// Of both.
    pub areas: [f64; 2],
}

/// What the border between two parts costs, and how long it is.
#[derive(Debug, Clone, Copy, Default)]
struct Border {
    cost: f64,
    length: f64,
}

impl Border {
    fn add(&mut self, other: Self) {
        self.cost += other.cost;
        self.length += other.length;
    }
}

/// Parts that become one, two at a time.
pub(super) struct Merging {
    sides: Vec<Side>,
    borders: BTreeMap<[u32; 2], Border>,
    /// Parts of the same one that was found merge before all others.
    found: Vec<u32>,
    /// The piece of the surface that a part belongs to, and of how many parts of it besides.
    pieces: Vec<(u32, usize)>,
    limit: f64,
    beyond: Beyond,
}

/// What says which of the parts that become a found one merges first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beyond {
    /// The pairs expected wrong, as between found parts: to choose the count.
    Pairs,
    /// The shape of the parts, whatever their size.
    Shape,
}

impl Merging {
    /// The parts by `labels`, from 0, of a graph whose nodes lie in `pieces` that only gaps join; which part
    /// each comes from that was `found`, up to which price cuts are made, and what counts `beyond` the found.
    pub(super) fn new(
        graph: &Graph,
        pieces: &[u32],
        labels: &[u32],
        found: Vec<u32>,
        limit: f64,
        beyond: Beyond,
    ) -> Result<Self> {
        let parts = graph.quotient(labels, found.len())?;
        let sides = (0..parts.n_nodes()).map(|i| Side::of(&parts, |node| node == i)).collect();
        let mut borders: BTreeMap<[u32; 2], Border> = BTreeMap::new();
        for edge in &parts.edges {
            let border = Border { cost: edge.cost, length: edge.length };
            borders.entry(ordered(edge.ends)).or_default().add(border);
        }
        // A part that holds a gap makes one piece of both sides.
        let mut joined = Partition::new(found.len() + pieces.len())?;
        let name = |piece: u32| found.len() as u32 + piece;
        labels.iter().zip(pieces).for_each(|(&part, &piece)| joined.unite(part, name(piece)));
        let roots: Vec<u32> = (0..found.len() as u32).map(|part| joined.root(part)).collect();
        let others = |root: u32| roots.iter().filter(|r| **r == root).count() - 1;
        let pieces = roots.iter().map(|&root| (root, others(root))).collect();
        Ok(Self { sides, borders, found, pieces, limit, beyond })
    }

    /// The merges, one after the other, until one part is left.
    pub(super) fn merges(mut self) -> Vec<Merge> {
        let mut merges = Vec::with_capacity(self.sides.len());
        loop {
            let (dearest, around) = (self.dearest(), self.around());
            let allowed = self.borders.iter().filter(|(pair, border)| {
                self.may_merge(**pair) && self.is_dearest(**pair, border.cost, &dearest)
            });
            let judged = allowed.map(|(&pair, &border)| {
                let [a, b] = pair.map(|part| self.sides[part as usize]);
                let apart = self.found[pair[0] as usize] != self.found[pair[1] as usize];
                let price = a.price(b, border.cost);
                let plain_price = a.plain_price(b, border.length);
                let merge = Merge { pair, price, plain_price, areas: [a.area, b.area] };
                let loss = match self.beyond {
                    Beyond::Shape if !apart => {
                        let small = pair[usize::from(b.area < a.area)];
                        if border.cost > UNSEEN_BORDER * border.length {
                            -a.price_by_size(b, around[small as usize])
                        } else {
                            -a.price_by_shape(b, border.cost)
                        }
                    }
                    _ => loss(a, b, price / self.limit),
                };
                (merge, apart, loss)
            });
            let next = judged.min_by(|a, b| a.1.cmp(&b.1).then(a.2.total_cmp(&b.2)));
            let Some((merge, ..)) = next else { return merges };
            merges.push(merge);
            self.merge(merge.pair);
        }
    }

    /// What all borders of each part cost.
    fn around(&self) -> Vec<f64> {
        let mut around = vec![0.0; self.sides.len()];
        for (pair, border) in &self.borders {
            pair.iter().for_each(|&part| around[part as usize] += border.cost);
        }
        around
    }

    /// For each part the price of the dearest of its borders with larger parts that it may merge with: once
    /// the count is found, with those of the same found one if there are any.
    fn dearest(&self) -> Vec<(bool, f64)> {
        let mut dearest = vec![(false, 0.0); self.sides.len()];
        for (&pair, border) in self.borders.iter().filter(|(pair, _)| self.may_merge(**pair)) {
            let (small, price) = self.judged(pair, border.cost);
            let most = &mut dearest[small];
            if price > *most {
                *most = price;
            }
        }
        dearest
    }

    /// Whether no other border of the smaller part of a pair with a larger one is dearer than this.
    fn is_dearest(&self, pair: [u32; 2], border: f64, dearest: &[(bool, f64)]) -> bool {
        let (small, price) = self.judged(pair, border);
        price >= dearest[small]
    }

    /// The smaller part of a pair, whether both are of the same found one, and the price of their border.
    fn judged(&self, pair: [u32; 2], border: f64) -> (usize, (bool, f64)) {
        let [a, b] = pair.map(|part| self.sides[part as usize]);
        let alike =
            self.beyond == Beyond::Shape && self.found[pair[0] as usize] == self.found[pair[1] as usize];
        (pair[usize::from(b.area < a.area)] as usize, (alike, a.price(b, border)))
    }

    /// Across a gap only whole pieces merge: limbs of two figures that nearly touch are no part.
    fn may_merge(&self, pair: [u32; 2]) -> bool {
        let [(a, others_of_a), (b, others_of_b)] = pair.map(|part| self.pieces[part as usize]);
        a == b || others_of_a == 0 || others_of_b == 0
    }

    fn merge(&mut self, [kept, gone]: [u32; 2]) {
        let [(a, others_of_a), (b, others_of_b)] = [kept, gone].map(|part| self.pieces[part as usize]);
        if a == b {
            let left = others_of_a - 1;
            self.pieces.iter_mut().filter(|(piece, _)| *piece == a).for_each(|(_, others)| *others = left);
        } else if others_of_a == 0 {
            self.pieces[kept as usize] = (b, others_of_b);
        }
        self.sides[kept as usize] = self.sides[kept as usize].with(self.sides[gone as usize]);
        let renamed = |end: u32| if end == gone { kept } else { end };
        for (ends, border) in std::mem::take(&mut self.borders) {
            let ends = ends.map(renamed);
            if ends[0] != ends[1] {
                self.borders.entry(ordered(ends)).or_default().add(border);
            }
        }
    }
}

/// What speaks against one part instead of two: the evidence for the cut, whose price is in units of the
/// limit, times the pairs of points that it parts, over the square of the whole area.
fn loss(a: Side, b: Side, price: f64) -> f64 {
    -a.area * b.area * price.clamp(f64::MIN_POSITIVE, f64::MAX).ln()
}

fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tools::parts::graph::Edge;

    /// Parts with these areas, and what the borders between them cost.
    fn parts(areas: &[f64], borders: &[([u32; 2], f64)]) -> Graph {
        let edges = borders.iter().map(|&(ends, cost)| Edge { ends, length: cost, cost, distance: 1.0 });
        Graph::new(areas.to_vec(), vec![[0.0; 3]; areas.len()], edges.collect()).unwrap()
    }

    fn merges(parts: &Graph, pieces: &[u32], found: &[u32]) -> Vec<Merge> {
        let labels: Vec<u32> = (0..found.len() as u32).collect();
        Merging::new(parts, pieces, &labels, found.to_vec(), 1.0, Beyond::Pairs).unwrap().merges()
    }

    fn pairs(parts: &Graph, pieces: &[u32], found: &[u32]) -> Vec<[u32; 2]> {
        merges(parts, pieces, found).into_iter().map(|merge| merge.pair).collect()
    }

    #[test]
    fn a_hand_goes_to_its_arm_before_the_arm_goes_to_the_body() {
        // The hand's border is by far the shortest.
        let body = parts(&[0.7, 0.25, 0.05], &[([0, 1], 0.1), ([1, 2], 0.01)]);
        assert_eq!(pairs(&body, &[0; 3], &[0, 1, 2]), [[1, 2], [0, 1]]);
    }

    #[test]
    fn halves_of_a_body_are_one_before_its_limbs_go() {
        let body = parts(&[0.4, 0.4, 0.1, 0.1], &[([0, 1], 0.9), ([0, 2], 0.02), ([1, 3], 0.02)]);
        assert_eq!(pairs(&body, &[0; 4], &[0, 1, 2, 3])[0], [0, 1]);
    }

    #[test]
    fn what_was_found_stays_longest() {
        let row = parts(&[0.25; 4], &[([0, 1], 0.5), ([1, 2], 0.1), ([2, 3], 0.5)]);
        assert_eq!(pairs(&row, &[0; 4], &[0, 1, 1, 2])[0], [1, 2]);
    }

    #[test]
    fn beyond_what_is_found_halves_stay_longer_than_specks() {
        let long = parts(&[0.5, 0.498, 0.002], &[([0, 1], 1.5), ([1, 2], 0.15)]);
        assert_eq!(pairs(&long, &[0; 3], &[0; 3])[0], [0, 1]);
        let labels = [0, 1, 2];
        let shaped = Merging::new(&long, &[0; 3], &labels, vec![0; 3], 1.0, Beyond::Shape).unwrap();
        assert_eq!(shaped.merges()[0].pair, [1, 2]);
    }

    #[test]
    fn a_strip_goes_to_the_side_from_which_it_is_set_apart_least() {
        let limb = parts(&[0.89, 0.01, 0.1], &[([0, 1], 0.01), ([1, 2], 1e-5)]);
        assert_eq!(pairs(&limb, &[0; 3], &[0, 1, 2])[0], [0, 1]);
    }

    #[test]
    fn borders_add_up() {
        let ring = parts(&[0.5, 0.25, 0.25], &[([0, 1], 0.1), ([1, 2], 0.9), ([0, 2], 0.1)]);
        let found = merges(&ring, &[0; 3], &[0, 1, 2]);
        assert_eq!(found[0].pair, [1, 2]);
        assert!((found[1].price - 0.2 / 0.5_f64.powf(0.7)).abs() < 1e-12);
        assert_eq!(found[1].plain_price, found[1].price);
        assert_eq!(found[1].areas, [0.5, 0.5]);
    }

    #[test]
    fn limbs_of_two_figures_that_nearly_touch_do_not_become_one() {
        let figures = parts(&[0.45, 0.05, 0.05, 0.45], &[([0, 1], 0.02), ([1, 2], 0.001), ([2, 3], 0.02)]);
        assert_eq!(pairs(&figures, &[0, 0, 1, 1], &[0, 1, 2, 3]), [[0, 1], [2, 3], [0, 2]]);
    }

    #[test]
    fn an_eye_goes_to_the_head_it_sits_in_as_a_whole() {
        let figure = parts(&[0.6, 0.39, 0.01], &[([0, 1], 0.1), ([1, 2], 0.001)]);
        assert_eq!(pairs(&figure, &[0, 0, 1], &[0, 1, 2]), [[1, 2], [0, 1]]);
    }
}
