//! The numbers of a factor in one precision, and room for what makes and uses them.

use crate::error::SolveError;
use crate::linear::multifrontal::{self, Tree, Workspace};
use crate::linear::real::Real;
use crate::linear::subtrees::Subtrees;
use crate::linear::triangular::{Panels, Values, LANES};
use crate::{memory, Progress, Result};

/// `L` of a matrix whose pattern is known.
#[derive(Debug)]
pub(super) struct Factor<R> {
    panels: Vec<R>,
    reciprocals: Vec<R>,
    workspace: Workspace<R>,
    /// The right sides in the order of the factor, and room for a panel of them.
    rows: Vec<R>,
    space: Vec<R>,
}

impl<R: Real> Factor<R> {
    /// Room for a factor of `len` entries and `n` rows.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn new(len: usize, n: usize) -> std::result::Result<Self, SolveError> {
        Ok(Self {
            panels: memory::repeated(R::ZERO, len + LANES)?,
            reciprocals: memory::room(n)?,
            workspace: Workspace::default(),
            rows: Vec::new(),
            space: Vec::new(),
        })
    }

    /// Factors the matrix with these values.
    ///
    /// # Errors
    /// [`SolveError::Factorization`] when it is not positive definite in this precision,
    /// [`crate::Error::Cancelled`].
    pub(super) fn factorize(
        &mut self,
        tree: &Tree,
        panels: &Panels,
        values: &[f64],
        progress: &Progress,
    ) -> Result<()> {
        multifrontal::factorize(tree, panels, values, &mut self.panels, &self.workspace, progress)?;
        panels.reciprocals(&self.panels, &mut self.reciprocals);
        Ok(())
    }

    /// Solves for the first `A` of `K` right sides in place; `order` has the row of the matrix that each row
    /// of the factor stands for.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn solve<const A: usize, const K: usize>(
        &mut self,
        panels: &Panels,
        subtrees: &Subtrees,
        order: &[u32],
        right: &mut [[f64; K]],
    ) -> std::result::Result<(), SolveError> {
        memory::refill(&mut self.rows, R::ZERO, A * order.len())?;
        let (x, _) = self.rows.as_chunks_mut::<A>();
        for (x, &i) in x.iter_mut().zip(order) {
            if let Some(right) = right.get(i as usize) {
                *x = std::array::from_fn(|c| R::of(right[c]));
            }
        }
        let values = Values { panels: &self.panels, reciprocals: &self.reciprocals };
        subtrees.solve(panels, values, x, &mut self.space)?;
        for (x, &i) in x.iter().zip(order) {
            if let Some(right) = right.get_mut(i as usize) {
                right.iter_mut().zip(x).for_each(|(right, x)| *right = x.double());
            }
        }
        Ok(())
    }
}
