//! Which threads work: those of the process, of a pool of its own after a fork, or as many as were asked for.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::error::ThreadsError;
pub use crate::memory::processors as available;
use crate::{memory, Error, Result};

/// The process whose global pool is used, 0 before the first call.
static HOME: AtomicU32 = AtomicU32::new(0);

/// Runs `work` where its parallel parts find threads that are alive.
///
/// A fork copies the memory of a process, but only the thread that forks: the global pool of rayon is there
/// in the child, and nobody in it, so that whoever asks it waits forever. In a process other than the one
/// that came first, each call therefore has a pool of its own, which ends with it. Nothing is locked here: a
/// lock held at the fork is never released in the child.
///
/// Where address space is limited each call has a pool of its own as well,
/// of as many threads as there is room for.
///
/// # Errors
/// What `work` returns, or [`ThreadsError`] when the system gives no thread.
pub fn in_this_process<T: Send>(work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    let here = std::process::id();
    let whole = memory::room_for_threads().is_none();
    match HOME.compare_exchange(0, here, Ordering::Relaxed, Ordering::Relaxed) {
        Ok(_) if whole => work(),
        Err(home) if whole && home == here => work(),
        _ => pool(available())?.install(work),
    }
}

/// Runs `work` on `n` threads, or on as many as the machine has where `n` is more: further ones would wait.
///
/// # Errors
/// What `work` returns, or [`ThreadsError`] when the system gives no thread.
pub fn on<T: Send>(n: usize, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    pool(n.min(available()))?.install(work)
}

/// A pool of `n` threads, or of as many as have room, or of one where the system does not give so many.
fn pool(n: usize) -> Result<ThreadPool> {
    let n = memory::room_for_threads().map_or(n, |most| n.min(most));
    let build = |n| ThreadPoolBuilder::new().num_threads(n).build();
    let refused = |error: ThreadPoolBuildError| Error::Threads(ThreadsError { reason: error.to_string() });
    build(n).or_else(|_| build(1)).map_err(refused)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_threads_are_as_many_as_there_are() {
        let found = on(1_000_000, || Ok(rayon::current_num_threads()));
        assert_eq!(found, Ok(available()));
        assert_eq!(on(1, || Ok(rayon::current_num_threads())), Ok(1));
    }
}
