//! Triangular solves on several threads: subtrees of the elimination tree know nothing of each other.
//!
//! Every subtree works on its own rows and on a copy of the later rows that it sees, which are added up in
//! the order of the subtrees. They are cut by the pattern alone, so that results are the same on any number
//! of threads.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::error::SolveError;
use crate::linear::multifrontal::Tree;
use crate::linear::real::Real;
use crate::linear::triangular::{Panel, Panels, Values, LANES};
use crate::memory;

/// Subtrees with more than this part of all entries are cut at their root: eight or nine are left, and a
/// quarter of all entries above them. Half of it leaves twice as many, and a third above.
const CUT: f64 = 1.0 / 8.0;

/// Subtrees with fewer entries than this are not worth a thread: they take a tenth of a millisecond.
const LEAST: usize = 1 << 17;

/// Subtrees that are solved for on threads of their own, and what is left for one thread.
#[derive(Debug)]
pub(super) struct Subtrees {
    /// Panels of each subtree.
    list: Vec<Range<usize>>,
    /// All other panels.
    rest: Vec<u32>,
    /// The later rows that each subtree sees.
    behind: Vec<Vec<u32>>,
}

impl Subtrees {
    /// Cuts the tree. The rows of `panels` in subtrees are counted from the first row of their subtree from
    /// then on, with those behind it in the order of its root.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn new(panels: &mut Panels, tree: &Tree) -> Result<Self, SolveError> {
        let count = panels.count();
        let mut entries = memory::repeated(0, count)?;
        for s in 0..count {
            let below: usize = tree.children(s).iter().map(|&c| entries[c as usize]).sum();
            entries[s] = below + panels.values[s + 1] - panels.values[s];
        }
        let total: usize = tree.children(count).iter().map(|&root| entries[root as usize]).sum();
        let (mut list, mut rest) = (Vec::new(), memory::room(count)?);
        let mut heads = memory::twin(tree.children(count))?;
        while let Some(head) = heads.pop() {
            let s = head as usize;
            if entries[s] < LEAST {
                rest.extend(tree.first[s]..=head);
            } else if entries[s] as f64 > CUT * total as f64 {
                rest.push(head);
                heads.extend(tree.children(s));
            } else {
                list.push(tree.first[s] as usize..s + 1);
            }
        }
        list.sort_unstable_by_key(|subtree| subtree.start);
        rest.sort_unstable();
        let twin = |subtree: &Range<usize>| memory::twin(panels.below(subtree.end - 1));
        let behind = list.iter().map(twin).collect::<Result<Vec<_>, _>>()?;
        for (subtree, behind) in list.iter().zip(&behind) {
            renumber(panels, subtree, behind);
        }
        Ok(Self { list, rest, behind })
    }

    /// Solves `L Lᵀ x = right` in place; `values` belong to `L`, rows are in the order of the factor.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn solve<R: Real, const K: usize>(
        &self,
        panels: &Panels,
        values: Values<'_, R>,
        x: &mut [[R; K]],
        space: &mut Vec<R>,
    ) -> Result<(), SolveError> {
        let whole = || self.rest.iter().map(|&s| panels.panel(s as usize, values));
        let mut locals: Vec<Vec<[R; K]>> = self
            .list
            .par_iter()
            .zip(&self.behind)
            .with_max_len(1)
            .map(|(subtree, behind)| {
                let own = &x[rows_of(panels, subtree)];
                let mut local = memory::room(own.len() + behind.len())?;
                local.extend_from_slice(own);
                local.resize(own.len() + behind.len(), [R::ZERO; K]);
                forward(panels_of(panels, values, subtree), &mut local, &mut space_for(panels, subtree, K)?);
                Ok(local)
            })
            .collect::<Result<_, SolveError>>()?;
        for ((subtree, behind), local) in self.list.iter().zip(&self.behind).zip(&locals) {
            let n_own = rows_of(panels, subtree).len();
            for (&row, sum) in behind.iter().zip(&local[n_own..]) {
                x[row as usize].iter_mut().zip(sum).for_each(|(x, &s)| *x += s);
            }
        }
        memory::refill(space, R::ZERO, (panels.longest() + LANES) * K)?;
        forward(whole(), x, space);
        backward(whole().rev(), x, space);
        let each = self.list.par_iter().zip(&self.behind).with_max_len(1).zip(&mut locals);
        each.try_for_each(|((subtree, behind), local)| {
            let n_own = rows_of(panels, subtree).len();
            for (&row, local) in behind.iter().zip(&mut local[n_own..]) {
                *local = x[row as usize];
            }
            let reversed = panels_of(panels, values, subtree).rev();
            backward(reversed, local, &mut space_for(panels, subtree, K)?);
            Ok::<_, SolveError>(())
        })?;
        for (subtree, local) in self.list.iter().zip(&locals) {
            let own = rows_of(panels, subtree);
            x[own.clone()].copy_from_slice(&local[..own.len()]);
        }
        Ok(())
    }
}

