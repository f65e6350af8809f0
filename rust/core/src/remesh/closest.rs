//! The closest point of a surface, by a tree of boxes.

use super::fans::{self, Fan, Rim};
use crate::memory;
use crate::mesh::vector::{add, area_vector, between, centroid, cross, dot, norm, scale, sub, Point};
use crate::Result;

/// Triangles a leaf holds: fewer make a deeper tree, more make more distances; 4 was fastest by a little.
const LEAF: usize = 4;

/// Marks the count of a leaf whose triangles all lie on each other: the distance to one is that to all. No
/// box tells them apart, and thousands of them would be looked at in turn.
const STACK: u32 = 1 << 31;

/// How far outside a triangle a ray still meets it, in parts of its edges:
/// so that none slips through between two.
const EDGE: f64 = 1e-9;

/// A point on one of the triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// The point.
    pub point: Point,
    /// The triangle.
    pub triangle: u32,
    /// The squared distance to it.
    pub squared: f64,
}

/// Triangles in a tree of boxes. A triangle may be degenerate: a segment is one with two equal corners.
#[derive(Debug, Clone)]
pub struct ClosestPoint {
    triangles: Vec<[Point; 3]>,
    nodes: Vec<Node>,
    order: Vec<u32>,
    /// Where very many triangles meet, and what bounds each node by directions from there; nothing where they
    /// do not.
    fans: Vec<Fan>,
    rims: Vec<Rim>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    low: Point,
    high: Point,
    /// A leaf: the range in `order`; the count may be marked as a [`STACK`]. An inner node: its second child
    /// (the first one follows it), and 0.
    start: u32,
    count: u32,
}

