//! Triangles that all meet at one vertex, or at one edge, in a tree of boxes.
//!
//! Thousands of them lie in each other's boxes, so that boxes tell none of them from another. Directions do:
//! seen from where they meet, each fills a narrow cone, or a wedge around the edge, over what is across from
//! there, its rim. So such a part of a tree is divided by directions, and bounded by the cone over the box
//! of its rims.

use super::editable::HUB;
use crate::memory;
use crate::mesh::vector::{cross, dot, place, sub, unit, Point};
use crate::Result;

/// So many triangles of a node are looked at for a corner that many have, and so many of them must have it:
/// then about a quarter of all do.
const SAMPLE: [usize; 2] = [16, 4];

/// What rounding may have moved, as a part of the coordinates: far more than it does.
const ROUNDING: f64 = 1e-12;

/// No fan.
pub(super) const NONE: u32 = u32::MAX;

/// Where triangles meet: one place, or two.
#[derive(Debug, Clone)]
pub(super) struct Fan {
    apexes: [Point; 2],
    is_edge: bool,
    /// Directions seen from there: all three, or the two across the edge.
    rows: [Point; 3],
}

/// What bounds the triangles of a node: the box of their rims, seen from where they meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rim {
    pub fan: u32,
    low: Point,
    high: Point,
    /// What rounding may have moved.
    slack: f64,
}

impl Rim {
    pub(super) const NOWHERE: Self = Self { fan: NONE, low: [0.0; 3], high: [0.0; 3], slack: 0.0 };
}

/// A place that more than [`HUB`] of the triangles in `order` have as a corner, a quarter of them or so, or
/// two that so many have both; those that have them come first then, and their number is returned.
pub(super) fn gather(triangles: &[[Point; 3]], order: &mut [u32]) -> Result<Option<(Fan, usize)>> {
    if order.len() <= HUB {
        return Ok(None);
    }
    let Some((apex, own)) = common(triangles, order, |_| true)? else { return Ok(None) };
    let at_edge = common(triangles, &own, |p| p != apex)?;
    let (fan, own) = match at_edge {
        Some((other, both)) => (Fan::at_edge(apex, other), both),
        None => (Fan::at(apex), own),
    };
    let rest: Vec<u32> = memory::sifted(order.iter().copied().filter(|&t| !fan.has(triangles[t as usize])))?;
    order[..own.len()].copy_from_slice(&own);
    order[own.len()..].copy_from_slice(&rest);
    Ok(Some((fan, own.len())))
}

/// A corner that many triangles have, of those that are `wanted`, and the triangles.
fn common(
    triangles: &[[Point; 3]],
    order: &[u32],
    wanted: impl Fn(Point) -> bool,
) -> Result<Option<(Point, Vec<u32>)>> {
    let [n_looked, n_common] = SAMPLE;
    let corners = |i: usize| triangles[order[i * order.len() / n_looked] as usize];
    let mut seen: Vec<([u64; 3], Point)> =
        memory::sifted((0..n_looked).flat_map(corners).filter(|p| wanted(*p)).map(|p| (place(p), p)))?;
    seen.sort_unstable_by_key(|corner| corner.0);
    let most = seen.chunk_by(|a, b| a.0 == b.0).max_by_key(|group| group.len());
    let Some(&[(_, apex), ..]) = most.filter(|group| group.len() >= n_common) else { return Ok(None) };
    let has = |&t: &u32| triangles[t as usize].contains(&apex);
    let own: Vec<u32> = memory::sifted(order.iter().copied().filter(has))?;
    Ok((own.len() > HUB).then_some((apex, own)))
}

