//! Things in numbered buckets, by counting sort.

use crate::error::SolveError;
use crate::memory;

/// Items in buckets `0..n`, each in the order in which it came.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Buckets<T> {
    /// Bucket `i` holds the items `starts[i]..starts[i + 1]`.
    starts: Vec<usize>,
    items: Vec<T>,
}

impl<T> Default for Buckets<T> {
    fn default() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }
}

impl<T: Copy + Default> Buckets<T> {
    /// Sorts what `each` visits into `n` buckets: it names a bucket and an item at a time,
    /// and is called twice.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give that much.
    pub(crate) fn new(n: usize, each: impl Fn(&mut dyn FnMut(usize, T))) -> Result<Self, SolveError> {
        let starts = counted(memory::repeated(0, n + 1)?, &each);
        let (next, items) = (memory::twin(&starts)?, memory::repeated(T::default(), starts[n])?);
        Ok(Self::placed(starts, next, items, &each))
    }

    fn placed(
        starts: Vec<usize>,
        mut next: Vec<usize>,
        mut items: Vec<T>,
        each: &impl Fn(&mut dyn FnMut(usize, T)),
    ) -> Self {
        each(&mut |bucket, item| {
            items[next[bucket]] = item;
            next[bucket] += 1;
        });
        Self { starts, items }
    }

    /// The items of bucket `i`.
    pub(crate) fn of(&self, i: usize) -> &[T] {
        &self.items[self.starts[i]..self.starts[i + 1]]
    }

    /// The same, to be sorted further.
    pub(crate) fn of_mut(&mut self, i: usize) -> &mut [T] {
        &mut self.items[self.starts[i]..self.starts[i + 1]]
    }

    /// Where the buckets begin, with the number of items at the end, and the items of all.
    pub(crate) fn into_parts(self) -> (Vec<usize>, Vec<T>) {
        (self.starts, self.items)
    }
}

/// Where the buckets begin, with the number of items at the end; `starts` are zeros.
fn counted<T>(mut starts: Vec<usize>, each: &impl Fn(&mut dyn FnMut(usize, T))) -> Vec<usize> {
    each(&mut |bucket, _| starts[bucket + 1] += 1);
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    starts
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn items_keep_their_order_and_empty_buckets_are_empty() {
        let given = [(2, 'a'), (0, 'b'), (2, 'c'), (0, 'd')];
        let visit = |visit: &mut dyn FnMut(usize, char)| given.iter().for_each(|&(i, item)| visit(i, item));
        let buckets = Buckets::new(4, visit).unwrap();
        let all: Vec<&[char]> = (0..4).map(|i| buckets.of(i)).collect();
        assert_eq!(all, [&['b', 'd'][..], &[], &['a', 'c'], &[]]);
        assert_eq!(buckets.into_parts(), (vec![0, 2, 2, 4, 4], vec!['b', 'd', 'a', 'c']));
    }
}