impl ClosestPoint {
    /// The tree of `triangles`.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn new(triangles: Vec<[Point; 3]>) -> Result<Self> {
        let mut centers = memory::gathered(triangles.iter().map(|&t| centroid(t)))?;
        let order = memory::sifted(0..triangles.len() as u32)?;
        let mut tree = Self { order, triangles, nodes: Vec::new(), fans: Vec::new(), rims: Vec::new() };
        if !tree.triangles.is_empty() {
            tree.build(0, tree.triangles.len(), &mut centers, fans::NONE)?;
        }
        Ok(tree)
    }

    /// The node of a range of triangles, and all below; they are of one fan, or of none.
    fn build(&mut self, start: usize, end: usize, centers: &mut [Point], fan: u32) -> Result<()> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in self.order[start..end].iter().flat_map(|&t| self.triangles[t as usize]) {
            for k in 0..3 {
                low[k] = low[k].min(corner[k]);
                high[k] = high[k].max(corner[k]);
            }
        }
        let node = self.nodes.len();
        let count = (end - start) as u32;
        memory::push(&mut self.nodes, Node { low, high, start: start as u32, count })?;
        self.bound(node, fan)?;
        if end - start <= LEAF {
            return Ok(());
        }
        let corners = |t: u32| self.triangles[t as usize];
        let first = corners(self.order[start]);
        let is_same = |&t: &u32| {
            corners(t).iter().all(|p| first.contains(p)) && first.iter().all(|p| corners(t).contains(p))
        };
        if self.order[start..end].iter().all(is_same) {
            self.nodes[node].count |= STACK;
            return Ok(());
        }
        let mut extent = sub(high, low);
        if fan == fans::NONE {
            if let Some((found, n)) = fans::gather(&self.triangles, &mut self.order[start..end])? {
                let fan = self.fans.len() as u32;
                for &t in &self.order[start..start + n] {
                    centers[t as usize] = found.direction(self.triangles[t as usize]);
                }
                memory::push(&mut self.fans, found)?;
                return self.divide(node, [start, start + n, end], centers, [fan, fans::NONE]);
            }
        } else {
            let all = || self.order[start..end].iter().map(|&t| centers[t as usize]);
            let side = |k: usize, f: fn(f64, f64) -> f64, from: f64| all().map(|p| p[k]).fold(from, f);
            extent = [0, 1, 2].map(|k| side(k, f64::max, -1.0) - side(k, f64::min, 1.0));
        }
        let axis = if extent[0] >= extent[1] && extent[0] >= extent[2] {
            0
        } else {
            1 + usize::from(extent[2] > extent[1])
        };
        let middle = (end - start) / 2;
        self.order[start..end].select_nth_unstable_by(middle, |&a, &b| {
            centers[a as usize][axis].total_cmp(&centers[b as usize][axis]).then(a.cmp(&b))
        });
        self.divide(node, [start, start + middle, end], centers, [fan; 2])
    }

    /// The two nodes below another, the second of which may have no triangles: then both are one.
    fn divide(
        &mut self,
        node: usize,
        [start, middle, end]: [usize; 3],
        centers: &mut [Point],
        fans: [u32; 2],
    ) -> Result<()> {
        if middle == end {
            self.nodes.truncate(node);
            self.rims.truncate(node);
            return self.build(start, end, centers, fans[0]);
        }
        self.build(start, middle, centers, fans[0])?;
        let second = self.nodes.len() as u32;
        (self.nodes[node].start, self.nodes[node].count) = (second, 0);
        self.build(middle, end, centers, fans[1])
    }

    /// Bounds the last node by directions.
    fn bound(&mut self, node: usize, fan: u32) -> Result<()> {
        if self.fans.is_empty() {
            return Ok(());
        }
        let more = node + 1 - self.rims.len();
        memory::extend(&mut self.rims, more)?;
        self.rims.resize(node, Rim::NOWHERE);
        let Node { start, count, .. } = self.nodes[node];
        let of = self.order[start as usize..(start + count) as usize].iter();
        let rim =
            self.fans.get(fan as usize).map(|own| own.bounds(fan, of.map(|&t| self.triangles[t as usize])));
        self.rims.push(rim.unwrap_or(Rim::NOWHERE));
        Ok(())
    }

    /// What bounds a node by directions, if anything does.
    fn fan(&self, node: usize) -> Option<(&Fan, &Rim)> {
        let rim = self.rims.get(node)?;
        Some((self.fans.get(rim.fan as usize)?, rim))
    }

    /// At most the squared distance of a point from the triangles of a node.
    fn squared_distance(&self, node: usize, p: Point) -> f64 {
        let of_box = self.nodes[node].squared_distance(p);
        self.fan(node).map_or(of_box, |(fan, rim)| of_box.max(fan.squared_distance(rim, p)))
    }

    /// The point closest to `p` among the triangles that `accept` takes; `guess` is one that may be close. Of
    /// equally close ones the first found is taken, always the same.
    #[must_use]
    pub fn closest(&self, p: Point, guess: Option<u32>, accept: impl Fn(u32) -> bool) -> Option<Closest> {
        let candidate = |triangle: u32| {
            let point = closest_on_triangle(p, self.triangles[triangle as usize]);
            let d = sub(point, p);
            Closest { point, triangle, squared: dot(d, d) }
        };
        let mut best = guess.filter(|&g| (g as usize) < self.triangles.len() && accept(g)).map(candidate);
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push((self.squared_distance(0, p), 0));
        }
        while let Some((squared, n)) = stack.pop() {
            if best.is_some_and(|found| squared >= found.squared) {
                continue;
            }
            let node = &self.nodes[n];
            if node.count > 0 {
                for &triangle in self.triangles_of(node) {
                    if accept(triangle) {
                        let found = candidate(triangle);
                        if best.is_none_or(|b| found.squared < b.squared) {
                            best = Some(found);
                        }
                        if node.count & STACK != 0 {
                            break;
                        }
                    }
                }
            } else {
                let mut children = [n + 1, node.start as usize].map(|c| (self.squared_distance(c, p), c));
                if children[0].0 < children[1].0 {
                    children.swap(0, 1);
                }
                stack.extend(children);
            }
        }
        best
    }

    /// The first of the `wanted` triangles that the ray from `from` along `direction` meets farther than
    /// `start` away, and how far, in lengths of `direction`.
    pub fn first_hit(
        &self,
        from: Point,
        direction: Point,
        start: f64,
        wanted: impl Fn(u32) -> bool,
    ) -> Option<(f64, u32)> {
        let mut best: Option<(f64, u32)> = None;
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push(0);
        }
        while let Some(n) = stack.pop() {
            let node = &self.nodes[n];
            if !node.is_met(from, direction, [start, best.map_or(f64::INFINITY, |found| found.0)]) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.start as usize, n + 1]);
                continue;
            }
            for &triangle in self.triangles_of(node).iter().filter(|t| wanted(**t)) {
                let met = ray_meets(from, direction, self.triangles[triangle as usize]);
                if let Some(far) = met.filter(|far| *far > start && best.is_none_or(|found| *far < found.0)) {
                    best = Some((far, triangle));
                }
            }
        }
        best
    }

    /// Visits the triangles that may cross another: those whose boxes, or those of the leaf that they are in,
    /// meet its box, but not those that only meet it in a common corner where very many do.
    pub(super) fn visit_crossing(&self, triangle: [Point; 3], visit: &mut impl FnMut(u32)) {
        let side =
            |f: fn(f64, f64) -> f64| [0, 1, 2].map(|k| f(f(triangle[0][k], triangle[1][k]), triangle[2][k]));
        let (low, high) = (side(f64::min), side(f64::max));
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push(0);
        }
        while let Some(n) = stack.pop() {
            let node = &self.nodes[n];
            if (0..3).any(|k| node.low[k] > high[k] || node.high[k] < low[k]) {
                continue;
            }
            if self.fan(n).is_some_and(|(fan, rim)| !fan.may_cross(rim, triangle)) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.start as usize, n + 1]);
                continue;
            }
            self.triangles_of(node).iter().for_each(|&t| visit(t));
        }
    }

    /// The triangles of a leaf.
    fn triangles_of(&self, leaf: &Node) -> &[u32] {
        &self.order[leaf.start as usize..(leaf.start + (leaf.count & !STACK)) as usize]
    }

    /// The corners of a triangle.
    #[must_use]
    pub fn triangle(&self, t: u32) -> [Point; 3] {
        self.triangles[t as usize]
    }
}

