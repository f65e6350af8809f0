//! Pieces of surface that lie inside a hole of another.

use super::hole::Hole;
use super::places::Places;
use crate::error::Refusal;
use crate::mesh::vector::{add, cross, distance, dot, norm, scale, sub, unit, Point};
use crate::mesh::{cycle, loop_area_vector};

/// Pieces of less than this part of a hole's area are specks: they do not keep it from being filled,
/// and stay where they are.
const SPECK: f64 = 0.01;

/// A piece this far from the mean plane of a hole, as part of the square root of its area, is not inside it.
/// The rim of a hemisphere is 0.56 from its top.
const FAR: f64 = 0.6;

/// Rounding must not leave out what lies on the edge of a search.
const ROUNDING: f64 = 1e-6;

/// A loop seen from afar.
struct Outline {
    area: Point,
    center: Point,
}

impl Outline {
    fn of(vertices: &[u32], positions: &[Point]) -> Self {
        let sum = vertices.iter().fold([0.0; 3], |sum, &v| add(sum, positions[v as usize]));
        Self {
            area: loop_area_vector(vertices, positions),
            center: scale(sum, 1.0 / vertices.len().max(1) as f64),
        }
    }
}

/// Refuses the holes in which the whole border of an open sheet lies: a patch would cross it. Where that
/// border touches the rim at a vertex the hole is a ring around the sheet, pinched there, and both loops
/// become one.
///
/// `components` is the component of every hole. A sheet is in a hole of another component if its border runs
/// the other way around, lies near the hole's mean plane, and its center is inside the hole in the projection
/// onto that plane.
pub(super) fn settle_islands(
    holes: &mut Vec<Hole>,
    components: &mut Vec<Option<usize>>,
    positions: &[Point],
) {
    let outlines: Vec<Outline> = holes.iter().map(|hole| Outline::of(&hole.vertices, positions)).collect();
    let mut joined = vec![false; holes.len()];
    let borders = Places::new(
        (0..holes.len()).filter(|&j| holes[j].is_outer_border).map(|j| (outlines[j].center, j)).collect(),
    );
    for i in 0..holes.len() {
        if holes[i].is_outer_border || holes[i].refusal.is_some() {
            continue;
        }
        let hole = &outlines[i];
        let (size, normal) = (norm(hole.area), unit(hole.area));
        let rim = holes[i].vertices.clone();
        let holds = |j: usize| {
            let island = &outlines[j];
            components[i] != components[j]
                && dot(island.area, normal) < -SPECK * size
                && norm(island.area) < size
                && dot(sub(island.center, hole.center), normal).abs() < FAR * size.sqrt()
                && encloses(&rim, positions, normal, island.center)
        };
        // The center of what it holds is inside its rim, and near its plane.
        let from = |&v: &u32| distance(positions[v as usize], hole.center);
        let radius = rim.iter().map(from).fold(0.0, f64::max).hypot(FAR * size.sqrt());
        let mut islands = borders.within(hole.center, radius * (1.0 + ROUNDING));
        islands.retain(|&j| !joined[j] && holds(j));
        for j in islands {
            let island = std::mem::take(&mut holes[j].vertices);
            match ring(&holes[i].vertices, &island) {
                Some(ring) => {
                    holes[i].vertices = ring;
                    joined[j] = true;
                }
                None => {
                    holes[j].vertices = island;
                    holes[i].refusal = Some(Refusal::Island);
                }
            }
        }
    }
    let mut is_left = joined.iter().map(|joined| !joined);
    holes.retain(|_| is_left.next().unwrap_or(true));
    let mut is_left = joined.iter().map(|joined| !joined);
    components.retain(|_| is_left.next().unwrap_or(true));
}

/// The rim of a hole and the border of an island in it that share a vertex, as one closed walk,
/// which visits that vertex twice.
fn ring(rim: &[u32], island: &[u32]) -> Option<Vec<u32>> {
    let (i, j) = (0..rim.len()).find_map(|i| Some((i, island.iter().position(|&v| v == rim[i])?)))?;
    let turned = |walk: &[u32], from: usize| [&walk[from..], &walk[..from]].concat();
    Some([turned(rim, i), turned(island, j)].concat())
}

/// Whether the loop runs around the line through `point` along `normal`: the even-odd rule in the projection.
fn encloses(vertices: &[u32], positions: &[Point], normal: Point, point: Point) -> bool {
    let least = (0..3).fold(0, |least, k| if normal[k].abs() < normal[least].abs() { k } else { least });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = unit(cross(normal, axis));
    let up = cross(normal, across);
    let flat = |v: u32| {
        let from = sub(positions[v as usize], point);
        [dot(from, across), dot(from, up)]
    };
    let mut inside = false;
    for [a, b] in cycle(vertices) {
        let ([x, y], [u, v]) = (flat(a), flat(b));
        if (y > 0.0) != (v > 0.0) && x + (u - x) * y / (y - v) > 0.0 {
            inside = !inside;
        }
    }
    inside
}
