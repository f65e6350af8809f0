//! Memory of the factorization, kept from one to the next: a solver factors the same pattern several times,
//! and fresh pages take a tenth of the time.

use std::sync::{Mutex, PoisonError};

use super::padded::Padded;
use crate::error::SolveError;
use crate::linear::real::Real;
use crate::memory;

/// What one thread needs for the fronts of a subtree.
#[derive(Debug, Default)]
pub(crate) struct Work<R> {
    /// What is left of fronts until their parents take it:
    /// a front writes to one stack and reads from the other.
    pub stacks: [Stack<R>; 2],
    /// The columns that are eliminated.
    pub panel: Padded<R>,
}

impl<R: Real> Work<R> {
    /// Drops what is left on the stacks.
    pub(crate) fn clear(&mut self) {
        self.stacks.iter_mut().for_each(|stack| stack.top = 0);
    }
}

/// A stack of numbers.
#[derive(Debug, Default)]
pub(crate) struct Stack<R> {
    values: Vec<R>,
    top: usize,
}

impl<R: Real> Stack<R> {
    /// `len` more numbers, of any value.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(crate) fn push(&mut self, len: usize) -> Result<&mut [R], SolveError> {
        let begin = self.top;
        memory::grow(&mut self.values, begin + len, R::ZERO)?;
        self.top += len;
        Ok(&mut self.values[begin..self.top])
    }

    /// The last `len` numbers.
    pub(crate) fn last(&self, len: usize) -> &[R] {
        &self.values[self.top - len..self.top]
    }

    /// Takes the last `len` numbers off.
    pub(crate) fn pop(&mut self, len: usize) {
        self.top -= len;
    }
}

/// Buffers that are free at the moment.
#[derive(Debug, Default)]
pub(crate) struct Workspace<R> {
    works: Mutex<Vec<Work<R>>>,
    spare: Mutex<Vec<Vec<R>>>,
}

impl<R: Real> Workspace<R> {
    /// What one thread needs.
    pub(crate) fn work(&self) -> Work<R> {
        self.works.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default()
    }

    /// Gives it back.
    pub(crate) fn back(&self, work: Work<R>) {
        self.works.lock().unwrap_or_else(PoisonError::into_inner).push(work);
    }

    /// Makes `buffer` hold `len` numbers of any value: the smallest free buffer that does,
    /// or a new one for the largest.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(crate) fn take(&self, len: usize, buffer: &mut Vec<R>) -> Result<(), SolveError> {
        if len == 0 {
            // Roots leave nothing, and a mesh can have as many as vertices.
            buffer.clear();
            return Ok(());
        }
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        let fits = |x: &Vec<R>| (x.len() < len, x.len().abs_diff(len));
        let best = (0..spare.len()).min_by_key(|&i| fits(&spare[i]));
        *buffer = best.map(|i| spare.swap_remove(i)).unwrap_or_default();
        drop(spare);
        if buffer.len() < len {
            *buffer = Vec::new();
            *buffer = memory::repeated(R::ZERO, len)?;
        }
        Ok(())
    }

    /// Gives a buffer back.
    pub(crate) fn give(&self, buffer: Vec<R>) {
        if buffer.is_empty() {
            return;
        }
        self.spare.lock().unwrap_or_else(PoisonError::into_inner).push(buffer);
    }
}