impl Node {
    /// Whether a ray goes through the box between two distances.
    fn is_met(&self, from: Point, direction: Point, [mut near, mut far]: [f64; 2]) -> bool {
        for k in 0..3 {
            let [p, q] = [self.low, self.high].map(|corner| (corner[k] - from[k]) / direction[k]);
            // A ray along a side of the box divides zero by zero; such a pair of planes does not count.
            if p.is_nan() || q.is_nan() {
                continue;
            }
            near = near.max(p.min(q));
            far = far.min(p.max(q));
        }
        near <= far
    }

    fn squared_distance(&self, p: Point) -> f64 {
        (0..3).map(|k| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0).powi(2)).sum()
    }
}

/// Where a ray meets a triangle, in lengths of `direction` (Möller and Trumbore 1997).
fn ray_meets(from: Point, direction: Point, [a, b, c]: [Point; 3]) -> Option<f64> {
    let (u, v) = (sub(b, a), sub(c, a));
    let across = cross(direction, v);
    let volume = dot(u, across);
    let out = sub(from, a);
    let around = cross(out, u);
    let [first, second, far] = [dot(out, across), dot(direction, around), dot(v, around)].map(|x| x / volume);
    // A ray in the plane of the triangle gives no numbers here, and fails.
    (first >= -EDGE && second >= -EDGE && first + second <= 1.0 + EDGE).then_some(far)
}

/// The point of the triangle closest to `p` (Ericson 2005, section 5.1.5).
#[must_use]
pub fn closest_on_triangle(p: Point, [a, b, c]: [Point; 3]) -> Point {
    let normal = area_vector([a, b, c]);
    let inside = |from: Point, to: Point| dot(area_vector([from, to, p]), normal) > 0.0;
    if norm(normal) > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        let height = dot(sub(p, a), normal) / dot(normal, normal);
        return add(p, scale(normal, -height));
    }
    let squared = |q: Point| dot(sub(q, p), sub(q, p));
    let mut best = closest_on_segment(p, a, b);
    for q in [closest_on_segment(p, b, c), closest_on_segment(p, c, a)] {
        if squared(q) < squared(best) {
            best = q;
        }
    }
    best
}

/// The point of the segment closest to `p`.
#[must_use]
pub fn closest_on_segment(p: Point, a: Point, b: Point) -> Point {
    let along = sub(b, a);
    let squared = dot(along, along);
    if squared > 0.0 {
        between(a, b, (dot(sub(p, a), along) / squared).clamp(0.0, 1.0))
    } else {
        a
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::random::Random;
    use std::cell::Cell;

    #[test]
    fn of_thousands_of_triangles_on_each_other_a_few_are_looked_at() {
        let mut random = Random::new(1);
        let mut triangle = || [(); 3].map(|()| [(); 3].map(|()| random.symmetric()));
        let [a, b, c] = triangle();
        let mut triangles: Vec<[Point; 3]> = (0..50).map(|_| triangle()).collect();
        triangles.extend((0..4000).map(|i| if i % 2 == 0 { [a, b, c] } else { [c, a, b] }));
        let tree = ClosestPoint::new(triangles.clone()).unwrap();
        for _ in 0..50 {
            let [p, ..] = triangle();
            let n_asked = Cell::new(0);
            let found = tree.closest(p, None, |_| n_asked.replace(n_asked.get() + 1) < usize::MAX).unwrap();
            let squared = |&t: &[Point; 3]| {
                let d = sub(closest_on_triangle(p, t), p);
                dot(d, d)
            };
            let least = triangles.iter().map(squared).fold(f64::INFINITY, f64::min);
            assert!((found.squared - least).abs() <= 1e-15);
            assert!(n_asked.get() < 150, "{}", n_asked.get());
            let mut n_met = 0;
            tree.visit_crossing([a; 3], &mut |t| n_met += usize::from(t >= 50));
            assert_eq!(n_met, 4000);
        }
    }
}
