//! What threads take before a limit on address space can be read:
//! it would be missing in the middle of a call.
//!
//! The matrix product of faer keeps a buffer in every thread that has used it, twice as large as the largest
//! cache: half a gigabyte a thread on a server. It is never full, but counts in full under `RLIMIT_AS`. So
//! does what the system allocator reserves for the small pieces of every thread. So under such a limit there
//! are only as many threads as have room; they take all this first; and then the limit is read.

use std::cell::Cell;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::{available, is_granted};
use crate::{Error, Result};

thread_local! {
    static IS_SETTLED: Cell<bool> = const { Cell::new(false) };
}

/// The size of the largest cache where the system does not tell.
const CACHE: usize = 64 << 20;

/// What glibc reserves at a time for the small pieces of a thread.
const HEAP: usize = 64 << 20;

/// Rows of the product that makes faer take its buffer.
const ROWS: usize = 64;

/// The threads that run at once on this machine, as far as this process may use it.
#[must_use]
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// How many threads a call may have where address space is limited, at least one: what they keep is half of
/// what is left at most. `None` without a limit.
pub(crate) fn room_for_threads() -> Option<usize> {
    let left = usize::try_from(super::free::resources()?).unwrap_or(usize::MAX);
    Some((left / 2 / (super::THREAD + HEAP + buffer())).max(1))
}

/// Has all threads of this pool and the caller take what they keep, while it can still be refused; the
/// buffers of products only where `multiplies`. Does nothing where address space is not limited. Returns what
/// the system allocator may still reserve beyond what is asked of it: a heap that is begun when another is
/// full.
///
/// # Errors
/// [`Error::Memory`].
pub(super) fn settle(what: &'static str, multiplies: bool) -> Result<usize> {
    if super::free::resources().is_none() {
        return Ok(0);
    }
    // An allocation of its own makes the heap of a thread.
    rayon::broadcast(|_| drop(std::hint::black_box(Box::new(0_u64))));
    if multiplies {
        let is_outside = rayon::current_thread_index().is_none();
        let own = usize::from(is_outside && !IS_SETTLED.get());
        let cold = own + rayon::broadcast(|_| usize::from(!IS_SETTLED.get())).into_iter().sum::<usize>();
        let needed = cold * buffer() + super::SMALL;
        if cold > 0 && !is_granted(needed) {
            return Err(Error::Memory { what, needed, limit: available(), is_given: false, fits: 0 });
        }
        rayon::broadcast(|_| take());
        if is_outside {
            take();
        }
    }
    // It maps two heaps at a time, to have one that is aligned.
    Ok(2 * HEAP)
}

fn take() {
    if IS_SETTLED.get() {
        return;
    }
    let ones = Mat::<f64>::full(ROWS, ROWS, 1.0);
    let mut product = Mat::<f64>::zeros(ROWS, ROWS);
    matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
    IS_SETTLED.set(std::hint::black_box(product[(0, 0)]) > 0.0);
}

/// What the matrix product keeps in a thread.
fn buffer() -> usize {
    2 * largest_cache()
}

/// Bytes of the third cache of the first processor.
fn largest_cache() -> usize {
    let text = std::fs::read_to_string("/sys/devices/system/cpu/cpu0/cache/index3/size").unwrap_or_default();
    let text = text.trim();
    let unit = match text.chars().last() {
        Some('K') => 1 << 10,
        Some('M') => 1 << 20,
        Some('G') => 1 << 30,
        _ => 1,
    };
    text.trim_end_matches(['K', 'M', 'G']).parse::<usize>().map_or(CACHE, |size| size.saturating_mul(unit))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn threads_settle() {
        assert_eq!(settle("anything", true).unwrap() > 0, room_for_threads().is_some());
        take();
        assert!(IS_SETTLED.get());
        assert!((1 << 20..1_usize << 34).contains(&largest_cache()));
    }
}
