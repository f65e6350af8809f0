//! Numeric Cholesky factorization front by front (multifrontal; Duff and Reid 1983),
//! subtrees on several threads.
//!
//! A front is a dense matrix: the columns of one panel and what their elimination takes off later rows.
//! Children leave the latter to their parent. Subtrees know nothing of each other until their common parent,
//! so they go to different threads, and large fronts share their products. How the work is cut depends on the
//! pattern alone, so results are the same on any number of threads.

mod assembly;
mod buffers;
mod dense;
mod padded;
mod tree;

use buffers::Work;
pub(super) use buffers::Workspace;
use dense::Front;
use rayon::prelude::*;
pub(super) use tree::Tree;

use crate::error::SolveError;
use crate::linear::real::Real;
use crate::linear::triangular::Panels;
use crate::{Progress, Result};

/// Multiplications of small fronts between two looks at whether to go on: some milliseconds.
const LOOK_EVERY: f64 = 1e7;

/// Factors the matrix with these values (one per entry of the pattern) into `factor`, panel by panel as in
/// `panels`.
///
/// # Errors
/// [`SolveError::Factorization`] when it is not positive definite, [`SolveError::Memory`],
/// [`crate::Error::Cancelled`].
pub(super) fn factorize<R: Real>(
    tree: &Tree,
    panels: &Panels,
    values: &[f64],
    factor: &mut [R],
    workspace: &Workspace<R>,
    progress: &Progress,
) -> Result<()> {
    let numeric = Numeric { tree, panels, values, workspace, progress };
    numeric
        .subtrees(tree.children(panels.count()), 0, factor)
        .map(|left| left.into_iter().for_each(|x| workspace.give(x)))
}

/// A pivot is not positive.
fn not_definite() -> SolveError {
    let reason = "the matrix is not positive definite; fix more vertices or raise the fidelity".into();
    SolveError::Factorization { reason }
}

struct Numeric<'n, R> {
    tree: &'n Tree,
    panels: &'n Panels,
    values: &'n [f64],
    workspace: &'n Workspace<R>,
    progress: &'n Progress,
}

impl<R: Real> Numeric<'_, R> {
    /// Factors subtrees that follow each other, and returns what is left of each;
    /// `factor` starts with panel `begin`.
    fn subtrees(&self, roots: &[u32], begin: usize, factor: &mut [R]) -> Result<Vec<Vec<R>>> {
        let mut rest = factor;
        let mut at = self.panels.values[begin];
        let mut segments = Vec::with_capacity(roots.len());
        for &root in roots {
            let end = self.panels.values[root as usize + 1];
            let (segment, behind) = rest.split_at_mut(end - at);
            segments.push(segment);
            (rest, at) = (behind, end);
        }
        let each = roots.par_iter().zip(segments).with_max_len(1);
        each.map(|(&root, segment)| self.subtree(root as usize, segment)).collect()
    }

    /// Factors a subtree into `factor`, which starts with its first panel,
    /// and returns what is left for the parent of its root.
    fn subtree(&self, root: usize, factor: &mut [R]) -> Result<Vec<R>> {
        self.progress.check()?;
        let first = self.tree.first[root] as usize;
        let base = self.panels.values[first];
        let mut update = Vec::new();
        if self.tree.is_split[root] {
            let (below, own) = factor.split_at_mut(self.panels.values[root] - base);
            let left = self.subtrees(self.tree.children(root), first, below)?;
            self.workspace.take(padded::update_len(self.panels.below(root).len()), &mut update)?;
            let mut work = self.workspace.work();
            let children: Vec<&[R]> = left.iter().map(Vec::as_slice).collect();
            let done = self.front(root, own, &children, &mut update, &mut work.panel);
            self.workspace.back(work);
            left.into_iter().for_each(|x| self.workspace.give(x));
            return done.map(|()| update);
        }
        let mut work = self.workspace.work();
        let mut since_look = 0.0;
        let done = (first..root)
            .try_for_each(|s| {
                since_look += self.panels.multiplications(s);
                if since_look > LOOK_EVERY {
                    since_look = 0.0;
                    self.progress.check()?;
                }
                let out = self.panels.values[s] - base..self.panels.values[s + 1] - base;
                self.stacked(s, &mut factor[out], &mut work, None)
            })
            .and_then(|()| {
                self.workspace.take(padded::update_len(self.panels.below(root).len()), &mut update)?;
                let own = &mut factor[self.panels.values[root] - base..];
                self.stacked(root, own, &mut work, Some(&mut update))
            });
        work.clear();
        self.workspace.back(work);
        done.map(|()| update)
    }

    /// One front of a subtree that runs on one thread: takes what is left of its children from one stack, and
    /// leaves its own on the other, or in `update`.
    fn stacked(&self, s: usize, out: &mut [R], work: &mut Work<R>, update: Option<&mut [R]>) -> Result<()> {
        let children = self.tree.children(s);
        let [even, odd] = &mut work.stacks;
        let (own, other) = if self.tree.stack[s] == 0 { (even, odd) } else { (odd, even) };
        let lengths = |c: &u32| padded::update_len(self.panels.below(*c as usize).len());
        let mut waiting = other.last(children.iter().map(lengths).sum());
        let mut left = Vec::with_capacity(children.len());
        for child in children {
            let (first, rest) = waiting.split_at(lengths(child));
            left.push(first);
            waiting = rest;
        }
        let update = match update {
            Some(update) => update,
            None => own.push(padded::update_len(self.panels.below(s).len()))?,
        };
        let done = self.front(s, out, &left, update, &mut work.panel);
        other.pop(children.iter().map(lengths).sum());
        done
    }

    /// Assembles and eliminates one front, writes its columns into `out`, and what is left into `update`.
    fn front(
        &self,
        s: usize,
        out: &mut [R],
        left: &[&[R]],
        update: &mut [R],
        panel: &mut padded::Padded<R>,
    ) -> Result<()> {
        let n_columns = self.panels.begin[s + 1] - self.panels.begin[s];
        let n_below = self.panels.below(s).len();
        let n_rows = n_columns + n_below;
        panel.clear(n_rows, n_columns)?;
        let entries = self.tree.starts[s]..self.tree.starts[s + 1];
        for (&source, &target) in self.tree.source[entries.clone()].iter().zip(&self.tree.target[entries]) {
            panel.values[target as usize] += R::of(self.values[source as usize]);
        }
        let relative = |child: u32| {
            let child = child as usize;
            &self.tree.relative[self.panels.below[child]..self.panels.below[child + 1]]
        };
        for (&child, from) in self.tree.children(s).iter().zip(left) {
            assembly::add_to_panel(relative(child), from, n_columns, panel);
        }
        if !(Front { panel, update, n_rows, n_columns }.eliminate(self.progress)?) {
            return Err(not_definite().into());
        }
        for (out, column) in out.chunks_exact_mut(n_rows).zip(panel.values.chunks_exact(panel.stride)) {
            out.copy_from_slice(&column[..n_rows]);
        }
        let stride = padded::stride_of(n_below);
        for (&child, from) in self.tree.children(s).iter().zip(left) {
            assembly::add_to_update(relative(child), from, n_columns, update, stride);
        }
        Ok(())
    }
}
