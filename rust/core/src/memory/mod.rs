//! How much memory a call needs, how much is free, and arrays that are refused instead of ending the process.
//!
//! A failed allocation of a Rust collection aborts, with everything that the process holds. So nothing large
//! is taken before it is known to fit: [`Demand::admit`] compares a tool's [`Demand::estimate`] with the
//! limit, by default [`SHARE`] of what is really free ([`available`]), and asks the system for as much, to
//! give it back at once; and arrays whose size comes from arguments or meshes are made by [`filled`] and
//! [`copied`], which return an error.

mod cgroup;
mod demand;
mod free;
mod model;
mod threads;

pub use demand::Demand;
pub use free::available;
pub use model::Tool;
pub use threads::processors;
pub(crate) use threads::room_for_threads;

use std::collections::{BinaryHeap, HashMap, HashSet, TryReserveError, VecDeque};
use std::hash::Hash;

use rayon::prelude::*;

use crate::error::SolveError;
use crate::{Error, Result};

/// The part of the free memory that a call takes at most by itself: estimates are within a quarter of the
/// truth, so that one which is too low by that much still fits.
pub const SHARE: f64 = 0.8;

/// Calls that need less are not looked at one by one: the floor that every call asks for ([`floor`]) holds
/// them.
pub const SMALL: usize = 16 << 20;

/// What must be free for any call: several calls that each are [`SMALL`],
/// and what allocators keep for small pieces.
const FLOOR: usize = 64 << 20;

/// What a thread of a pool takes besides its work: its stack, and what the system allocator keeps for it.
const THREAD: usize = 3 << 20;

/// What a call may take when no limit was given: [`SHARE`] of what is free; no bound for what is [`SMALL`].
#[must_use]
pub fn share_of_free(needed: usize) -> usize {
    if needed < SMALL {
        return usize::MAX;
    }
    share_of(available())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn share_of(bytes: usize) -> usize {
    (SHARE * bytes as f64) as usize
}

/// Refuses a call when not even the threads and small arrays of any call fit.
///
/// # Errors
/// [`Error::Memory`].
pub fn floor(what: &'static str) -> Result<()> {
    // Not asked of the pool of threads: asking starts it, and panics where the system gives no thread.
    let threads = processors().min(room_for_threads().unwrap_or(usize::MAX));
    let needed = FLOOR + THREAD * (1 + threads);
    if is_granted(needed) {
        return Ok(());
    }
    Err(Error::Memory { what, needed, limit: available(), is_given: false, fits: 0 })
}

/// `n` times `value`.
///
/// # Errors
/// [`Error::Memory`] when the system does not give that much.
pub fn filled<T: Clone>(what: &'static str, value: T, n: usize) -> Result<Vec<T>> {
    let mut array = reserved(what, n)?;
    array.resize(n, value);
    Ok(array)
}

/// A copy of `values`.
///
/// # Errors
/// [`Error::Memory`] when the system does not give that much.
pub fn copied<T: Clone>(what: &'static str, values: &[T]) -> Result<Vec<T>> {
    let mut array = reserved(what, values.len())?;
    array.extend_from_slice(values);
    Ok(array)
}

/// An empty array with room for `n` entries.
///
/// # Errors
/// [`Error::Memory`] when the system does not give that much.
pub fn reserved<T>(what: &'static str, n: usize) -> Result<Vec<T>> {
    let mut array = Vec::new();
    array.try_reserve_exact(n).map_err(|_| {
        let needed = n.saturating_mul(size_of::<T>());
        Error::Memory { what, needed, limit: available(), is_given: false, fits: 0 }
    })?;
    Ok(array)
}

/// The error where the `n` entries that something holds cannot become `n_further` more.
fn refused<T>(n: usize, n_further: usize) -> impl Fn(TryReserveError) -> SolveError {
    let needed = n.saturating_add(n_further).saturating_mul(size_of::<T>());
    move |_| SolveError::Memory { needed, limit: None }
}

/// An empty array with room for `n` entries of what a linear system takes.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn room<T>(n: usize) -> std::result::Result<Vec<T>, SolveError> {
    let mut array = Vec::new();
    array.try_reserve_exact(n).map_err(refused::<T>(0, n))?;
    Ok(array)
}

/// `n` times `value`, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn repeated<T: Clone>(value: T, n: usize) -> std::result::Result<Vec<T>, SolveError> {
    let mut array = room(n)?;
    array.resize(n, value);
    Ok(array)
}

/// A copy of `values`, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn twin<T: Clone>(values: &[T]) -> std::result::Result<Vec<T>, SolveError> {
    let mut array = room(values.len())?;
    array.extend_from_slice(values);
    Ok(array)
}

/// The values of an iterator that knows how many they are, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn gathered<T>(
    values: impl IntoIterator<Item = T, IntoIter: ExactSizeIterator>,
) -> std::result::Result<Vec<T>, SolveError> {
    let values = values.into_iter();
    let mut array = room(values.len())?;
    array.extend(values);
    Ok(array)
}

/// The values of an iterator that does not know how many they are; the array grows as it must, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn sifted<T>(values: impl IntoIterator<Item = T>) -> std::result::Result<Vec<T>, SolveError> {
    let mut array = Vec::new();
    values.into_iter().try_for_each(|value| push(&mut array, value))?;
    Ok(array)
}

