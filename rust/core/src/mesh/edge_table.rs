//! The halfedges of every edge, found by the edge's vertices.

use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

/// The halfedges of every edge, however many faces it has;
/// edges of faces that name a vertex twice are left out.
#[derive(Debug, Clone)]
pub struct EdgeTable {
    /// Smaller vertex, larger vertex, halfedge; sorted.
    entries: Vec<[u32; 3]>,
}

impl EdgeTable {
    /// The table of `connectivity`.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn new(connectivity: &Connectivity) -> Result<Self> {
        let sound = (0..connectivity.n_halfedges()).filter(|&h| connectivity.kind(h) != EdgeKind::Degenerate);
        let mut entries = memory::room(connectivity.n_halfedges())?;
        entries.extend(sound.map(|h| {
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            [tail.min(head), tail.max(head), h as u32]
        }));
        entries.sort_unstable();
        Ok(Self { entries })
    }

    /// The halfedges of every edge, ascending, edges in the order of their vertices.
    pub fn edges(&self) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone + '_> + '_ {
        let same = |a: &[u32; 3], b: &[u32; 3]| a[..2] == b[..2];
        self.entries.chunk_by(same).map(|edge| edge.iter().map(|entry| entry[2] as usize))
    }

    /// The halfedges between the vertices `a` and `b`, ascending; none if no edge joins them.
    pub fn between(&self, a: u32, b: u32) -> impl Iterator<Item = usize> + Clone + '_ {
        let key = [a.min(b), a.max(b)];
        let first = self.entries.partition_point(|entry| entry[..2] < key[..]);
        self.entries[first..].iter().take_while(move |entry| entry[..2] == key).map(|entry| entry[2] as usize)
    }
}
