//! What a call says of itself while nobody knows how much is left to do.

use std::cell::Cell;

use crate::progress::{Progress, Report};
use crate::Result;

/// The parts of a call: which fractions of the whole they are between. Merging takes about half the time.
pub(super) mod shares {
    pub(in super::super) const MERGING: [f64; 2] = [0.0, 0.5];
    /// The second of each is for where the first were not joined as far as was asked for.
    pub(in super::super) const FINDING: [[f64; 2]; 2] = [[0.5, 0.7], [0.8, 0.85]];
    pub(in super::super) const JOINING: [[f64; 2]; 2] = [[0.7, 0.8], [0.85, 0.9]];
    pub(in super::super) const FITTING: [f64; 2] = [0.9, 0.98];
    pub(in super::super) const VOLUME: [f64; 2] = [0.98, 1.0];
}

/// Steps of Newton that finding facets takes on most meshes, each join with its trials, and fitting planes.
pub(super) const USUAL: [usize; 3] = [200, 100, 100];

/// A part of a call, between two fractions of the whole. After the `usual` number of steps it is halfway, and
/// every further one takes less of what is left: it never stands still, and never runs back.
pub(super) struct Stage<'p> {
    progress: &'p Progress,
    name: &'static str,
    fractions: [f64; 2],
    usual: f64,
    n_steps: Cell<usize>,
}

impl<'p> Stage<'p> {
    pub(super) fn new(progress: &'p Progress, name: &'static str, fractions: [f64; 2], usual: usize) -> Self {
        Self { progress, name, fractions, usual: usual.max(1) as f64, n_steps: Cell::new(0) }
    }

    /// Says that a step is done.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn step(&self) -> Result<()> {
        self.progress.check()?;
        let iteration = self.n_steps.get() + 1;
        self.n_steps.set(iteration);
        let ([from, to], n) = (self.fractions, iteration as f64);
        let fraction = from + (to - from) * n / (n + self.usual);
        self.progress.report(Report { fraction, stage: self.name.into(), iteration, ..Report::default() });
        Ok(())
    }

    /// The handle that it asks.
    pub(super) fn progress(&self) -> &'p Progress {
        self.progress
    }

    /// Whether to leave it at what there is.
    pub(super) fn is_finishing(&self) -> bool {
        self.progress.is_finishing()
    }
}
