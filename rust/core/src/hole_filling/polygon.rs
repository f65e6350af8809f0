//! The rim of a hole as a polygon in space.

use super::rims::Rims;
use crate::error::Refusal;
use crate::mesh::cycle;
use crate::mesh::vector::Point;

/// A closed polygon in the direction of the patch's halfedges: counterclockwise seen from outside.
pub(super) struct Polygon {
    /// The mesh's vertices.
    pub(super) vertices: Vec<u32>,
    /// Their positions.
    pub(super) points: Vec<Point>,
    /// The unit normal of the face beyond the edge that starts at each vertex.
    pub(super) outside: Vec<Point>,
}

impl Polygon {
    /// The polygon of a loop that runs as the halfedges of the faces along it,
    /// with the unit normals of these.
    pub(super) fn around(vertices: &[u32], positions: &[Point], mut outside: Vec<Point>) -> Self {
        let mut vertices = vertices.to_vec();
        vertices.reverse();
        // The edge that starts at a vertex ended there.
        outside.reverse();
        let step = 1.min(outside.len());
        outside.rotate_left(step);
        let points = vertices.iter().map(|&v| positions[v as usize]).collect();
        Self { vertices, points, outside }
    }

    /// The polygon of a boundary loop given in either direction.
    pub(super) fn new(positions: &[Point], rim: &[u32], rims: &Rims) -> Result<Self, Refusal> {
        let mut sorted = rim.to_vec();
        sorted.sort_unstable();
        let mut edges: Vec<[u32; 2]> = cycle(rim).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        if rim.len() < 3 || edges.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(Refusal::NotALoop);
        }
        let mut vertices = rim.to_vec();
        let is_free = |vertices: &[u32]| {
            cycle(vertices).all(|[a, b]| rims.normal(b, a).is_some() && rims.normal(a, b).is_none())
        };
        if !is_free(&vertices) {
            vertices.reverse();
        }
        if !is_free(&vertices) {
            let is_rim =
                cycle(&vertices).all(|[a, b]| rims.normal(a, b).is_some() != rims.normal(b, a).is_some());
            return Err(if is_rim { Refusal::InconsistentOrientation } else { Refusal::NotALoop });
        }
        if rims.has_face(&sorted) {
            return Err(Refusal::SingleFace);
        }
        let points = vertices.iter().map(|&v| positions[v as usize]).collect();
        let outside = cycle(&vertices).map(|[a, b]| rims.normal(b, a).unwrap_or_default()).collect();
        Ok(Self { vertices, points, outside })
    }

    /// The polygon of some of the vertices, by their places in order, with its own normals beyond its edges.
    pub(super) fn part(&self, places: &[usize], outside: Vec<Point>) -> Self {
        Self {
            vertices: places.iter().map(|&i| self.vertices[i]).collect(),
            points: places.iter().map(|&i| self.points[i]).collect(),
            outside,
        }
    }

    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }
}
