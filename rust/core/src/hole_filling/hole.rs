//! A hole, and the patch that fills it.

use crate::error::Refusal;
use crate::mesh::vector::Point;

/// A boundary loop and what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The vertices in the order of [`crate::mesh::boundary_loops`]. Where the ring around an island is
    /// pinched at a vertex, that vertex is there twice.
    pub vertices: Vec<u32>,
    /// Whether this is the outer border of an open sheet, which is filled only if asked for.
    pub is_outer_border: bool,
    /// Why it cannot be filled, if so.
    pub refusal: Option<Refusal>,
}

/// The filling of one hole.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Patch {
    /// Positions of the new vertices; those on the rim are the mesh's.
    pub vertices: Vec<Point>,
    /// Vertex triples, oriented as the mesh around. Numbers below the mesh's vertex count are its vertices;
    /// new ones follow, first those of the patches before this one of the same call.
    pub faces: Vec<[u32; 3]>,
    /// Whether it lies in the mean plane of its rim, but for what closes notches in that.
    pub is_flat: bool,
    /// The normal of that plane, to the side that the patch shows, if the surface meets it steeply all round.
    pub lid_normal: Option<Point>,
}
