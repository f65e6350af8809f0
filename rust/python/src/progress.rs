//! `Progress`: watching, finishing and cancelling a running call from another thread.

use numpy::PyArray2;
use pyo3::prelude::*;
use ridgeform_core as core;

use crate::arrays::{float_rows, index_rows};

/// Vertices (k,3) and faces (j,3) as NumPy arrays.
type Surface<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i32>>);

/// A handle to pass as `progress=` and to use from another thread while the call runs;
/// make a fresh one for each call.
#[pyclass(frozen, module = "ridgeform")]
#[derive(Default)]
pub struct Progress {
    /// The core's handle; clones share one state.
    pub inner: core::Progress,
}

#[pymethods]
impl Progress {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// How much of the call is done, 0 to 1.
    #[getter]
    fn fraction(&self) -> f64 {
        self.inner.last_report().fraction
    }

    /// What is being done, in a word or two; empty before the call.
    #[getter]
    fn stage(&self) -> String {
        self.inner.last_report().stage
    }

    /// Number of finished steps (`stylize`) or iterations of the present stage.
    #[getter]
    fn iteration(&self) -> usize {
        self.inner.last_report().iteration
    }

    /// The energy after the last of them, or None while it is unknown.
    #[getter]
    fn energy(&self) -> Option<f64> {
        self.inner.last_report().energy
    }

    /// The relative duality gap of the last inner solution, or None while it is unknown.
    #[getter]
    fn gap(&self) -> Option<f64> {
        self.inner.last_report().gap
    }

    /// How often the call has asked so far whether to stop;
    /// between two questions it does not hear `cancel` and `finish`.
    #[getter]
    fn asked(&self) -> u64 {
        self.inner.n_asked()
    }

    /// Make the running call raise `Cancelled` within one inner iteration; it returns nothing.
    fn cancel(&self) {
        self.inner.cancel();
    }

    /// Make the running call return what it has reached within one inner iteration, with status "stopped".
    fn finish(&self) {
        self.inner.finish();
    }

    /// The vertices (n,3) float64 after the last finished flow step, a fresh array; None before the first.
    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.inner.snapshot().map(|vertices| float_rows(py, &vertices)).transpose()
    }

    /// The number of that step, from 1, and its vertices (n,3) float64, read at once; None before the first.
    /// A flow that begins on coarser meshes repeats some numbers on finer ones.
    fn numbered_snapshot<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Option<(usize, Bound<'py, PyArray2<f64>>)>> {
        self.inner
            .numbered_snapshot()
            .map(|(number, vertices)| PyResult::Ok((number, float_rows(py, &vertices)?)))
            .transpose()
    }

    /// The faces that a call which makes some (`fill_holes`) has made so far: their vertices (k,3) float64
    /// and faces (j,3) int32 among these, fresh arrays; None before the first.
    fn snapshot_surface<'py>(&self, py: Python<'py>) -> PyResult<Option<Surface<'py>>> {
        let read = |surface: std::sync::Arc<ridgeform_core::progress::Surface>| {
            PyResult::Ok((float_rows(py, &surface.0)?, index_rows(py, &surface.1)?))
        };
        self.inner.surface().map(read).transpose()
    }

    fn __repr__(&self) -> String {
        let report = self.inner.last_report();
        format!(
            "<ridgeform.Progress: {:.0} %, {}>",
            100.0 * report.fraction,
            if report.stage.is_empty() { "not started" } else { &report.stage }
        )
    }
}

/// The core's handle of `progress=`, or a fresh one.
pub(crate) fn handle(progress: Option<&Bound<'_, Progress>>) -> core::Progress {
    progress.map_or_else(core::Progress::new, |given| given.get().inner.clone())
}
