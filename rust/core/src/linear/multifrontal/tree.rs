//! The tree of the fronts, and where everything goes in them: found once per pattern.

use super::padded::{len_of, stride_of, update_len};
use crate::buckets::Buckets;
use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::linear::triangular::Panels;
use crate::memory;

/// No panel.
pub(super) const NONE: u32 = u32::MAX;

/// Multiplications from which on a factorization is shared between threads: below it takes 15 ms.
const SHARED: f64 = 2e8;

/// Subtrees with more than this part of all multiplications are split at their root: what is left is many
/// enough for many threads, and large enough for buffers of its own.
const SPLIT: f64 = 1.0 / 48.0;

/// No subtree is split deeper than this below the root: trees of long thin meshes would be chains of calls.
const DEEPEST: u32 = 100;

/// Who updates whom. Panels are the columns that a front eliminates, and come in postorder.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tree {
    /// The children of every panel; those of no parent come last.
    children: Buckets<u32>,
    /// The first panel of each subtree.
    pub first: Vec<u32>,
    /// Whether the subtree is split between threads at its root.
    pub is_split: Vec<bool>,
    /// Which of two stacks holds what is left of a front: never that of its parent.
    pub stack: Vec<u8>,
    /// For each row below a panel (as in [`Panels::rows`]) its place in the front of the parent.
    pub relative: Vec<u32>,
    /// Panel `s` takes the matrix entries `starts[s]..starts[s + 1]` of `source` to the places `target` of
    /// its front.
    pub starts: Vec<usize>,
    /// Numbers of entries of the matrix.
    pub source: Vec<u32>,
    /// Where they go in the padded panel.
    pub target: Vec<u32>,
}

impl Tree {
    /// The tree of the fronts of `panels`. Row `order[i]` of the matrix is row `i` of the factor.
    ///
    /// # Errors
    /// [`SolveError::Factorization`] when the panels are in no postorder, [`SolveError::Memory`].
    pub(crate) fn new(pattern: &LowerPattern, order: &[u32], panels: &Panels) -> Result<Self, SolveError> {
        let count = panels.count();
        let mut panel_of = memory::repeated(0u32, pattern.n)?;
        for s in 0..count {
            panel_of[panels.begin[s]..panels.begin[s + 1]].fill(s as u32);
        }
        let parent = |s: usize| panels.below(s).first().map_or(NONE, |&row| panel_of[row as usize]);
        let parents: Vec<u32> = memory::gathered((0..count).map(parent))?;
        let mut tree = Self::default();
        tree.find_children(&parents)?;
        let mut size = memory::repeated(1u32, count)?;
        for (s, &parent) in parents.iter().enumerate() {
            if parent != NONE {
                size[parent as usize] += size[s];
            }
        }
        tree.first = memory::gathered((0..count).zip(&size).map(|(s, size)| s as u32 + 1 - size))?;
        let is_postorder = (0..count).all(|s| {
            let mut next = tree.first[s];
            tree.children(s).iter().all(|&c| std::mem::replace(&mut next, c + 1) == tree.first[c as usize])
                && next == s as u32
        });
        if !is_postorder {
            return Err(SolveError::Factorization {
                reason: "the ordering of the matrix is no postorder".into(),
            });
        }
        tree.split(panels, &parents)?;
        tree.find_relative(panels, &parents)?;
        tree.find_targets(pattern, order, panels, &panel_of)?;
        Ok(tree)
    }

    /// The children of a panel in rising order; those of the number of panels are the roots.
    #[must_use]
    pub(crate) fn children(&self, s: usize) -> &[u32] {
        self.children.of(s)
    }

    fn find_children(&mut self, parents: &[u32]) -> Result<(), SolveError> {
        let count = parents.len();
        let of = |parent: u32| if parent == NONE { count } else { parent as usize };
        self.children = Buckets::new(count + 1, |visit| {
            (0..).zip(parents).for_each(|(s, &parent)| visit(of(parent), s));
        })?;
        Ok(())
    }

