//! The one way from Python into the core: lock released, Ctrl-C heard, threads that
//! are alive also after a fork, panics and errors turned into exceptions.

use pyo3::prelude::*;
use ridgeform_core::error::ThreadsError;
use ridgeform_core::memory::{self, Demand};
use ridgeform_core::{threads, Error, Progress, Result};

use crate::errors;
use crate::watch::{watch, Outcome};

/// Run `work` without the interpreter lock; what it returns or how it failed comes back to the caller.
///
/// A call for which not even the threads and small arrays of any call have room is refused before it starts.
///
/// Signal handlers run meanwhile, so Ctrl-C cancels the work and raises `KeyboardInterrupt`.
pub(crate) fn call<T: Send>(
    py: Python<'_>,
    progress: &Progress,
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    memory::floor("the call").map_err(|error| errors::exception(py, &error))?;
    let work = || threads::in_this_process(work);
    let outcome = py.detach(|| watch(progress, work, || Python::attach(|py| py.check_signals().err())));
    match outcome {
        Outcome::Done(Ok(value)) => Ok(value),
        Outcome::Done(Err(error)) => Err(errors::exception(py, &error)),
        Outcome::Panicked(message) => Err(errors::internal(py, &message)),
        Outcome::Interrupted(signal) => Err(signal),
        Outcome::NotStarted(reason) => Err(errors::exception(py, &Error::Threads(ThreadsError { reason }))),
    }
}

/// [`call`] for work too short to be watched from outside.
pub(crate) fn call_briefly<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T> + Send) -> PyResult<T> {
    call(py, &Progress::new(), work)
}

/// [`call_briefly`] for work that does not ask for its memory by itself.
pub(crate) fn call_sized<T: Send>(
    py: Python<'_>,
    demand: Demand,
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    call_briefly(py, || {
        demand.admit(None)?;
        work()
    })
}
