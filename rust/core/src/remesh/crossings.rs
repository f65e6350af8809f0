//! Triangles of a surface that pass through each other.

use std::ops::Range;

use robust::{orient3d, Coord3D};

use super::closest::ClosestPoint;
use crate::memory;
use crate::mesh::vector::Point;
use crate::Result;

/// The pairs of triangles, given by corners and places, that cross: an edge of one passes through the inside
/// of the other. What only touches does not. Places follow from corners.
pub(crate) fn crossings(triangles: &[[u32; 3]], places: &[[Point; 3]]) -> Result<Vec<[u32; 2]>> {
    crossings_between(triangles, places, &[])
}

/// The same, where it is known of ranges of triangles, in ascending order, that none of one range cross, as
/// those of one polygon: thousands of thin ones side by side lie in each other's boxes.
pub(crate) fn crossings_between(
    triangles: &[[u32; 3]],
    places: &[[Point; 3]],
    apart: &[Range<u32>],
) -> Result<Vec<[u32; 2]>> {
    let mut found = Vec::new();
    let of = |i: u32| (&triangles[i as usize], &places[i as usize]);
    candidates(triangles, places, apart, &mut |group, others| {
        if cross(of(group[0].1), of(others[0].1)) {
            for (i, j) in group.iter().flat_map(|i| others.iter().map(move |j| (i.1, j.1))) {
                memory::push(&mut found, [i.min(j), i.max(j)])?;
            }
        }
        Ok(())
    })?;
    found.sort_unstable();
    Ok(found)
}

/// Corners in ascending order, and the triangle.
type Named = ([u32; 3], u32);

/// Trees of triangles: of each range one for itself, and of all others.
struct Forest {
    /// The range, none for all others; the tree, and what its triangles stand for.
    trees: Vec<(Option<u32>, ClosestPoint, Vec<u32>)>,
    /// The boxes of the trees.
    tops: ClosestPoint,
}

impl Forest {
    /// `range_of` and `place` are given for each of `n` triangles.
    fn new(
        n: usize,
        range_of: impl Fn(usize) -> Option<u32>,
        place: impl Fn(usize) -> [Point; 3],
    ) -> Result<Self> {
        let mut members: Vec<(Option<u32>, u32)> = memory::gathered((0..n).map(|i| (range_of(i), i as u32)))?;
        members.sort_unstable();
        let (mut trees, mut tops) = (Vec::new(), Vec::new());
        for group in members.chunk_by(|a, b| a.0 == b.0) {
            let own = memory::gathered(group.iter().map(|&(_, i)| place(i as usize)))?;
            let [low, high] = box_of(own.as_flattened());
            memory::push(&mut tops, [low, high, low])?;
            let stands_for = memory::gathered(group.iter().map(|&(_, i)| i))?;
            memory::push(&mut trees, (group[0].0, ClosestPoint::new(own)?, stands_for))?;
        }
        Ok(Self { trees, tops: ClosestPoint::new(tops)? })
    }

    /// Visits what may cross a triangle that is of a range, if it is of one.
    fn visit(&self, triangle: [Point; 3], range: Option<u32>, visit: &mut impl FnMut(u32)) {
        self.tops.visit_crossing(triangle, &mut |t| {
            let (of, tree, stands_for) = &self.trees[t as usize];
            if range.is_none() || range != *of {
                tree.visit_crossing(triangle, &mut |m| visit(stands_for[m as usize]));
            }
        });
    }
}

