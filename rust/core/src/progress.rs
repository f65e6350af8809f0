//! Cancelling, finishing early and watching a running call from another thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use crate::{Error, Result};

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

#[derive(Debug, Default)]
struct State {
    report: Report,
    snapshot: Option<Vec<[f64; 3]>>,
    surface: Option<Surface>,
}

#[derive(Debug, Default)]
struct Wishes {
    cancel: AtomicBool,
    finish: AtomicBool,
}

/// A handle shared between a running call and whoever watches it; clones share one state.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    wishes: Arc<Wishes>,
    state: Arc<Mutex<State>>,
}

impl Progress {
    /// A fresh handle.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A handle for a part of the call: it hears the same wishes, and what is published through it nobody sees.
    #[must_use]
    pub fn quiet(&self) -> Self {
        Self { wishes: Arc::clone(&self.wishes), state: Arc::default() }
    }

    /// Ask the running call to stop and return [`Error::Cancelled`].
    pub fn cancel(&self) {
        self.wishes.cancel.store(true, Ordering::Relaxed);
    }

    /// Ask the running call to stop and return what it has reached.
    pub fn finish(&self) {
        self.wishes.finish.store(true, Ordering::Relaxed);
    }

    /// Whether [`Progress::cancel`] was called.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.wishes.cancel.load(Ordering::Relaxed)
    }

    /// Whether [`Progress::finish`] was called.
    #[must_use]
    pub fn is_finishing(&self) -> bool {
        self.wishes.finish.load(Ordering::Relaxed)
    }

    /// # Errors
    /// [`Error::Cancelled`] after [`Progress::cancel`].
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() {
            Err(Error::Cancelled)
        } else {
            Ok(())
        }
    }

    /// Publish where the call stands.
    pub fn report(&self, report: Report) {
        self.state().report = report;
    }

    /// What the call last published.
    #[must_use]
    pub fn last_report(&self) -> Report {
        self.state().report.clone()
    }

    /// Publish the vertices after a finished flow step.
    pub fn set_snapshot(&self, vertices: &[[f64; 3]]) {
        self.state().snapshot = Some(vertices.to_vec());
    }

    /// The vertices after the last finished flow step.
    #[must_use]
    pub fn snapshot(&self) -> Option<Vec<[f64; 3]>> {
        self.state().snapshot.clone()
    }

    /// Publish the faces that the call has made so far, with vertices of their own.
    pub fn set_surface(&self, vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) {
        self.state().surface = Some((vertices, faces));
    }

    /// The faces that the call had made when it last said so.
    #[must_use]
    pub fn surface(&self) -> Option<Surface> {
        self.state().surface.clone()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A poisoned lock only means that a watcher panicked while reading: the state itself is plain data.
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}
