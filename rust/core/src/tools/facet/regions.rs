//! Regions of faces that can be the facets of a polyhedron: every loop has three corners, none meets itself,
//! and the corners that two regions share lie on one line.

use std::collections::{HashMap, HashSet};

use super::constants::{BESIDE, TOGETHER};
use crate::mesh::connectivity::{next, previous};
use crate::mesh::vector::{cross, distance, norm, sub, unit, Point};
use crate::mesh::{Connectivity, EdgeKind};

/// What lies behind an edge without a second face.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// A part of a loop from one corner to the next, against one neighbor. A loop without corners is one ridge
/// from a vertex to itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ridge {
    pub neighbor: u32,
    pub from: u32,
    pub to: u32,
}

/// A few regions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Set {
    members: [u32; TOGETHER],
    len: u8,
}

impl Set {
    pub(super) fn pair(p: u32, q: u32) -> Self {
        let mut members = [OUTSIDE; TOGETHER];
        (members[0], members[1]) = (p.min(q), p.max(q));
        Self { members, len: 2 }
    }

    pub(super) fn of(region: u32) -> Self {
        let mut members = [OUTSIDE; TOGETHER];
        members[0] = region;
        Self { members, len: 1 }
    }

    pub(super) fn is_pair(&self) -> bool {
        self.len == 2
    }

    /// The pair that it began with.
    pub(super) fn first_two(&self) -> [u32; 2] {
        [self.members[0], self.members[1]]
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.members[..self.len as usize].iter().copied()
    }

    pub(super) fn contains(&self, region: u32) -> bool {
        region != OUTSIDE && self.iter().any(|r| r == region)
    }

    /// The same with another, if there is room.
    fn with(mut self, region: u32) -> Option<Self> {
        let place = self.members.get_mut(self.len as usize)?;
        *place = region;
        self.len += 1;
        Some(self)
    }
}

/// Whether a set of regions can be a facet.
enum Verdict {
    Facet,
    /// Not without one of these.
    WithOne(Vec<u32>),
    Never,
}

/// Whether a loop has enough corners. What is open gets more along the mesh's boundary.
pub(super) fn has_corners(ridges: &[Ridge]) -> bool {
    let is_open = ridges.iter().any(|r| r.neighbor == OUTSIDE);
    if ridges.len() == 1 && ridges[0].from == ridges[0].to {
        is_open
    } else {
        ridges.len() + usize::from(is_open) >= 3
    }
}

/// A partition of faces into regions, which can be merged.
#[derive(Debug, Clone)]
pub(super) struct Regions<'a> {
    pub(super) connectivity: &'a Connectivity,
    pub(super) positions: &'a [Point],
    /// The region of each face, [`OUTSIDE`] for faces that are none.
    pub(super) labels: Vec<u32>,
    members: Vec<Vec<u32>>,
    /// The halfedges of each region that have something else behind them.
    pub(super) borders: Vec<Vec<u32>>,
    /// How many border edges meet at each vertex.
    pub(super) valence: Vec<u32>,
    /// Vertices that are corners whatever meets there.
    is_anchored: Vec<bool>,
}

impl<'a> Regions<'a> {
    /// The regions of `labels`, numbered from 0 to `n`; faces with [`OUTSIDE`] are none.
    pub(super) fn new(
        connectivity: &'a Connectivity,
        positions: &'a [Point],
        labels: Vec<u32>,
        n: usize,
    ) -> Self {
        let mut regions = Self {
            connectivity,
            positions,
            members: vec![Vec::new(); n],
            borders: vec![Vec::new(); n],
            valence: vec![0; connectivity.n_vertices()],
            is_anchored: vec![false; connectivity.n_vertices()],
            labels,
        };
        for (f, &label) in (0..).zip(&regions.labels) {
            if label != OUTSIDE {
                regions.members[label as usize].push(f);
            }
        }
        for h in 0..connectivity.n_halfedges() {
            let own = regions.labels[h / 3];
            let behind = regions.behind(h as u32);
            let ends = [connectivity.tail(h), connectivity.head(h)].map(|v| v as usize);
            if own == OUTSIDE || behind == own {
                continue;
            }
            regions.borders[own as usize].push(h as u32);
            // Both sides of an edge come by here unless one is outside.
            if behind == OUTSIDE || connectivity.twin(h).is_some_and(|mate| h < mate) {
                ends.into_iter().for_each(|v| regions.valence[v] += 1);
            }
            if matches!(connectivity.kind(h), EdgeKind::NonManifold | EdgeKind::Inconsistent) {
                ends.into_iter().for_each(|v| regions.is_anchored[v] = true);
            }
        }
        regions
    }

