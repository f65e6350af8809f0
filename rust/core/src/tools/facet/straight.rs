//! Ridges along the mesh, what it costs that they become straight, and where regions lack corners.

use super::regions::{Regions, Ridge, Set, OUTSIDE};
use super::verdict::has_corners;
use crate::mesh::vector::{distance, Point};
use crate::remesh::closest::closest_on_segment;
use crate::{memory, Result};

impl Regions<'_> {
    /// What it costs that ridges become straight where `set` becomes one region and corners vanish between
    /// them. A facet reaches to its ridge from where the mesh runs, `w` away, and along that strip leaves the
    /// mesh evenly, up to the distance `d` of the ridge: the integral of the squared distance is
    /// `∫ |w| d² / 3` along the ridge. `on_mesh` is the nearest point of the mesh. Without it facets reach
    /// across holes: the ring on top of a torus is flat, a polygon of few corners there is no ring.
    pub(super) fn straightened(&self, set: &Set, on_mesh: impl Fn(Point) -> Point) -> Result<f64> {
        let (border, lost) = self.joined(set)?;
        let was_corner = |v: u32| self.is_corner(v, self.valence[v as usize]);
        let is_corner =
            |v: u32| self.is_corner(v, self.valence[v as usize] - lost.get(&v).copied().unwrap_or(0) / 2);
        let vanishes = |v: u32| lost.contains_key(&v) && was_corner(v) && !is_corner(v);
        let mut cost = 0.0;
        for &h in &border {
            let Some(mate) = self.connectivity.twin(h as usize).map(|mate| mate as u32) else { continue };
            if !vanishes(self.ends(h)[1]) {
                continue;
            }
            let neighbor = self.labels[mate as usize / 3];
            let before = self.ahead(mate, |r| r == neighbor, is_corner)?;
            // Once for each ridge: at the first corner on it that vanishes.
            if before[1..].iter().any(|&v| vanishes(v)) {
                continue;
            }
            let after = self.ahead(self.follow(h, |r| set.contains(r)), |r| set.contains(r), is_corner)?;
            let run: Vec<u32> = memory::sifted(before.into_iter().rev().chain(after.into_iter().skip(1)))?;
            let inner = 1..run.len() - 1;
            let ends = [0].into_iter().chain(inner.filter(|&i| was_corner(run[i]))).chain([run.len() - 1]);
            let mut pieces = 0.0;
            for ends in memory::sifted(ends)?.windows(2) {
                pieces += self.strip(&run[ends[0]..=ends[1]], &on_mesh)?;
            }
            cost += (self.strip(&run, &on_mesh)? - pieces).max(0.0);
        }
        Ok(cost)
    }

    /// The vertices of a border from where `h` starts to the next corner, or around.
    fn ahead(
        &self,
        h: u32,
        is_own: impl Fn(u32) -> bool,
        is_corner: impl Fn(u32) -> bool,
    ) -> Result<Vec<u32>> {
        let [start, mut v] = self.ends(h);
        let (mut run, mut g) = (vec![start], h);
        loop {
            memory::push(&mut run, v)?;
            if is_corner(v) || v == start {
                return Ok(run);
            }
            g = self.follow(g, &is_own);
            v = self.ends(g)[1];
        }
    }

    /// `∫ |w| d² / 3` along a run, beside the segment between its ends.
    fn strip(&self, run: &[u32], on_mesh: impl Fn(Point) -> Point) -> Result<f64> {
        let at = |i: usize| self.positions[run[i] as usize];
        let last = run.len() - 1;
        let square = |i: usize| {
            if i == 0 || i == last {
                return 0.0;
            }
            let ridge = closest_on_segment(at(i), at(0), at(last));
            distance(at(i), ridge) * distance(ridge, on_mesh(ridge)).powi(2)
        };
        let squares: Vec<f64> = memory::gathered((0..run.len()).map(square))?;
        let piece = |i: usize| distance(at(i), at(i + 1)) * (squares[i] + squares[i + 1]);
        Ok((0..last).map(piece).sum::<f64>() / 6.0)
    }

    /// The vertices of a ridge, from its start to its end.
    pub(super) fn run(&self, region: u32, ridge: &Ridge) -> Result<Vec<u32>> {
        let border = &self.borders[region as usize];
        let Some(mut h) = border.iter().copied().find(|&h| self.connectivity.tail(h as usize) == ridge.from)
        else {
            return Ok(vec![ridge.from, ridge.to]);
        };
        let mut run = vec![ridge.from];
        loop {
            let head = self.connectivity.head(h as usize);
            memory::push(&mut run, head)?;
            if head == ridge.to {
                return Ok(run);
            }
            h = self.follow(h, |r| r == region);
        }
    }

    /// Where a region is no facet: itself and the regions that it cannot be one beside.
    pub(super) fn in_the_way(&self, region: u32) -> Result<Option<Vec<u32>>> {
        let border = &self.borders[region as usize];
        let found = match self.loops(region)? {
            Some(loops) if !loops.is_empty() => match loops.iter().find(|ridges| !has_corners(ridges)) {
                Some(ridges) => memory::gathered(ridges.iter().map(|ridge| ridge.neighbor))?,
                None => match self.met_off_line(border, &loops, &Set::of(region))? {
                    Some(met) => vec![met],
                    None => return Ok(None),
                },
            },
            _ => Vec::new(),
        };
        Ok(Some(memory::sifted(found.into_iter().filter(|&r| r != OUTSIDE).chain([region]))?))
    }
}
