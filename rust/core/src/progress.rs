//! Cancelling, finishing early and watching a running call from another thread.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, TryLockError};
use std::time::{Duration, Instant};

use crate::unit::Unit;
use crate::{memory, Error, Result};

/// What a running call last said of itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// How much is done, 0 to 1.
    pub fraction: f64,
    /// What is being done, in a word or two.
    pub stage: String,
    /// The number of finished steps or iterations of that stage.
    pub iteration: usize,
    /// The energy after the last of them, if known.
    pub energy: Option<f64>,
    /// The relative duality gap of the last inner solution, if known.
    pub gap: Option<f64>,
}

/// Vertices and faces that a running call has made so far.
pub type Surface = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// How long a watcher waits for the state: it is held for less than a millisecond, or since a fork,
/// and then forever.
const PATIENCE: Duration = Duration::from_secs(1);

#[derive(Debug, Default)]
struct State {
    report: Report,
    snapshot: Option<(usize, Arc<Vec<[f64; 3]>>)>,
    surface: Option<Arc<Surface>>,
}

#[derive(Debug, Default)]
struct Wishes {
    cancel: AtomicBool,
    finish: AtomicBool,
    asked: AtomicU64,
    /// At which question to wish so by itself; 0 for never.
    cancel_at: AtomicU64,
    finish_at: AtomicU64,
}

/// A handle shared between a running call and whoever watches it; clones share one state.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    wishes: Arc<Wishes>,
    state: Arc<Mutex<State>>,
    /// What the coordinates are measured in that are published through this handle.
    unit: Unit,
    hearing: Hearing,
}

/// What a wish to finish is to a part of the call.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Hearing {
    /// A wish to return what there is.
    #[default]
    Whole,
    /// Nothing.
    Patient,
    /// The same as a wish to cancel.
    Hasty,
}

impl Progress {
    /// A fresh handle.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A handle for a part of the call: it hears the same wishes,
    /// and what is published through it nobody sees.
    #[must_use]
    pub fn quiet(&self) -> Self {
        Self { state: Arc::default(), ..self.clone() }
    }

    /// The handle for a part of the call that measures coordinates in `unit`.
    #[must_use]
    pub fn in_unit(&self, unit: Unit) -> Self {
        Self { unit: self.unit.times(unit), ..self.clone() }
    }

    /// A handle for a part of the call that takes little time, and without which there would be no result: it
    /// does not hear a wish to finish.
    #[must_use]
    pub fn patient(&self) -> Self {
        Self { hearing: Hearing::Patient, ..self.clone() }
    }

    /// A handle for a part of the call of which nothing is taken unless it is done: a wish to finish ends it
    /// with [`Error::Cancelled`], which says nothing of the call, whose own handle may not be cancelled.
    #[must_use]
    pub fn hasty(&self) -> Self {
        Self { hearing: Hearing::Hasty, ..self.clone() }
    }

    /// Ask the running call to stop and return [`Error::Cancelled`].
    pub fn cancel(&self) {
        self.wishes.cancel.store(true, Ordering::Relaxed);
    }

    /// Ask the running call to stop and return what it has reached.
    pub fn finish(&self) {
        self.wishes.finish.store(true, Ordering::Relaxed);
    }

    /// [`Progress::cancel`] when the call asks for the `n`th time from now, or [`Progress::finish`] with
    /// `finish`: what a wish at this place of the work leads to is the same on any machine.
    pub fn stop_when_asked(&self, n: u64, finish: bool) {
        let at = if finish { &self.wishes.finish_at } else { &self.wishes.cancel_at };
        at.store(self.n_asked() + n.max(1), Ordering::Relaxed);
    }