/// Visits the pairs that may cross, each time all triangles of the same corners together.
fn candidates(
    triangles: &[[u32; 3]],
    places: &[[Point; 3]],
    apart: &[Range<u32>],
    visit: &mut impl FnMut(&[Named], &[Named]) -> Result<()>,
) -> Result<()> {
    // Points pass through nothing, and triangles of the same corners not through each other: thousands of
    // them in one place are not looked at in pairs.
    let is_point = |[a, b, c]: [Point; 3]| a == b && b == c;
    let sorted = |i: u32| {
        let mut corners = triangles[i as usize];
        corners.sort_unstable();
        (corners, i)
    };
    let extended = (0..).zip(places).filter(|(_, &place)| !is_point(place)).map(|(i, _)| sorted(i));
    let mut by_corners: Vec<Named> = memory::sifted(extended)?;
    by_corners.sort_unstable();
    // The triangles that each stands for, by the first of them.
    let mut alike: Vec<&[Named]> = memory::sifted(by_corners.chunk_by(|a, b| a.0 == b.0))?;
    alike.sort_unstable_by_key(|group| group[0].1);
    let place = |n: usize| places[alike[n][0].1 as usize];
    // Of those that stand for others as well nothing is known.
    let range_of = |n: usize| {
        let (t, is_one) = (alike[n][0].1, alike[n].len() == 1);
        let r = apart.partition_point(|range| range.end <= t);
        apart.get(r).filter(|range| is_one && range.contains(&t)).map(|_| r as u32)
    };
    let forest = Forest::new(alike.len(), range_of, place)?;
    for (n, group) in alike.iter().enumerate() {
        let mut done = Ok(());
        forest.visit(place(n), range_of(n), &mut |m| {
            if m as usize > n && done.is_ok() {
                done = visit(group, alike[m as usize]);
            }
        });
        done?;
    }
    Ok(())
}

/// The least and the largest coordinates of points.
fn box_of(points: &[Point]) -> [Point; 2] {
    let all = |c: usize| points.iter().map(move |p| p[c]);
    let low = [0, 1, 2].map(|c| all(c).fold(f64::INFINITY, f64::min));
    [low, [0, 1, 2].map(|c| all(c).fold(f64::NEG_INFINITY, f64::max))]
}

/// Whether an edge of one of two triangles, given by corners and places, passes through the other, from which
/// it starts at no common corner.
pub(crate) fn cross(first: (&[u32; 3], &[Point; 3]), second: (&[u32; 3], &[Point; 3])) -> bool {
    let is_through = |(own, at): (&[u32; 3], &[Point; 3]), (other, place): (&[u32; 3], &[Point; 3])| {
        (0..3).any(|k| {
            let ends = [k, (k + 1) % 3];
            ends.iter().all(|&e| !other.contains(&own[e]))
                && meet(&ends.map(|e| at[e]), place)
                && passes(ends.map(|e| at[e]), *place)
        })
    };
    is_through(first, second) || is_through(second, first)
}

/// Whether the boxes of points meet. Thin triangles around one vertex lie in each other's boxes, all of them;
/// the edges across from it hardly do.
fn meet(a: &[Point], b: &[Point]) -> bool {
    let ([a_low, a_high], [b_low, b_high]) = (box_of(a), box_of(b));
    (0..3).all(|c| a_low[c] <= b_high[c] && b_low[c] <= a_high[c])
}

