//! Triangles of a surface that pass through each other.

use robust::{orient3d, Coord3D};

use crate::memory;
use crate::mesh::vector::Point;
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// The pairs of triangles, given by corners and places, that cross: an edge of one passes through the inside
/// of the other. What only touches does not.
pub(super) fn crossings(triangles: &[[u32; 3]], place: impl Fn(u32) -> Point) -> Result<Vec<[u32; 2]>> {
    let places = memory::gathered(triangles.iter().map(|t| t.map(&place)))?;
    let tree = ClosestPoint::new(memory::twin(&places)?)?;
    let mut found = Vec::new();
    for (i, triangle) in places.iter().enumerate() {
        let (mut low, mut high) = (triangle[0], triangle[0]);
        for corner in &triangle[1..] {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(corner[c]), high[c].max(corner[c]));
            }
        }
        tree.visit_box(low, high, &mut |j| {
            let other = j as usize;
            if other > i && (cross(triangles, &places, i, other) || cross(triangles, &places, other, i)) {
                found.push([i as u32, j]);
            }
        });
    }
    found.sort_unstable();
    Ok(found)
}

/// Whether an edge of triangle `i` passes through triangle `j`, from which it starts at no common corner.
fn cross(triangles: &[[u32; 3]], places: &[[Point; 3]], i: usize, j: usize) -> bool {
    (0..3).any(|k| {
        let ends = [k, (k + 1) % 3];
        ends.iter().all(|&e| !triangles[j].contains(&triangles[i][e]))
            && passes(ends.map(|e| places[i][e]), places[j])
    })
}

fn passes([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
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
