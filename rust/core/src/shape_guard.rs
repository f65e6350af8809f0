//! What keeps triangles in shape wherever vertices move, edges flip or edges collapse: how thin a face may
//! become, how far it may turn, how sharply it may fold, and how far a move is taken back that would break
//! one of these.

use crate::mesh::vector::{area_vector, between, dot, norm, Point};

/// The least cosine between a face's normal and what it was before an edit, or what its surface asks for: 60
/// degrees. A fold turns it by more than 90; a chamfer that becomes part of a ridge turns by half the ridge's
/// angle, at most 45.
pub const TURNED: f64 = 0.5;

/// Faces of less quality ([`crate::mesh::vector::quality`]) than this count as slivers: a triangle whose
/// height is 0.09 of its longest edge.
pub const SLIVER: f64 = 0.2;

/// Faces whose normals make an angle of more than this cosine (154 degrees) fold the surface. Ridges of 140
/// to 152 degrees are real: with a limit of 137 degrees, holes across them came back smooth.
pub const FOLDED: f64 = -0.9;

/// Whether a face of quality `new` is a sliver where one of quality `old` was none, or a thinner one.
#[must_use]
pub fn is_thinned(new: f64, old: f64) -> bool {
    new < SLIVER.min(old)
}

/// Whether a face with these corners has turned away from a normal of any length.
#[must_use]
pub fn is_turned(corners: [Point; 3], normal: Point) -> bool {
    let area = area_vector(corners);
    dot(area, normal) < TURNED * norm(area) * norm(normal)
}

/// A move and what is tried where all of it would break a limit: its half, then its quarter.
const PARTS_OF_A_MOVE: [f64; 3] = [1.0, 0.5, 0.25];

/// The part of a move that is tried after `part`; 0 after the last.
#[must_use]
pub fn shorter(part: f64) -> f64 {
    PARTS_OF_A_MOVE.into_iter().find(|&next| next < part).unwrap_or(0.0)
}

/// The farthest of the points that are tried on the way from `start` to `goal` that `allows`.
pub fn farthest(start: Point, goal: Point, mut allows: impl FnMut(Point) -> bool) -> Option<Point> {
    PARTS_OF_A_MOVE.into_iter().map(|part| between(start, goal, part)).find(|&point| allows(point))
}
