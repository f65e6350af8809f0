//! The keywords of every function that solves convex problems, and what their documentation says: here once.

/// A Python function whose keywords end with those of the solver.
///
/// Where `solver keywords` stands in its documentation, theirs comes in; `tolerance` is the default of that
/// one. The body is given the interpreter, a call that reads the solver's options, and the progress handle.
macro_rules! solver_function {
    (
        $(#[doc = $before:literal])*
        solver keywords
        $(#[doc = $after:literal])*
        signature = ($($signature:tt)*), tolerance = $tolerance:tt $(, text_signature = $text:literal)?;
        pub fn $name:ident $(<$lifetime:lifetime>)? (
            $py:ident: $python:ty, $solve:ident, $progress:ident; $($argument:ident: $type:ty),* $(,)?
        )
            -> $result:ty $body:block
    ) => {
        $(#[doc = $before])*
        /// solver : "auto", "fast", "clarabel", "clarabel-qdldl" or "clarabel-faer"; "auto" alone for
        ///     quadratic energies, which take one sparse factorization
        /// tolerance : certified relative gap to reach in every problem that is solved; None stops on
        ///     residuals and reports the gap reached
        /// max_iterations : at most so many solver iterations for each of them, or None
        /// memory_limit : bytes that the factor of the linear system, the larger part of all memory, may
        ///     take, or None; SolveError with the bytes needed where it does not fit. Clarabel does not know
        ///     it
        /// threads : int or None
        $(#[doc = $after])*
        #[pyfunction]
        #[pyo3(signature = ($($signature)*, solver="auto", tolerance=$tolerance, max_iterations=None,
            memory_limit=None, threads=None, progress=None) $(, text_signature = $text)?)]
        #[allow(clippy::too_many_arguments)]
        pub(crate) fn $name $(<$lifetime>)? (
            $py: $python,
            $($argument: $type,)*
            solver: &str,
            tolerance: Option<f64>,
            max_iterations: Option<i64>,
            memory_limit: Option<i64>,
            threads: Option<i64>,
            progress: Option<&Bound<'_, $crate::progress::Progress>>,
        ) -> $result {
            let $solve =
                || $crate::options::solve($py, solver, tolerance, max_iterations, memory_limit, threads);
            let $progress = $crate::progress::handle(progress);
            $body
        }
    };
}