impl Fan {
    fn at(apex: Point) -> Self {
        Self { apexes: [apex; 2], is_edge: false, rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    }

    fn at_edge(apex: Point, other: Point) -> Self {
        let along = unit(sub(other, apex));
        let least = (0..3).fold(0, |least, i| if along[i].abs() < along[least].abs() { i } else { least });
        let mut beside = [0.0; 3];
        beside[least] = 1.0;
        let x = unit(cross(along, beside));
        Self { apexes: [apex, other], is_edge: true, rows: [x, cross(along, x), [0.0; 3]] }
    }

    fn has(&self, triangle: [Point; 3]) -> bool {
        self.apexes.iter().all(|apex| triangle.contains(apex))
    }

    fn seen(&self, p: Point) -> Point {
        self.rows.map(|row| dot(row, sub(p, self.apexes[0])))
    }

    /// The corners of a triangle across from where all meet.
    fn rim(&self, triangle: [Point; 3]) -> impl Iterator<Item = Point> + '_ {
        triangle.into_iter().filter(|p| !self.apexes.contains(p))
    }

    /// Where a triangle is seen.
    pub(super) fn direction(&self, triangle: [Point; 3]) -> Point {
        unit(
            self.rim(triangle)
                .map(|p| self.seen(p))
                .fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k])),
        )
    }

    /// What bounds triangles.
    pub(super) fn bounds(&self, fan: u32, triangles: impl Iterator<Item = [Point; 3]>) -> Rim {
        let (mut low, mut high, mut size) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
        for p in triangles.flat_map(|t| self.rim(t)) {
            let q = self.seen(p);
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(q[k]), high[k].max(q[k]));
                size = size.max(p[k].abs()).max(self.apexes[0][k].abs());
            }
        }
        if size == 0.0 {
            // All are no more than where they meet.
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        Rim { fan, low, high, slack: ROUNDING * size }
    }

    /// At most the squared distance of a point from the triangles of a node. The cone is the box of the rims
    /// at every size up to its own, and the distance from it is convex in the size.
    pub(super) fn squared_distance(&self, rim: &Rim, p: Point) -> f64 {
        let q = self.seen(p);
        let mut marks = [1.0; 8];
        marks[0] = 0.0;
        for k in 0..3 {
            for (i, side) in [rim.low[k], rim.high[k]].into_iter().enumerate() {
                let size = q[k] / side;
                marks[1 + 2 * k + i] = if size > 0.0 && size < 1.0 { size } else { 1.0 };
            }
        }
        marks.sort_unstable_by(f64::total_cmp);
        let mut least = f64::INFINITY;
        for ends in marks.windows(2) {
            let middle = 0.5 * (ends[0] + ends[1]);
            // The sides of the box that the point is beyond.
            let beyond = [0, 1, 2].map(|k| {
                if middle * rim.low[k] > q[k] {
                    Some(rim.low[k])
                } else {
                    Some(rim.high[k]).filter(|high| middle * high < q[k])
                }
            });
            let of = |f: &dyn Fn(usize, f64) -> f64| -> f64 {
                beyond.iter().enumerate().filter_map(|(k, side)| side.map(|side| f(k, side))).sum()
            };
            let size = of(&|k, side| side * q[k]) / of(&|_, side| side * side);
            let size = if size.is_nan() { middle } else { size.clamp(ends[0], ends[1]) };
            least = least.min(of(&|k, side| (size * side - q[k]).powi(2)));
        }
        (least.sqrt() * (1.0 - ROUNDING) - rim.slack).max(0.0).powi(2)
    }

    /// Whether triangles of a node may cross another that has its corners here: an edge of one passes through
    /// the inside of the other. What has a corner in common, by place, does not do so there.
    pub(super) fn may_cross(&self, rim: &Rim, triangle: [Point; 3]) -> bool {
        let n_shared = self.apexes.iter().filter(|apex| triangle.contains(apex)).count();
        match (self.is_edge, n_shared) {
            (_, 0) => self.meets(rim, &triangle),
            (true, 1) => true,
            (true, _) => false,
            (false, _) => {
                // Its edge across from there through one of them, or one of their rims through it.
                let mut across = triangle;
                let mut n = 0;
                for p in self.rim(triangle) {
                    across[n] = p;
                    n += 1;
                }
                let [low, high] = self.box_of(&triangle);
                let is_met =
                    (0..3).all(|k| rim.low[k] <= high[k] + rim.slack && low[k] - rim.slack <= rim.high[k]);
                n > 0 && (is_met || self.meets(rim, &across[..n]))
            }
        }
    }

    /// The box of points as they are seen.
    fn box_of(&self, points: &[Point]) -> [Point; 2] {
        points.iter().fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], &p| {
            let q = self.seen(p);
            [[0, 1, 2].map(|k| low[k].min(q[k])), [0, 1, 2].map(|k| high[k].max(q[k]))]
        })
    }

    /// Whether the box of points meets the cone: that of the rims does at some size.
    fn meets(&self, rim: &Rim, points: &[Point]) -> bool {
        let size = points.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
        let slack = rim.slack + ROUNDING * size;
        let [low, high] = self.box_of(points);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            // `size * rim.low <= high` and `size * -rim.high <= -low`.
            for (side, most) in [(rim.low[k], high[k] + slack), (-rim.high[k], slack - low[k])] {
                if side > 0.0 {
                    to = to.min(most / side);
                } else if side < 0.0 {
                    from = from.max(most / side);
                } else if most < 0.0 {
                    return false;
                }
            }
        }
        from <= to * (1.0 + ROUNDING) + ROUNDING
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::vector::{add, between, scale};
    use crate::random::Random;
    use crate::remesh::closest::{closest_on_triangle, ClosestPoint};
    use std::cell::Cell;

    /// Triangles from one place to every side of a wavy rim, or all at one edge.
    fn meeting(n: usize, at_edge: bool) -> Vec<[Point; 3]> {
        let rim = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [angle.cos(), angle.sin(), 0.1 * (3.0 * angle).sin()]
        };
        let other = |i: usize| if at_edge { [0.0, 0.0, 1.0] } else { rim((i + 1) % n) };
        (0..n).map(|i| [[0.0, 0.0, 0.3], rim(i), other(i)]).collect()
    }

    /// How many triangles are looked at around each of many points on `triangles`, and beside them.
    fn n_looked_at(triangles: &[[Point; 3]]) -> usize {
        let tree = ClosestPoint::new(triangles.to_vec()).unwrap();
        let mut random = Random::new(7);
        let n_asked = Cell::new(0);
        for i in 0..200 {
            let [a, b, c] = triangles[i * triangles.len() / 200];
            let (u, v) = (0.5 + 0.5 * random.symmetric(), 0.5 + 0.5 * random.symmetric());
            let on = between(a, between(b, c, v), u);
            let p = add(on, scale([0.3, -0.2, 1.0], if i % 2 == 0 { 0.0 } else { 1e-3 }));
            let found = tree.closest(p, None, |_| n_asked.replace(n_asked.get() + 1) < usize::MAX).unwrap();
            let squared =
                |&t: &[Point; 3]| dot(sub(closest_on_triangle(p, t), p), sub(closest_on_triangle(p, t), p));
            let least = triangles.iter().map(squared).fold(f64::INFINITY, f64::min);
            assert!((found.squared - least).abs() <= 1e-15);
        }
        n_asked.get()
    }

    #[test]
    fn where_twice_as_many_triangles_meet_hardly_more_are_looked_at() {
        for at_edge in [false, true] {
            let [few, many] = [2000, 4000].map(|n| n_looked_at(&meeting(n, at_edge)));
            assert!(3 * many < 4 * few, "at an edge: {at_edge}; {few}, {many}");
            // Among others as well.
            let beside = |n: usize| {
                let mut all = meeting(n, at_edge);
                let far = |t: [Point; 3]| t.map(|p| add(p, [0.2, 0.1, 0.05]));
                all.extend(meeting(n, !at_edge).into_iter().map(far));
                n_looked_at(&all)
            };
            let [few, many] = [1000, 4000].map(beside);
            assert!(many < 3 * few, "at an edge: {at_edge}, beside others; {few}, {many}");
        }
    }
}