    /// Finds where subtrees are split, and on which stack every front leaves what is left.
    fn split(&mut self, panels: &Panels, parents: &[u32]) -> Result<(), SolveError> {
        let count = parents.len();
        let mut work: Vec<f64> = memory::gathered((0..count).map(|s| panels.multiplications(s)))?;
        let mut total = 0.0;
        for s in 0..count {
            match parents[s] {
                NONE => total += work[s],
                parent => work[parent as usize] += work[s],
            }
        }
        let mut depth = memory::repeated(0, count)?;
        self.is_split = memory::repeated(false, count)?;
        self.stack = memory::repeated(0, count)?;
        for s in (0..count).rev() {
            let parent = parents[s] as usize;
            if parents[s] != NONE {
                depth[s] = depth[parent] + 1;
                self.stack[s] = 1 - self.stack[parent];
            }
            let parent_is_split = parents[s] == NONE || self.is_split[parent];
            self.is_split[s] =
                total > SHARED && work[s] > SPLIT * total && parent_is_split && depth[s] < DEEPEST;
        }
        Ok(())
    }

    /// The most numbers that wait for their parents at once when the panels follow each other,
    /// with the panel at work.
    #[must_use]
    pub(crate) fn most_waiting(&self, panels: &Panels) -> usize {
        let (mut waiting, mut most) = (0, 0);
        for s in 0..panels.count() {
            let (k, below) = (panels.begin[s + 1] - panels.begin[s], panels.below(s).len());
            waiting += update_len(below);
            most = most.max(waiting + len_of(k + below, k));
            waiting -=
                self.children(s).iter().map(|&c| update_len(panels.below(c as usize).len())).sum::<usize>();
        }
        most
    }

    fn find_relative(&mut self, panels: &Panels, parents: &[u32]) -> Result<(), SolveError> {
        self.relative = memory::room(panels.rows.len())?;
        for (s, &parent) in parents.iter().enumerate() {
            if parent == NONE {
                continue;
            }
            let parent = parent as usize;
            let (begin, end) = (panels.begin[parent], panels.begin[parent + 1]);
            let rows = panels.below(parent);
            let mut at = 0;
            for &row in panels.below(s) {
                if (row as usize) < end {
                    self.relative.push(row - begin as u32);
                } else {
                    while at < rows.len() && rows[at] < row {
                        at += 1;
                    }
                    self.relative.push((end - begin + at) as u32);
                }
            }
        }
        Ok(())
    }

    fn find_targets(
        &mut self,
        pattern: &LowerPattern,
        order: &[u32],
        panels: &Panels,
        panel_of: &[u32],
    ) -> Result<(), SolveError> {
        let mut place: Vec<u32> = memory::room(pattern.n)?;
        place.extend(0..pattern.n as u32);
        for (k, &i) in order.iter().enumerate() {
            place[i as usize] = k as u32;
        }
        let count = panels.count();
        let in_panels = Buckets::new(count, |visit| {
            for j in 0..pattern.n {
                for e in pattern.starts[j]..pattern.starts[j + 1] {
                    let (a, b) = (place[pattern.rows[e]], place[j]);
                    let (row, column) = (a.max(b), a.min(b));
                    visit(panel_of[column as usize] as usize, [e as u32, row, column]);
                }
            }
        })?;
        let at;
        (self.starts, at) = in_panels.into_parts();
        let mut local = memory::repeated(0u32, pattern.n)?;
        (self.source, self.target) = (memory::room(at.len())?, memory::room(at.len())?);
        for s in 0..count {
            let (begin, end) = (panels.begin[s], panels.begin[s + 1]);
            let below = panels.below(s);
            for (i, row) in (begin..end).chain(below.iter().map(|&row| row as usize)).enumerate() {
                local[row] = i as u32;
            }
            let stride = stride_of(end - begin + below.len());
            for [e, row, column] in &at[self.starts[s]..self.starts[s + 1]] {
                self.source.push(*e);
                self.target.push(((*column as usize - begin) * stride) as u32 + local[*row as usize]);
            }
        }
        Ok(())
    }
}