    /// The region behind halfedge `h`.
    pub(super) fn behind(&self, h: u32) -> u32 {
        self.connectivity.twin(h as usize).map_or(OUTSIDE, |mate| self.labels[mate / 3])
    }

    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        [self.connectivity.tail(h as usize), self.connectivity.head(h as usize)]
    }

    /// The regions next to one, each with the halfedges that lead there.
    pub(super) fn neighbors(&self, region: u32) -> Vec<(u32, Vec<u32>)> {
        let mut all: Vec<(u32, u32)> =
            self.borders[region as usize].iter().map(|&h| (self.behind(h), h)).collect();
        all.retain(|&(neighbor, _)| neighbor != OUTSIDE);
        all.sort_unstable();
        all.chunk_by(|a, b| a.0 == b.0)
            .map(|group| (group[0].0, group.iter().map(|pair| pair.1).collect()))
            .collect()
    }

    /// The halfedges of `p` that have `q` behind them.
    pub(super) fn between(&self, p: u32, q: u32) -> Vec<u32> {
        self.borders[p as usize].iter().copied().filter(|&h| self.behind(h) == q).collect()
    }

    /// The border halfedge that follows `h` around what `is_own` describes.
    pub(super) fn follow(&self, h: u32, is_own: impl Fn(u32) -> bool) -> u32 {
        let mut g = next(h as usize);
        while let Some(mate) = self.connectivity.twin(g) {
            if !is_own(self.labels[mate / 3]) {
                break;
            }
            g = next(mate);
        }
        g as u32
    }

    /// Whether a vertex where so many border edges meet is a corner.
    pub(super) fn is_corner(&self, v: u32, valence: u32) -> bool {
        valence > 2 || self.is_anchored[v as usize]
    }

    /// What `set` has to be joined with so that it can be one facet: regions around it that would be left
    /// with two corners or meet it off a line, and, where it would have two corners itself, the neighbor with
    /// which it costs less. `None` where it cannot, or not with so few.
    pub(super) fn closure(
        &self,
        mut set: Set,
        is_held: impl Fn(u32) -> bool,
        cost: impl Fn(&Set) -> f64,
    ) -> Option<Set> {
        loop {
            match self.verdict(&set) {
                Verdict::Facet => return Some(set),
                Verdict::Never => return None,
                Verdict::WithOne(of) => {
                    let joined =
                        of.into_iter().filter(|&r| r != OUTSIDE && !is_held(r)).filter_map(|r| set.with(r));
                    set = joined.min_by(|a, b| cost(a).total_cmp(&cost(b)).then(a.cmp(b)))?;
                }
            }
        }
    }

    /// Whether the regions of `set` can be one facet.
    fn verdict(&self, set: &Set) -> Verdict {
        let mut lost: HashMap<u32, u32> = HashMap::new();
        let mut border = Vec::new();
        for &h in set.iter().flat_map(|r| &self.borders[r as usize]) {
            if set.contains(self.behind(h)) {
                // Both halfedges of the edge come by here.
                self.ends(h).into_iter().for_each(|v| *lost.entry(v).or_default() += 1);
            } else {
                border.push(h);
            }
        }
        let valence = |v: u32| self.valence[v as usize] - lost.get(&v).copied().unwrap_or(0) / 2;
        let Some(loops) = self.loops_of(&border, &|r| set.contains(r), &valence) else {
            return Verdict::Never;
        };
        if loops.is_empty() {
            return Verdict::Never;
        }
        if let Some(ridges) = loops.iter().find(|ridges| !has_corners(ridges)) {
            return Verdict::WithOne(ridges.iter().map(|ridge| ridge.neighbor).collect());
        }
        // The regions behind vertices that are corners no longer.
        for &h in &border {
            let v = self.connectivity.head(h as usize);
            if lost.contains_key(&v) && valence(v) == 2 {
                let Some(mate) = self.connectivity.twin(h as usize) else { continue };
                if !self.keeps_corners(mate as u32, &valence) {
                    return Verdict::WithOne(vec![self.labels[mate / 3]]);
                }
            }
        }
        self.met_off_line(&border, &loops, set)
            .map_or(Verdict::Facet, |region| Verdict::WithOne(vec![region]))
    }

    /// Whether the loop of halfedge `start` has its corners, with `valence` border edges at each vertex.
    fn keeps_corners(&self, start: u32, valence: &impl Fn(u32) -> u32) -> bool {
        let own = self.labels[start as usize / 3];
        if own == OUTSIDE {
            return true;
        }
        let (mut h, mut corners, mut is_open) = (start, 0, false);
        loop {
            let v = self.connectivity.tail(h as usize);
            corners += usize::from(self.is_corner(v, valence(v)));
            is_open |= self.behind(h) == OUTSIDE;
            if corners + usize::from(is_open) >= 3 {
                return true;
            }
            h = self.follow(h, |region| region == own);
            if h == start {
                return is_open && corners == 0;
            }
        }
    }

    /// The loops of a border as ridges; `None` where one meets itself or another.
    fn loops_of(
        &self,
        border: &[u32],
        is_own: &impl Fn(u32) -> bool,
        valence: &impl Fn(u32) -> u32,
    ) -> Option<Vec<Vec<Ridge>>> {
        let mut met: HashSet<u32> = HashSet::with_capacity(border.len());
        let mut loops = Vec::new();
        for &start in border {
            if met.contains(&self.connectivity.tail(start as usize)) {
                continue;
            }
            let mut walk = Vec::new();
            let mut h = start;
            loop {
                if !met.insert(self.connectivity.tail(h as usize)) {
                    return None;
                }
                walk.push(h);
                h = self.follow(h, is_own);
                if h == start {
                    break;
                }
            }
            loops.push(walk);
        }
        let n_walked: usize = loops.iter().map(Vec::len).sum();
        (n_walked == border.len()).then(|| loops.into_iter().map(|walk| self.ridges(walk, valence)).collect())
    }

    /// The ridges of a loop of halfedges.
    fn ridges(&self, mut walk: Vec<u32>, valence: &impl Fn(u32) -> u32) -> Vec<Ridge> {
        let starts = |h: u32| {
            let v = self.connectivity.tail(h as usize);
            self.is_corner(v, valence(v))
        };
        let Some(first) = walk.iter().position(|&h| starts(h)) else {
            let v = self.connectivity.tail(walk[0] as usize);
            return vec![Ridge { neighbor: self.behind(walk[0]), from: v, to: v }];
        };
        walk.rotate_left(first);
        let mut ridges: Vec<Ridge> = Vec::new();
        for h in walk {
            let [from, to] = self.ends(h);
            match ridges.last_mut() {
                Some(last) if !starts(h) => last.to = to,
                _ => ridges.push(Ridge { neighbor: self.behind(h), from, to }),
            }
        }
        ridges
    }

    /// A region that has corners of these loops which are not on one line.
    pub(super) fn met_off_line(&self, border: &[u32], loops: &[Vec<Ridge>], set: &Set) -> Option<u32> {
        let corners: HashSet<u32> = loops.iter().flatten().map(|ridge| ridge.from).collect();
        let mut met: Vec<(u32, u32)> = Vec::new();
        for &h in border.iter().filter(|&&h| corners.contains(&self.connectivity.tail(h as usize))) {
            let v = self.connectivity.tail(h as usize);
            met.extend(self.regions_at(h).into_iter().filter(|r| !set.contains(*r)).map(|r| (r, v)));
        }
        met.sort_unstable();
        met.dedup();
        let off = |group: &&[(u32, u32)]| group.len() > 2 && !self.is_on_line(group);
        met.chunk_by(|a, b| a.0 == b.0).find(off).map(|group| group[0].0)
    }

    /// The regions around the vertex where `h` starts, as far as faces lead from that of `h`.
    fn regions_at(&self, h: u32) -> Vec<u32> {
        let mut found = Vec::new();
        let mut g = h as usize;
        // Clockwise until the boundary or all around, then counterclockwise.
        while let Some(mate) = self.connectivity.twin(g) {
            g = next(mate);
            found.push(self.labels[g / 3]);
            if g == h as usize {
                return found;
            }
        }
        let mut g = previous(h as usize);
        while let Some(mate) = self.connectivity.twin(g) {
            found.push(self.labels[mate / 3]);
            g = previous(mate);
        }
        found.retain(|&r| r != OUTSIDE);
        found
    }

    fn is_on_line(&self, vertices: &[(u32, u32)]) -> bool {
        let points: Vec<Point> = vertices.iter().map(|&(_, v)| self.positions[v as usize]).collect();
        let others = |i: usize| points[i + 1..].iter().copied();
        let pairs =
            points.iter().enumerate().flat_map(|(i, &a)| others(i).map(move |b| (distance(a, b), a, b)));
        let Some((span, a, b)) = pairs.max_by(|x, y| x.0.total_cmp(&y.0)) else { return true };
        points.iter().all(|&p| norm(cross(sub(p, a), unit(sub(b, a)))) <= BESIDE * span)
    }

    /// Makes one region of two; returns which name is kept, and which is gone.
    pub(super) fn merge(&mut self, p: u32, q: u32) -> [u32; 2] {
        let (kept, gone) =
            if self.members[p as usize].len() >= self.members[q as usize].len() { (p, q) } else { (q, p) };
        let (shared, mut border): (Vec<u32>, Vec<u32>) =
            self.borders[kept as usize].iter().partition(|&&h| self.behind(h) == gone);
        border.extend(self.borders[gone as usize].iter().copied().filter(|&h| self.behind(h) != kept));
        for h in shared {
            self.ends(h).into_iter().for_each(|v| self.valence[v as usize] -= 1);
        }
        self.borders[kept as usize] = border;
        self.borders[gone as usize] = Vec::new();
        let moved = std::mem::take(&mut self.members[gone as usize]);
        moved.iter().for_each(|&f| self.labels[f as usize] = kept);
        self.members[kept as usize].extend(moved);
        [kept, gone]
    }

    /// The loops of a region as ridges; `None` where they meet.
    pub(super) fn loops(&self, region: u32) -> Option<Vec<Vec<Ridge>>> {
        self.loops_of(&self.borders[region as usize], &|r| r == region, &|v| self.valence[v as usize])
    }
}
