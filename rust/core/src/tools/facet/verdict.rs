//! Whether regions can be the facets of a polyhedron: every loop has three corners, none meets itself, and
//! the corners that two regions share lie on one line.

use std::collections::HashSet;

use super::constants::BESIDE;
use super::regions::{Regions, Ridge, Set, OUTSIDE};
use crate::mesh::connectivity::{next, previous};
use crate::mesh::vector::{cross, distance, norm, sub, unit, Point};
use crate::{memory, Result};

/// Corners that need not lie on one line.
const OFF_LINE: usize = 3;

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

impl Regions<'_> {
    /// What `set` has to be joined with so that it can be one facet: regions around it that would be left
    /// with two corners or meet it off a line, and, where it would have two corners itself, the neighbor with
    /// which it costs less. `None` where it cannot, or not with so few.
    pub(super) fn closure(
        &self,
        mut set: Set,
        is_held: impl Fn(u32) -> bool,
        cost: impl Fn(&Set) -> f64,
    ) -> Result<Option<Set>> {
        loop {
            match self.verdict(&set)? {
                Verdict::Facet => return Ok(Some(set)),
                Verdict::Never => return Ok(None),
                Verdict::WithOne(of) => {
                    let joined =
                        of.into_iter().filter(|&r| r != OUTSIDE && !is_held(r)).filter_map(|r| set.with(r));
                    let least = joined.min_by(|a, b| cost(a).total_cmp(&cost(b)).then(a.cmp(b)));
                    let Some(next) = least else { return Ok(None) };
                    set = next;
                }
            }
        }
    }

    /// Whether the regions of `set` can be one facet.
    fn verdict(&self, set: &Set) -> Result<Verdict> {
        let (border, lost) = self.joined(set)?;
        let valence = |v: u32| self.valence[v as usize] - lost.get(&v).copied().unwrap_or(0) / 2;
        let Some(loops) = self.loops_of(&border, &|r| set.contains(r), &valence)? else {
            return Ok(Verdict::Never);
        };
        if loops.is_empty() {
            return Ok(Verdict::Never);
        }
        if let Some(ridges) = loops.iter().find(|ridges| !has_corners(ridges)) {
            return Ok(Verdict::WithOne(memory::gathered(ridges.iter().map(|ridge| ridge.neighbor))?));
        }
        // The regions behind vertices that are corners no longer.
        for &h in &border {
            let v = self.connectivity.head(h as usize);
            if lost.contains_key(&v) && valence(v) == 2 {
                let Some(mate) = self.connectivity.twin(h as usize) else { continue };
                if !self.keeps_corners(mate as u32, &valence) {
                    return Ok(Verdict::WithOne(vec![self.labels[mate / 3]]));
                }
            }
        }
        let met = self.met_off_line(&border, &loops, set)?;
        Ok(met.map_or(Verdict::Facet, |region| Verdict::WithOne(vec![region])))
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

    /// A region that has corners of these loops which are not on one line.
    pub(super) fn met_off_line(
        &self,
        border: &[u32],
        loops: &[Vec<Ridge>],
        set: &Set,
    ) -> Result<Option<u32>> {
        let corners: HashSet<u32> = memory::distinct(loops.iter().flatten().map(|ridge| ridge.from))?;
        let tail = |h: u32| self.connectivity.tail(h as usize);
        let at = || border.iter().copied().filter(|&h| corners.contains(&tail(h)));
        // Vertices with more regions around them than the border is long: not all of these are looked at.
        let is_hub = |&h: &u32| self.valence[tail(h) as usize] as usize > border.len();
        let mut hubs: Vec<u32> = memory::sifted(at().filter(is_hub))?;
        if hubs.len() >= OFF_LINE {
            hubs.clear();
        }
        let mut met: Vec<(u32, u32)> = Vec::new();
        for h in at().filter(|h| !hubs.contains(h)) {
            for r in self.regions_at(h)?.into_iter().filter(|r| !set.contains(*r)) {
                memory::push(&mut met, (r, tail(h)))?;
            }
        }
        met.sort_unstable();
        met.dedup();
        self.meet_at_hubs(&mut met, &hubs)?;
        for group in met.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() >= OFF_LINE) {
            let places = memory::gathered(group.iter().map(|&(_, v)| self.positions[v as usize]))?;
            if !on_line(&places) {
                return Ok(Some(group[0].0));
            }
        }
        Ok(None)
    }

    /// Adds to the corners that regions were `met` at those at `hubs`, where it matters: of regions that were
    /// met at so many others that they can be off a line.
    fn meet_at_hubs(&self, met: &mut Vec<(u32, u32)>, hubs: &[u32]) -> Result<()> {
        let groups = met.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() + hubs.len() >= OFF_LINE);
        let often: Vec<u32> = memory::sifted(groups.map(|group| group[0].0))?;
        for &h in hubs {
            let v = self.connectivity.tail(h as usize);
            let touches =
                |&r: &u32| self.borders[r as usize].iter().any(|&h| self.connectivity.tail(h as usize) == v);
            let there: HashSet<u32> = memory::distinct(often.iter().copied().filter(touches))?;
            if there.is_empty() {
                continue;
            }
            // What touches a vertex need not be met around it from here, where two sheets do.
            for r in self.regions_at(h)?.into_iter().filter(|r| there.contains(r)) {
                memory::push(met, (r, v))?;
            }
        }
        met.sort_unstable();
        met.dedup();
        Ok(())
    }

    /// The regions around the vertex where `h` starts, as far as faces lead from that of `h`.
    fn regions_at(&self, h: u32) -> Result<Vec<u32>> {
        let mut found = Vec::new();
        let mut g = h as usize;
        // Clockwise until the boundary or all around, then counterclockwise.
        while let Some(mate) = self.connectivity.twin(g) {
            g = next(mate);
            memory::push(&mut found, self.labels[g / 3])?;
            if g == h as usize {
                return Ok(found);
            }
        }
        let mut g = previous(h as usize);
        while let Some(mate) = self.connectivity.twin(g) {
            memory::push(&mut found, self.labels[mate / 3])?;
            g = previous(mate);
        }
        found.retain(|&r| r != OUTSIDE);
        Ok(found)
    }
}

/// Whether points lie on the line of those two that are farthest apart.
pub(super) fn on_line(points: &[Point]) -> bool {
    let others = |i: usize| points[i + 1..].iter().copied();
    let pairs = points.iter().enumerate().flat_map(|(i, &a)| others(i).map(move |b| (distance(a, b), a, b)));
    let Some((span, a, b)) = pairs.max_by(|x, y| x.0.total_cmp(&y.0)) else { return true };
    points.iter().all(|&p| norm(cross(sub(p, a), unit(sub(b, a)))) <= BESIDE * span)
}
