//! Regions of faces, and their borders as loops of ridges.

use std::collections::{HashMap, HashSet};

use super::constants::TOGETHER;
use crate::mesh::connectivity::next;
use crate::mesh::vector::Point;
use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

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
    pub(super) fn with(mut self, region: u32) -> Option<Self> {
        let place = self.members.get_mut(self.len as usize)?;
        *place = region;
        self.len += 1;
        Some(self)
    }
}

/// A partition of faces into regions, which can be merged.
#[derive(Debug)]
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
    ) -> Result<Self> {
        let n_vertices = connectivity.n_vertices();
        let mut regions = Self {
            connectivity,
            positions,
            members: memory::repeated(Vec::new(), n)?,
            borders: memory::repeated(Vec::new(), n)?,
            valence: memory::repeated(0, n_vertices)?,
            is_anchored: memory::repeated(false, n_vertices)?,
            labels,
        };
        for (f, &label) in (0..).zip(&regions.labels) {
            if label != OUTSIDE {
                memory::push(&mut regions.members[label as usize], f)?;
            }
        }
        for h in 0..connectivity.n_halfedges() {
            let own = regions.labels[h / 3];
            let behind = regions.behind(h as u32);
            let ends = [connectivity.tail(h), connectivity.head(h)].map(|v| v as usize);
            if own == OUTSIDE || behind == own {
                continue;
            }
            memory::push(&mut regions.borders[own as usize], h as u32)?;
            // Both sides of an edge come by here unless one is outside.
            if behind == OUTSIDE || connectivity.twin(h).is_some_and(|mate| h < mate) {
                ends.into_iter().for_each(|v| regions.valence[v] += 1);
            }
            if matches!(connectivity.kind(h), EdgeKind::NonManifold | EdgeKind::Inconsistent) {
                ends.into_iter().for_each(|v| regions.is_anchored[v] = true);
            }
        }
        Ok(regions)
    }

    /// The region behind halfedge `h`.
    pub(super) fn behind(&self, h: u32) -> u32 {
        self.connectivity.twin(h as usize).map_or(OUTSIDE, |mate| self.labels[mate / 3])
    }

    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        [self.connectivity.tail(h as usize), self.connectivity.head(h as usize)]
    }

    /// The regions next to one, each with the halfedges that lead there.
    pub(super) fn neighbors(&self, region: u32) -> Result<Vec<(u32, Vec<u32>)>> {
        let mut all: Vec<(u32, u32)> =
            memory::gathered(self.borders[region as usize].iter().map(|&h| (self.behind(h), h)))?;
        all.retain(|&(neighbor, _)| neighbor != OUTSIDE);
        all.sort_unstable();
        let mut found = Vec::new();
        for group in all.chunk_by(|a, b| a.0 == b.0) {
            let border = memory::gathered(group.iter().map(|pair| pair.1))?;
            memory::push(&mut found, (group[0].0, border))?;
        }
        Ok(found)
    }

    /// The halfedges of `p` that have `q` behind them.
    pub(super) fn between(&self, p: u32, q: u32) -> Result<Vec<u32>> {
        let border = self.borders[p as usize].iter().copied();
        Ok(memory::sifted(border.filter(|&h| self.behind(h) == q))?)
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

    /// The border of the regions of `set` as one, and how many halfedges within it meet at each vertex.
    pub(super) fn joined(&self, set: &Set) -> Result<(Vec<u32>, HashMap<u32, u32>)> {
        let (mut border, mut lost): (Vec<u32>, HashMap<u32, u32>) = Default::default();
        for &h in set.iter().flat_map(|r| &self.borders[r as usize]) {
            if set.contains(self.behind(h)) {
                // Both halfedges of the edge come by here.
                memory::extend_map(&mut lost, 2)?;
                self.ends(h).into_iter().for_each(|v| *lost.entry(v).or_default() += 1);
            } else {
                memory::push(&mut border, h)?;
            }
        }
        Ok((border, lost))
    }

    /// The loops of a border as ridges; `None` where one meets itself or another.
    pub(super) fn loops_of(
        &self,
        border: &[u32],
        is_own: &impl Fn(u32) -> bool,
        valence: &impl Fn(u32) -> u32,
    ) -> Result<Option<Vec<Vec<Ridge>>>> {
        let mut met: HashSet<u32> = HashSet::new();
        memory::extend_set(&mut met, border.len())?;
        let mut loops = Vec::new();
        for &start in border {
            if met.contains(&self.connectivity.tail(start as usize)) {
                continue;
            }
            let mut walk = Vec::new();
            let mut h = start;
            loop {
                if !met.insert(self.connectivity.tail(h as usize)) {
                    return Ok(None);
                }
                memory::push(&mut walk, h)?;
                h = self.follow(h, is_own);
                if h == start {
                    break;
                }
            }
            memory::push(&mut loops, walk)?;
        }
        let n_walked: usize = loops.iter().map(Vec::len).sum();
        if n_walked != border.len() {
            return Ok(None);
        }
        let mut ridges = memory::room(loops.len())?;
        for walk in loops {
            ridges.push(self.ridges(walk, valence)?);
        }
        Ok(Some(ridges))
    }

    /// The ridges of a loop of halfedges.
    fn ridges(&self, mut walk: Vec<u32>, valence: &impl Fn(u32) -> u32) -> Result<Vec<Ridge>> {
        let starts = |h: u32| {
            let v = self.connectivity.tail(h as usize);
            self.is_corner(v, valence(v))
        };
        let Some(first) = walk.iter().position(|&h| starts(h)) else {
            let v = self.connectivity.tail(walk[0] as usize);
            return Ok(vec![Ridge { neighbor: self.behind(walk[0]), from: v, to: v }]);
        };
        walk.rotate_left(first);
        let mut ridges: Vec<Ridge> = Vec::new();
        for h in walk {
            let [from, to] = self.ends(h);
            match ridges.last_mut() {
                Some(last) if !starts(h) => last.to = to,
                _ => memory::push(&mut ridges, Ridge { neighbor: self.behind(h), from, to })?,
            }
        }
        Ok(ridges)
    }

    /// Makes one region of two; returns which name is kept, and which is gone.
    pub(super) fn merge(&mut self, p: u32, q: u32) -> Result<[u32; 2]> {
        let (kept, gone) =
            if self.members[p as usize].len() >= self.members[q as usize].len() { (p, q) } else { (q, p) };
        let shared = self.between(kept, gone)?;
        let of = |own: u32| self.borders[own as usize].iter().copied();
        let rest = of(kept).filter(|&h| self.behind(h) != gone);
        let border = memory::sifted(rest.chain(of(gone).filter(|&h| self.behind(h) != kept)))?;
        for h in shared {
            self.ends(h).into_iter().for_each(|v| self.valence[v as usize] -= 1);
        }
        self.borders[kept as usize] = border;
        self.borders[gone as usize] = Vec::new();
        let moved = std::mem::take(&mut self.members[gone as usize]);
        moved.iter().for_each(|&f| self.labels[f as usize] = kept);
        memory::extend(&mut self.members[kept as usize], moved.len())?;
        self.members[kept as usize].extend(moved);
        Ok([kept, gone])
    }

    /// The loops of a region as ridges; `None` where they meet.
    pub(super) fn loops(&self, region: u32) -> Result<Option<Vec<Vec<Ridge>>>> {
        self.loops_of(&self.borders[region as usize], &|r| r == region, &|v| self.valence[v as usize])
    }
}
