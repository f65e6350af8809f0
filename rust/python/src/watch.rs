//! Runs work on a thread of its own while the calling thread watches over it; knows no Python.

use std::any::Any;
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::thread::{Builder, Scope};
use std::time::Duration;

use ridgeform_core::Progress;

/// How often the caller looks for an interruption: short against a person's patience, long against its cost.
pub(crate) const INTERVAL: Duration = Duration::from_millis(50);

/// How watched work ended.
#[derive(Debug, PartialEq)]
pub(crate) enum Outcome<T, I> {
    /// It returned.
    Done(T),
    /// It panicked, with this message.
    Panicked(String),
    /// `interrupted` gave a reason to stop; the work was cancelled and has ended.
    Interrupted(I),
    /// The system gave no thread, for this reason.
    NotStarted(String),
}

/// Run `work` on a worker thread and ask `interrupted` every [`INTERVAL`] for a reason to stop.
///
/// At the first reason `progress` is cancelled; the call returns once the work has noticed, so nothing
/// outlives it. A panic of the work ends here.
pub(crate) fn watch<T: Send, I>(
    progress: &Progress,
    work: impl FnOnce() -> T + Send,
    mut interrupted: impl FnMut() -> Option<I>,
) -> Outcome<T, I> {
    std::thread::scope(|scope| {
        // The worker owns `alive` and drops it however it ends: that wakes the watcher at once.
        let (alive, ended) = channel::<()>();
        let worker = match spawn(scope, move || {
            let _alive = alive;
            work()
        }) {
            Ok(worker) => worker,
            Err(error) => return Outcome::NotStarted(error.to_string()),
        };
        let mut reason = None;
        while ended.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
            if reason.is_none() {
                reason = interrupted();
                if reason.is_some() {
                    progress.cancel();
                }
            }
        }
        match (worker.join(), reason) {
            (Err(panic), _) => Outcome::Panicked(message(panic.as_ref())),
            (Ok(_), Some(reason)) => Outcome::Interrupted(reason),
            (Ok(value), None) => Outcome::Done(value),
        }
    })
}

fn spawn<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    work: impl FnOnce() -> T + Send + 'scope,
) -> std::io::Result<std::thread::ScopedJoinHandle<'scope, T>> {
    Builder::new().name("ridgeform".into()).spawn_scoped(scope, work)
}

/// The text of a panic, as far as it has one.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "unknown panic".into())
}