/// The numbers from 0 to `n`, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn numbers(n: usize) -> std::result::Result<Vec<u32>, SolveError> {
    let mut array = room(n)?;
    array.extend(0..n as u32);
    Ok(array)
}

/// The values of a parallel iterator, as [`room`].
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn joined<T: Send>(
    values: impl IndexedParallelIterator<Item = T>,
) -> std::result::Result<Vec<T>, SolveError> {
    let mut array = room(values.len())?;
    values.collect_into_vec(&mut array);
    Ok(array)
}

/// The values of results, or the first error, as [`room`].
///
/// # Errors
/// The first error; [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn all<T>(results: Vec<Result<T>>) -> Result<Vec<T>> {
    let mut values = room(results.len())?;
    for result in results {
        values.push(result?);
    }
    Ok(values)
}

/// Puts a value at the end of an array, which grows by halves at least.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn push<T>(array: &mut Vec<T>, value: T) -> std::result::Result<(), SolveError> {
    extend(array, 1)?;
    array.push(value);
    Ok(())
}

/// Makes an array have room for so many further entries; it grows by halves at least.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn extend<T>(array: &mut Vec<T>, n_further: usize) -> std::result::Result<(), SolveError> {
    array.try_reserve(n_further).map_err(refused::<T>(array.len(), n_further))
}

/// Makes a map have room for so many further entries.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn extend_map<K: Eq + Hash, V>(
    map: &mut HashMap<K, V>,
    n_further: usize,
) -> std::result::Result<(), SolveError> {
    map.try_reserve(n_further).map_err(refused::<(K, V)>(map.len(), n_further))
}

/// The entries of a map that grows as it must.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn mapped<K: Eq + Hash, V>(
    entries: impl IntoIterator<Item = (K, V)>,
) -> std::result::Result<HashMap<K, V>, SolveError> {
    let mut map = HashMap::new();
    for (key, value) in entries {
        extend_map(&mut map, 1)?;
        map.insert(key, value);
    }
    Ok(map)
}

/// Makes a heap have room for so many further entries.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn extend_heap<T: Ord>(
    heap: &mut BinaryHeap<T>,
    n_further: usize,
) -> std::result::Result<(), SolveError> {
    heap.try_reserve(n_further).map_err(refused::<T>(heap.len(), n_further))
}

/// Makes a set have room for so many further entries.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn extend_set<K: Eq + Hash>(
    set: &mut HashSet<K>,
    n_further: usize,
) -> std::result::Result<(), SolveError> {
    set.try_reserve(n_further).map_err(refused::<K>(set.len(), n_further))
}

/// The different values of an iterator, in a set that grows as it must.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn distinct<K: Eq + Hash>(
    values: impl IntoIterator<Item = K>,
) -> std::result::Result<HashSet<K>, SolveError> {
    let mut set = HashSet::new();
    for value in values {
        extend_set(&mut set, 1)?;
        set.insert(value);
    }
    Ok(set)
}

/// Puts a value at the end of a queue, which grows by halves at least.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn push_back<T>(queue: &mut VecDeque<T>, value: T) -> std::result::Result<(), SolveError> {
    queue.try_reserve(1).map_err(refused::<T>(queue.len(), 1))?;
    queue.push_back(value);
    Ok(())
}

/// Makes an array have room for `n` entries, as many as it has included.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn make_room<T>(array: &mut Vec<T>, n: usize) -> std::result::Result<(), SolveError> {
    array.try_reserve_exact(n.saturating_sub(array.len())).map_err(refused::<T>(0, n))
}

/// Makes an array have at least `n` entries, further ones of `value`; it grows by halves at least.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn grow<T: Clone>(array: &mut Vec<T>, n: usize, value: T) -> std::result::Result<(), SolveError> {
    if array.len() < n {
        extend(array, n - array.len())?;
        array.resize(n, value);
    }
    Ok(())
}

/// Makes an array `n` times `value`, in the place that it has where that is enough.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much.
pub(crate) fn refill<T: Clone>(
    array: &mut Vec<T>,
    value: T,
    n: usize,
) -> std::result::Result<(), SolveError> {
    array.clear();
    make_room(array, n)?;
    array.resize(n, value);
    Ok(())
}

/// An estimate, and by how much it may be too low: what must be free for [`SHARE`] of it to be `bytes`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn with_margin(bytes: usize) -> usize {
    (bytes as f64 / SHARE) as usize
}

/// Whether the system gives so many bytes now; they are given back at once.
fn is_granted(bytes: usize) -> bool {
    Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn an_array_that_no_machine_holds_is_an_error_that_says_its_size() {
        let error = filled("values", 0.0, 1 << 60).unwrap_err();
        assert!(error.to_string().starts_with("values: needs about 9223372036.85 GB of memory"), "{error}");
        assert_eq!(filled("values", 7, 3).unwrap(), [7, 7, 7]);
        assert_eq!(copied("values", &[1.0, 2.0]).unwrap(), [1.0, 2.0]);
        floor("anything").unwrap();
    }
}
