//! What every tool can be told about the solver and the machine.

use crate::solve::{Settings, Solver};
use crate::{threads, Error, Result};

/// Whether a tool works on coarser meshes first ([`crate::levels`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Levels {
    /// On meshes with at least twice the vertices of the coarsest level, where what is asked for suits it.
    #[default]
    Auto,
    /// On meshes with more vertices than the coarsest level.
    Always,
    /// Everything is done on the mesh itself.
    Never,
}

/// The most vertices of the coarsest level: what tools make of a shape at their usual settings has some
/// hundred facets or segments, so that each has some tens of vertices; and a whole flow takes about a second.
pub(super) const ENOUGH: usize = 9000;

impl Levels {
    /// Whether they are used on a mesh with so many vertices, if the coarsest level has `enough` and what is
    /// asked for `is_suited`.
    pub(super) fn are_used(self, n_vertices: usize, enough: usize, is_suited: bool) -> bool {
        match self {
            Self::Auto => is_suited && n_vertices >= 2 * enough,
            Self::Always => n_vertices > enough,
            Self::Never => false,
        }
    }
}

/// Which solver, how exact, how long, on how many threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolveOptions {
    /// The solver.
    pub solver: Solver,
    /// The relative duality gap to certify; `None` stops on residuals and reports the gap reached.
    pub tolerance: Option<f64>,
    /// At most this many iterations of the solver.
    pub max_iterations: Option<usize>,
    /// The most bytes that the factor of the linear system may take, the larger part of all memory; any that
    /// the system gives where `None`. Clarabel does not know it.
    pub memory_limit: Option<usize>,
    /// Threads to use, of those that the machine has; all where `None`. The result does not depend on it.
    pub threads: Option<usize>,
}

impl Default for SolveOptions {
    fn default() -> Self {
        Self {
            solver: Solver::Auto,
            tolerance: Some(1e-3),
            max_iterations: None,
            memory_limit: None,
            threads: None,
        }
    }
}

impl SolveOptions {
    /// What the solver itself needs to know.
    ///
    /// # Errors
    /// [`Error::Argument`] for a tolerance that is not positive, or no iterations or threads at all.
    pub fn settings(&self) -> Result<Settings> {
        check_positive("tolerance", self.tolerance, "it must be positive, say 1e-3")?;
        if self.max_iterations == Some(0) {
            return Err(Error::argument("max_iterations", "is 0; allow at least one iteration"));
        }
        if self.threads == Some(0) {
            return Err(Error::argument("threads", "is 0; use at least one thread, or None for all"));
        }
        let Self { tolerance, max_iterations, memory_limit, .. } = *self;
        Ok(Settings { tolerance, max_iterations, memory_limit, announce: true })
    }

    /// The same for what runs within a tool that has set the threads.
    pub(super) fn within(&self) -> Self {
        Self { threads: None, ..*self }
    }

    /// The same stopped on residuals, which is enough where no gap is reported.
    pub(super) fn on_residuals(&self) -> Self {
        Self { tolerance: None, ..*self }
    }

    /// Runs `work` on the number of threads asked for.
    ///
    /// # Errors
    /// What `work` returns, or [`Error::Threads`] when none can be started.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
        match self.threads {
            None => work(),
            Some(n) => threads::on(n, work),
        }
    }
}

/// What painted weights of edges, a row a face, and of faces make of a border along halfedge `h`;
/// 1 without any.
pub(super) fn painted_weight(
    edge_weights: Option<&Vec<[f64; 3]>>,
    face_weights: Option<&Vec<f64>>,
    h: usize,
) -> f64 {
    edge_weights.map_or(1.0, |w| w[h / 3][h % 3]) * face_weights.map_or(1.0, |w| w[h / 3])
}

/// Refuses a number, where one is given, that is not positive and finite; `cure` says what to give instead.
pub(super) fn check_positive(name: &'static str, value: impl Into<Option<f64>>, cure: &str) -> Result<()> {
    match value.into() {
        Some(value) if !(value > 0.0 && value.is_finite()) => {
            Err(Error::argument(name, format!("is {value}; {cure}")))
        }
        _ => Ok(()),
    }
}

/// Refuses a choice of vertices that does not fit a mesh of `n` vertices.
pub(super) fn check_fixed(fixed: Option<&[bool]>, n: usize) -> Result<()> {
    match fixed {
        Some(fixed) if fixed.len() != n => Err(Error::argument(
            "fixed",
            format!("has {} entries, expected one per vertex: {n}", fixed.len()),
        )),
        _ => Ok(()),
    }
}

/// Refuses a number outside `range`.
pub(super) fn check_range(name: &'static str, value: f64, least: f64, most: f64) -> Result<()> {
    if value >= least && value <= most {
        return Ok(());
    }
    Err(Error::argument(name, format!("is {value}; it must be between {least} and {most}")))
}

/// Refuses weights of edges, one row a face, that do not fit a mesh of `m` faces,
/// or are negative or not finite.
pub(super) fn check_edge_weights(rows: Option<&[[f64; 3]]>, m: usize) -> Result<()> {
    let Some(rows) = rows else { return Ok(()) };
    if rows.len() != m {
        return Err(Error::argument(
            "edge_weights",
            format!("has {} rows, expected one per face: {m}", rows.len()),
        ));
    }
    check_weights("edge_weights", Some(&rows.as_flattened().to_vec()), 3 * m, "halfedge")
}

/// Refuses a choice of faces that does not fit a mesh of `m` faces, or is empty.
pub(super) fn check_faces(faces: Option<&[bool]>, m: usize) -> Result<()> {
    match faces {
        Some(faces) if faces.len() != m => {
            Err(Error::argument("faces", format!("has {} entries, expected one per face: {m}", faces.len())))
        }
        Some(faces) if !faces.contains(&true) => {
            Err(Error::argument("faces", "names no face; give at least one, or None for all"))
        }
        _ => Ok(()),
    }
}

/// Refuses a weight list of the wrong length or with entries that are negative or not finite.
pub(super) fn check_weights(name: &'static str, values: Option<&Vec<f64>>, n: usize, of: &str) -> Result<()> {
    let Some(values) = values else { return Ok(()) };
    if values.len() != n {
        return Err(Error::argument(
            name,
            format!("has {} entries, expected one per {of}: {n}", values.len()),
        ));
    }
    match values.iter().position(|x| !(x.is_finite() && *x >= 0.0)) {
        Some(i) => Err(Error::argument(
            name,
            format!("entry {i} is {}; it must be finite and at least 0", values[i]),
        )),
        None => Ok(()),
    }
}
