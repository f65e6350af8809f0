//! The keywords of every function that solves convex problems, and of those on functions on a mesh,
//! and what their documentation says: here once.

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

/// A Python function on functions on a mesh: a [`solver_function`] whose own keywords end with those of the
/// energy and of its problem.
///
/// Where `scalar keywords` stands in its documentation, theirs and the solver's come in. The body is given a
/// call that reads all of them, on a mesh and for values of so many columns.
macro_rules! scalar_function {
    (
        $(#[doc = $before:literal])*
        scalar keywords
        $(#[doc = $after:literal])*
        signature = ($($signature:tt)*);
        pub fn $name:ident(
            $py:ident: $python:ty, $scalar:ident, $progress:ident; $($argument:ident: $type:ty),* $(,)?
        )
            -> $result:ty $body:block
    ) => {
        solver_function! {
            $(#[doc = $before])*
            /// energy : "l1_hessian" (sharp ridges), "l2_hessian", "l2_curved_hessian" or "l2_laplacian"
            ///     (smooth), "l1_hessian_stein2018", "l1_edge_laplacian"; see `energy`
            /// face_weights : (m,) array w ≥ 0, 1 where None; energies on vertices and edges take the mean of
            ///     the faces around them
            /// linear_constraints : (A, b) with A (p,n): SparseMatrix, SciPy sparse matrix or array,
            ///     and b (p,) or (p,k)
            /// coupling : "joint" (one norm for all columns) or "separate" (each column is a problem of its
            ///     own)
            /// dual : "barycentric", "circumcentric" (MeshError where a dual edge has no length) or
            ///     "circumcentric_or_barycentric" (barycenters for such edges); for "l1_hessian" only
            /// delaunay : flip edges to the intrinsic Delaunay triangulation first; values stay at the
            ///     vertices, face weights are averaged over the two faces of each flip; not for energies in
            ///     space
            /// sharpness : 0 (the convex problem) to 1, reweighted rounds that concentrate curvature;
            ///     for "l1_hessian" only
            solver keywords
            $(#[doc = $after])*
            signature = ($($signature)*, energy="l1_hessian", face_weights=None, linear_constraints=None,
                coupling="joint", dual="barycentric", delaunay=false, sharpness=0.0), tolerance = 1e-3;
            pub fn $name($py: $python, solve, $progress;
                $($argument: $type,)*
                energy: &str,
                face_weights: Option<&Bound<'_, PyAny>>,
                linear_constraints: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
                coupling: &str,
                dual: &str,
                delaunay: bool,
                sharpness: f64,
            ) -> $result {
                let $scalar = |mesh: &$crate::mesh::Mesh, n_columns: usize| {
                    let energy = $crate::options::EnergyWords { energy, face_weights, dual, delaunay };
                    $crate::scalar::ScalarWords { energy, linear_constraints, coupling, sharpness }
                        .read($py, mesh, n_columns, solve)
                };
                $body
            }
        }
    };
}
