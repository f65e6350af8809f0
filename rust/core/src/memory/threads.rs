//! What threads take before a limit on address space can be read: it would be missing in the middle of a call.
//!
//! The matrix product of faer keeps a buffer in every thread that has used it, twice as large as the largest cache: half a
//! gigabyte a thread on a server. It is never full, but counts in full under `RLIMIT_AS`. The system allocator reserves 64 MB or
//! 128 MB a thread as well.

use std::cell::Cell;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::{available, is_granted, SMALL};
use crate::{Error, Result};

thread_local! {
    static IS_SETTLED: Cell<bool> = const { Cell::new(false) };
}

/// The size of the largest cache where the system does not tell.
const CACHE: usize = 64 << 20;

/// Rows of the product that makes faer take its buffer.
const ROWS: usize = 64;

/// Has all threads of this pool and the caller take what they keep, while it can still be refused. Does nothing where address
/// space is not limited.
///
/// # Errors
/// [`Error::Memory`].
pub(super) fn settle(what: &'static str) -> Result<()> {
    if super::free::resources().is_none() {
        return Ok(());
    }
    let unsettled = rayon::broadcast(|_| usize::from(!IS_SETTLED.get())).into_iter().sum::<usize>();
    let cold = unsettled + usize::from(!IS_SETTLED.get());
    let needed = cold * 2 * largest_cache() + SMALL;
    if cold > 0 && !is_granted(needed) {
        return Err(Error::Memory { what, needed, limit: available(), is_given: false, fits: 0 });
    }
    if cold > 0 {
        rayon::broadcast(|_| take());
        take();
    }
    Ok(())
}

fn take() {
    let ones = Mat::<f64>::full(ROWS, ROWS, 1.0);
    let mut product = Mat::<f64>::zeros(ROWS, ROWS);
    matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
    IS_SETTLED.set(std::hint::black_box(product[(0, 0)]) > 0.0);
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
        settle("anything").unwrap();
        take();
        assert!(IS_SETTLED.get());
        assert!((1 << 20..1_usize << 34).contains(&largest_cache()));
    }
}