    /// Whether [`Progress::cancel`] was called, or what is done here is not worth going on with
    /// ([`Progress::hasty`]).
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        let asked = self.wishes.asked.fetch_add(1, Ordering::Relaxed) + 1;
        if asked == self.wishes.cancel_at.load(Ordering::Relaxed) {
            self.cancel();
        }
        if asked == self.wishes.finish_at.load(Ordering::Relaxed) {
            self.finish();
        }
        let is_hasty = self.hearing == Hearing::Hasty;
        self.wishes.cancel.load(Ordering::Relaxed) || is_hasty && self.wishes.finish.load(Ordering::Relaxed)
    }

    /// Whether to leave what is being done: the call is to be cancelled, or to finish with what there is.
    #[must_use]
    pub fn is_stopping(&self) -> bool {
        self.is_cancelled() || self.is_finishing()
    }

    /// Whether [`Progress::finish`] was called, and is heard here.
    #[must_use]
    pub fn is_finishing(&self) -> bool {
        self.hearing != Hearing::Patient && self.wishes.finish.load(Ordering::Relaxed)
    }

    /// How often the call has asked whether to stop: between two questions it hears nothing.
    #[must_use]
    pub fn n_asked(&self) -> u64 {
        self.wishes.asked.load(Ordering::Relaxed)
    }

    /// # Errors
    /// [`Error::Cancelled`] where [`Progress::is_cancelled`] says so.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() {
            Err(Error::Cancelled)
        } else {
            Ok(())
        }
    }

    /// Publish where the call stands.
    pub fn report(&self, report: Report) {
        self.with(|state| state.report = report);
    }

    /// What the call last published.
    #[must_use]
    pub fn last_report(&self) -> Report {
        self.with(|state| state.report.clone()).unwrap_or_default()
    }

    /// Publish the vertices after a finished flow step, its number from 1; where there is no room for them,
    /// the last ones stay.
    pub fn set_snapshot(&self, step: usize, vertices: &[[f64; 3]]) {
        let restored = vertices.iter().map(|p| p.map(|x| self.unit.restore(x)));
        let Ok(vertices) = memory::gathered(restored) else { return };
        let vertices = Arc::new(vertices);
        self.with(|state| state.snapshot = Some((step, vertices)));
    }

    /// The vertices after the last finished flow step.
    #[must_use]
    pub fn snapshot(&self) -> Option<Arc<Vec<[f64; 3]>>> {
        self.numbered_snapshot().map(|(_, vertices)| vertices)
    }

    /// The same, with the number of that step, from 1.
    #[must_use]
    pub fn numbered_snapshot(&self) -> Option<(usize, Arc<Vec<[f64; 3]>>)> {
        self.with(|state| state.snapshot.clone()).flatten()
    }

    /// Publish the faces that the call has made so far, with vertices of their own.
    pub fn set_surface(&self, mut vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) {
        self.unit.restore_all(vertices.iter_mut().flatten());
        let surface = Arc::new((vertices, faces));
        self.with(|state| state.surface = Some(surface));
    }

    /// The faces that the call had made when it last said so.
    #[must_use]
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.with(|state| state.surface.clone()).flatten()
    }

    /// Reads or writes the state; `None` where a fork left it locked by a thread that is not in this process.
    fn with<T>(&self, access: impl FnOnce(&mut State) -> T) -> Option<T> {
        let start = Instant::now();
        loop {
            match self.state.try_lock() {
                Ok(mut state) => return Some(access(&mut state)),
                // A watcher panicked while reading: the state itself is plain data.
                Err(TryLockError::Poisoned(poisoned)) => return Some(access(&mut poisoned.into_inner())),
                Err(TryLockError::WouldBlock) if start.elapsed() > PATIENCE => return None,
                Err(TryLockError::WouldBlock) => std::thread::yield_now(),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_that_is_never_released_is_given_up() {
        let progress = Progress::new();
        progress.set_snapshot(1, &[[1.0, 2.0, 3.0]]);
        assert_eq!(progress.snapshot().as_deref(), Some(&vec![[1.0, 2.0, 3.0]]));
        let watcher = progress.clone();
        let held = progress.state.lock();
        assert_eq!(std::thread::spawn(move || watcher.snapshot()).join().ok(), Some(None));
        drop(held);
        assert!(progress.snapshot().is_some());
    }

    #[test]
    fn a_wish_to_finish_ends_what_is_hasty_and_nothing_that_is_patient() {
        let progress = Progress::new();
        let (hasty, patient) = (progress.hasty(), progress.patient());
        assert!(!hasty.is_cancelled());
        progress.finish();
        assert_eq!(
            (hasty.check(), progress.check(), patient.check()),
            (Err(Error::Cancelled), Ok(()), Ok(()))
        );
        assert_eq!([&hasty, &progress, &patient].map(Progress::is_finishing), [true, true, false]);
    }

    #[test]
    fn a_wish_may_wait_for_a_question() {
        let progress = Progress::new();
        assert!(!progress.is_cancelled());
        progress.stop_when_asked(2, false);
        progress.stop_when_asked(1, true);
        assert!(!progress.is_finishing() && !progress.is_cancelled());
        assert!(progress.is_finishing() && progress.is_cancelled());
        assert_eq!(progress.n_asked(), 3);
    }
}
