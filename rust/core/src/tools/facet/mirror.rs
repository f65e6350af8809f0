//! The plane of a mirror.

use crate::mesh::vector::Point;

/// A plane across an axis of coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mirror {
    pub axis: usize,
    pub at: f64,
}

impl Mirror {
    /// Where a point is seen in it.
    pub(super) fn image(self, mut p: Point) -> Point {
        p[self.axis] = 2.0 * self.at - p[self.axis];
        p
    }
}