fn passes([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    // Exact arithmetic would say the same of what has no length or no inside.
    if p == q || a == b || b == c || c == a {
        return false;
    }
    let side = |a: Point, b: Point, c: Point, d: Point| {
        let [a, b, c, d] = [a, b, c, d].map(|[x, y, z]| Coord3D { x, y, z });
        orient3d(a, b, c, d)
    };
    let ends = [side(a, b, c, p), side(a, b, c, q)];
    if ends[0] * ends[1] >= 0.0 {
        return false;
    }
    let around = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    around.iter().all(|s| *s > 0.0) || around.iter().all(|s| *s < 0.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn triangles_of_the_same_corners_cross_all_that_one_of_them_does_and_not_each_other() {
        let points = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [1.0, 1.0, -1.0],
            [1.0, 1.0, 1.0],
            [9.0, 9.0, 1.0],
        ];
        let triangles = [[0, 1, 2], [3, 4, 5], [1, 2, 0], [2, 1, 0], [5, 4, 3]];
        let places = triangles.map(|t| t.map(|v| points[v as usize]));
        let found = crossings(&triangles, &places).unwrap();
        assert_eq!(found, [[0, 1], [0, 4], [1, 2], [1, 3], [2, 4], [3, 4]]);
    }

    /// Triangles from the origin to every side, or all at one edge, and one that passes through some of them.
    fn pierced(n: usize, at_edge: bool) -> (Vec<[u32; 3]>, Vec<[Point; 3]>) {
        let mut points = vec![[0.0; 3], [0.0, 0.0, 1.0], [0.9, -0.1, -0.4], [0.9, 0.3, 0.9], [0.2, 0.2, 0.9]];
        points.extend((0..n).map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [angle.cos(), angle.sin(), 0.2 * (5.0 * angle).cos()]
        }));
        let rim = |i: usize| 5 + (i % n) as u32;
        let mut triangles: Vec<[u32; 3]> =
            (0..n).map(|i| [0, rim(i), if at_edge { 1 } else { rim(i + 1) }]).collect();
        triangles.push([2, 3, 4]);
        triangles.push([0, 3, 2]);
        let places = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
        (triangles, places)
    }

    #[test]
    fn where_thousands_of_triangles_meet_crossings_are_those_of_all_pairs() {
        for at_edge in [false, true] {
            let (triangles, places) = pierced(2000, at_edge);
            let of = |i: usize| (&triangles[i], &places[i]);
            let n = triangles.len();
            let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
            let expected: Vec<[u32; 2]> =
                pairs.filter(|&[i, j]| cross(of(i), of(j))).map(|pair| pair.map(|i| i as u32)).collect();
            assert!(expected.len() > 10, "{}", expected.len());
            assert_eq!(crossings(&triangles, &places).unwrap(), expected);
        }
    }

    /// The zigzag between two sides of a round polygon, whose triangles lie in each other's boxes, and one
    /// triangle that passes through some of them.
    fn striped(n: usize) -> (Vec<[u32; 3]>, Vec<[Point; 3]>) {
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * (i as f64 / n as f64 + 0.1);
            [angle.cos(), angle.sin(), 0.1 * angle.cos()]
        };
        let mut points: Vec<Point> = (0..n).map(corner).collect();
        points.extend([[0.3, 0.1, -1.0], [-0.3, 0.1, 1.0], [0.1, -0.4, 1.0]]);
        // From both ends of a chain of corners inward.
        let zigzag = |i: usize| if i.is_multiple_of(2) { i / 2 } else { n - 1 - i / 2 } as u32;
        let mut triangles: Vec<[u32; 3]> = (0..n - 2).map(|i| [i, i + 1, i + 2].map(zigzag)).collect();
        triangles.push([0, 1, 2].map(|i| (n + i) as u32));
        let places = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
        (triangles, places)
    }

    #[test]
    fn of_a_polygon_of_twice_as_many_corners_about_twice_as_many_pairs_are_looked_at() {
        let n_pairs = |n: usize| {
            let (triangles, places) = striped(n);
            let whole = 0..triangles.len() as u32 - 1;
            let apart = std::slice::from_ref(&whole);
            let found = crossings_between(&triangles, &places, apart).unwrap();
            assert_eq!(found, crossings(&triangles, &places).unwrap());
            assert!(found.len() > 2, "{found:?}");
            let mut n_pairs = 0;
            candidates(&triangles, &places, apart, &mut |_, _| {
                n_pairs += 1;
                Ok(())
            })
            .unwrap();
            n_pairs
        };
        let [few, many] = [1000, 2000].map(n_pairs);
        assert!(4 * many <= 9 * few, "{few}, {many}");
    }

    #[test]
    fn triangles_of_one_range_that_are_there_twice_cross_what_they_cross() {
        let (mut triangles, mut places) = striped(50);
        triangles.push(triangles[20]);
        places.push(places[20]);
        let all = crossings(&triangles, &places).unwrap();
        assert_eq!(crossings_between(&triangles, &places, &[0..10, 10..48]).unwrap(), all);
    }

    #[test]
    fn of_twice_as_many_triangles_that_meet_about_twice_as_many_pairs_are_looked_at() {
        for at_edge in [false, true] {
            let n_pairs = |n: usize| {
                let (_, places) = pierced(n, at_edge);
                let tree = ClosestPoint::new(places[..n].to_vec()).unwrap();
                let mut n_pairs = 0;
                places[..n].iter().for_each(|&t| tree.visit_crossing(t, &mut |_| n_pairs += 1));
                n_pairs
            };
            let [few, many] = [2000, 4000].map(n_pairs);
            assert!(4 * many <= 9 * few, "at an edge: {at_edge}; {few}, {many}");
        }
    }
}
