//! What an edge of an editable mesh is.

/// The two faces of an interior edge `a b`, and the vertices opposite it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wings {
    /// The face in which `b` follows `a`, and the other one.
    pub faces: [u32; 2],
    /// The third vertices of those faces.
    pub tips: [u32; 2],
}

/// What lies at a pair of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// No face has both.
    None,
    /// One face: its number and its third vertex.
    Border(u32, u32),
    /// Two faces that run through the edge in opposite directions.
    Interior(Wings),
    /// Three or more faces, or two that disagree on their orientation.
    NonManifold,
}

/// The edge's two vertices, smaller first.
#[must_use]
pub fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
