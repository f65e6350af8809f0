//! Triangles of a surface that pass through each other.

use robust::{orient3d, Coord3D};

use super::closest::ClosestPoint;
use crate::memory;
use crate::mesh::vector::Point;
use crate::Result;

/// The pairs of triangles, given by corners and places, that cross: an edge of one passes through the inside
/// of the other. What only touches does not. Places follow from corners.
pub(crate) fn crossings(triangles: &[[u32; 3]], places: &[[Point; 3]]) -> Result<Vec<[u32; 2]>> {
    // Points pass through nothing, and triangles of the same corners not through each other: thousands of
    // them in one place are not looked at in pairs.
    let is_point = |[a, b, c]: [Point; 3]| a == b && b == c;
    let sorted = |i: u32| {
        let mut corners = triangles[i as usize];
        corners.sort_unstable();
        (corners, i)
    };
    let extended = (0..).zip(places).filter(|(_, &place)| !is_point(place)).map(|(i, _)| sorted(i));
    let mut by_corners: Vec<([u32; 3], u32)> = memory::sifted(extended)?;
    by_corners.sort_unstable();
    // The triangles that each stands for, by the first of them.
    let mut alike: Vec<&[([u32; 3], u32)]> = memory::sifted(by_corners.chunk_by(|a, b| a.0 == b.0))?;
    alike.sort_unstable_by_key(|group| group[0].1);
    let place = |group: &[([u32; 3], u32)]| places[group[0].1 as usize];
    let tree = ClosestPoint::new(memory::gathered(alike.iter().map(|group| place(group)))?)?;
    let mut found = Vec::new();
    for (n, group) in alike.iter().enumerate() {
        let mut pushed = Ok(());
        let [low, high] = box_of(&place(group));
        tree.visit_box(low, high, &mut |m| {
            let of =
                |group: &[([u32; 3], u32)]| (&triangles[group[0].1 as usize], &places[group[0].1 as usize]);
            let others = alike[m as usize];
            if m as usize > n && cross(of(group), of(others)) {
                for (i, j) in group.iter().flat_map(|i| others.iter().map(move |j| (i.1, j.1))) {
                    if let Err(error) = memory::push(&mut found, [i.min(j), i.max(j)]) {
                        pushed = Err(error);
                    }
                }
            }
        });
        pushed?;
    }
    found.sort_unstable();
    Ok(found)
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
}