/// The panels of a subtree with its own numbers of rows.
fn panels_of<'p, R: Real>(
    panels: &'p Panels,
    values: Values<'p, R>,
    subtree: &Range<usize>,
) -> impl DoubleEndedIterator<Item = Panel<'p, R>> {
    let first = panels.begin[subtree.start];
    subtree.clone().map(move |s| panels.panel(s, values).beginning(panels.begin[s] - first))
}

/// The rows that a subtree eliminates.
fn rows_of(panels: &Panels, subtree: &Range<usize>) -> Range<usize> {
    panels.begin[subtree.start]..panels.begin[subtree.end]
}

/// Working space for the longest panel of a subtree.
fn space_for<R: Real>(
    panels: &Panels,
    subtree: &Range<usize>,
    n_columns: usize,
) -> Result<Vec<R>, SolveError> {
    let longest = subtree.clone().map(|s| panels.n_rows(s)).max().unwrap_or(0);
    memory::repeated(R::ZERO, (longest + LANES) * n_columns)
}

/// Gives the rows below the panels of a subtree the numbers that they have in it.
fn renumber(panels: &mut Panels, subtree: &Range<usize>, behind: &[u32]) {
    let own = rows_of(panels, subtree);
    for s in subtree.clone() {
        let mut at = 0;
        for row in &mut panels.rows[panels.below[s]..panels.below[s + 1]] {
            if (*row as usize) < own.end {
                *row -= own.start as u32;
            } else {
                at += behind[at..].partition_point(|other| other < row);
                *row = (own.len() + at) as u32;
            }
        }
    }
}

/// `x ← L⁻¹x` by these panels.
fn forward<'p, R: Real, const K: usize>(
    panels: impl Iterator<Item = Panel<'p, R>>,
    x: &mut [[R; K]],
    space: &mut [R],
) {
    Arch::new().dispatch(Sweep::<_, R, K, true> { panels, x, space });
}

/// `x ← L⁻ᵀx` by these panels, the last one first.
fn backward<'p, R: Real, const K: usize>(
    panels: impl Iterator<Item = Panel<'p, R>>,
    x: &mut [[R; K]],
    space: &mut [R],
) {
    Arch::new().dispatch(Sweep::<_, R, K, false> { panels, x, space });
}

/// To be compiled for each set of vector instructions.
struct Sweep<'b, I, R, const K: usize, const FORWARD: bool> {
    panels: I,
    x: &'b mut [[R; K]],
    space: &'b mut [R],
}

impl<'p, I: Iterator<Item = Panel<'p, R>>, R: Real, const K: usize, const FORWARD: bool> WithSimd
    for Sweep<'_, I, R, K, FORWARD>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for panel in self.panels {
            if FORWARD {
                panel.forward(simd, self.x, self.space);
            } else {
                panel.backward(simd, self.x, self.space);
            }
        }
    }
}
