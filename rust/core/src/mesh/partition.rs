//! Sets that can be united.

use crate::error::SolveError;
use crate::memory;

/// A partition of `0..n` into sets; the root of a set is its least element, unless [`Partition::attach`]
/// chose another (Tarjan 1975, with path halving).
#[derive(Debug, Clone)]
pub(crate) struct Partition(Vec<u32>);

impl Partition {
    /// `n` sets of one element each.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give that much.
    pub(crate) fn new(n: usize) -> Result<Self, SolveError> {
        memory::numbers(n).map(Self)
    }

    /// The least element of the set of `x`.
    pub(crate) fn root(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            let parent = self.0[x as usize];
            self.0[x as usize] = self.0[parent as usize];
            x = self.0[x as usize];
        }
        x
    }

    /// Puts the set with the root `gone` under the root `kept`,
    /// which stays one although it may not be the least element.
    pub(crate) fn attach(&mut self, gone: u32, kept: u32) {
        self.0[gone as usize] = kept;
    }

    /// Makes one set of those of `a` and `b`.
    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// Labels renumbered from 0 in the order of their first elements, and how many there are.
///
/// # Errors
/// [`SolveError::Memory`].
pub(crate) fn contiguous(labels: &[u32]) -> Result<(Vec<u32>, usize), SolveError> {
    let n_names = labels.iter().map(|&label| label as usize + 1).max().unwrap_or(0);
    let mut names = memory::repeated(u32::MAX, n_names)?;
    let mut count = 0;
    let renamed = memory::gathered(labels.iter().map(|&label| {
        let name = &mut names[label as usize];
        if *name == u32::MAX {
            *name = count;
            count += 1;
        }
        *name
    }))?;
    Ok((renamed, count as usize))
}
