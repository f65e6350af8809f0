//! Faces that a search has seen, and how deep they lie.

use crate::{memory, Result};

/// A set of faces that is emptied at once.
pub(super) struct Marks {
    seen: Vec<u32>,
    depth: Vec<u32>,
    now: u32,
}

impl Marks {
    /// None of `n`.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(n: usize) -> Result<Self> {
        Ok(Self { seen: memory::repeated(0, n)?, depth: memory::repeated(0, n)?, now: 0 })
    }

    /// None again.
    pub(super) fn begin(&mut self) {
        self.now += 1;
    }

    /// Marks `f`, and says whether it was not.
    pub(super) fn mark(&mut self, f: u32) -> bool {
        self.mark_at(f, u32::MAX)
    }

    /// The same, at a depth.
    pub(super) fn mark_at(&mut self, f: u32, depth: u32) -> bool {
        let fresh = !self.is_marked(f);
        self.seen[f as usize] = self.now;
        self.depth[f as usize] = depth;
        fresh
    }

    /// Whether `f` is marked.
    pub(super) fn is_marked(&self, f: u32) -> bool {
        self.seen[f as usize] == self.now
    }

    /// The depth of `f`, which is marked.
    pub(super) fn depth(&self, f: u32) -> u32 {
        self.depth[f as usize]
    }
}
