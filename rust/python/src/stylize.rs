//! `stylize`: the flow that turns a mesh piecewise flat.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::tools::{self, Scale};

use crate::mesh::Mesh;
use crate::numbers::at_least;
use crate::{arrays, doorway, options};

/// What `stylize` returns: the new positions, and how each step of the flow went.
#[pyclass(frozen, get_all, module = "ridgeform")]
pub struct Stylized {
    /// The new vertex positions, (n,3) float64, in the units of the input.
    vertices: Py<PyArray2<f64>>,
    /// The energy of the coordinates before the first and after every step, on the mesh of that step,
    /// (steps + 1,) float64.
    energy: Py<PyArray1<f64>>,
    /// The fidelity of every step, in the unit that `scale` sets, (steps,) float64.
    fidelities: Py<PyArray1<f64>>,
    /// The certified relative duality gap of every step's problem, (steps,) float64.
    gap: Py<PyArray1<f64>>,
    /// The solver's iterations in every step, (steps,) int32.
    solver_iterations: Py<PyArray1<i32>>,
    /// Steps of the flow, from its beginning to its end. With `coarse_to_fine` the last ones were done on
    /// several meshes, and arrays over steps have an entry each time.
    iterations: usize,
    /// The vertices of the mesh that each step was done on, (steps,) int32: fewer than the mesh's own for
    /// coarser levels.
    level_vertices: Py<PyArray1<i32>>,
    /// Numeric factorizations, all steps together.
    factorisations: usize,
    /// The part of the area in faces that lie in one plane with all their neighbors (at less than 2 degrees,
    /// in proportion less where they are smaller than 3e-4 of the area), before and after, (2,) float64.
    flat_share: Py<PyArray1<f64>>,
    /// Facets that one would count afterward: parts whose faces lie in one plane in that sense,
    /// with at least 3e-4 of the area.
    n_facets: usize,
    /// "finished" (all steps done), "reached" (moved as far as `movement` allows, or as flat as `flat_share`
    /// asks), "settled" (more steps would make no more of it flat), "inaccurate" (as finished, but a step
    /// missed its tolerance), "converged" (nothing moves any more), "collapsed" (the shape has no extent
    /// left; its last sound step is returned), "diverged" (a step left the surroundings of the shape: its
    /// triangles are too uneven for numbers; its last sound step is returned) or "stopped" (`Progress.finish`
    /// was called).
    status: &'static str,
}

#[pymethods]
impl Stylized {
    fn __repr__(&self) -> String {
        format!("<ridgeform.Stylized: {} after {} steps>", self.status, self.iterations)
    }
}

solver_function! {
    /// Turn a mesh piecewise flat with crisp ridges, in steps of the L1 Hessian flow.
    ///
    /// Each step minimizes Σ_f w_f ‖(H x)_f‖ + fidelity (x - x₀)ᵀ M (x - x₀) over the vertex positions x,
    /// with H and M from the positions x₀ before the step.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh with positions
    /// iterations : number of steps, ≥ 0
    /// fidelity : float > 0, how strongly a step holds on to the shape, in the unit that `scale` sets;
    ///     larger changes less
    /// movement : None (all steps alike) or float > 0: how far the vertices may move, root mean square by
    ///     area, in parts of the square root of the surface's area. Then `fidelity` is that of the first
    ///     step, each step doubles the time of the flow, and it ends when that movement is reached or the
    ///     planes have settled, after at most `iterations` steps
    /// flat_share : None or float from 0 to 1: as with `movement`, but the flow ends when this part of the
    ///     area is flat (as `Stylized.flat_share` measures it) and facets have formed; with both, at
    ///     whichever comes first
    /// sharpness : 0 (the paper's energy) to 1 (most angular): reweighting from step to step, w_f ∝
    ///     (curvature + 0.1)^(-sharpness)
    /// coupling : "joint" (one norm for the three coordinates, independent of the axes) or "separate" (the
    ///     paper's)
    /// scale : "max_edge" (the longest edge is 1: the paper's unit), "bounding_box" (the longest side is 1),
    ///     "area" (the surface is 1), "extent" (a cube has its side, whatever its rotation), or a number > 0:
    ///     the length that is 1, in the units of the mesh
    /// fixed : vertices that stay where they are: (n,) booleans or (j,) indices
    /// strength : (n,) array, 0 (stay) to 1 (full effect)
    /// ridge_weights : (m,) array > 0, 1 is neutral, smaller makes ridges cheaper there
    /// delaunay : flip edges to intrinsic Delaunay before each step
    /// dual : "barycentric", "circumcentric" (MeshError where a dual edge has no length) or
    ///     "circumcentric_or_barycentric" (barycenters for such edges)
    /// coarse_to_fine : bool or None. True: the flow is done on a mesh of some 9000 vertices first, which
    ///     edge collapses leave of this one, and only its last steps on finer ones and on the mesh itself;
    ///     False: all steps on the mesh itself; None: True for a flow with `movement` or `flat_share` on a
    ///     mesh of at least 18,000 vertices
    solver keywords
    /// progress : Progress or None; its snapshot() shows the vertices after the last finished step
    ///
    /// Returns
    /// -------
    /// Stylized
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError (no positions, no face with area), SolveError, Cancelled
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, eq. (24), section 7.3; reweighting: Candès et al. 2008; levels: Garland and
    /// Heckbert 1997.
    signature = (mesh, *, iterations=20, fidelity=500.0, movement=None, flat_share=None, sharpness=0.5,
        coupling="joint", scale=None, fixed=None, strength=None, ridge_weights=None, delaunay=false,
        dual="barycentric", coarse_to_fine=None),
        tolerance = 1e-3,
        text_signature = "(mesh, *, iterations=20, fidelity=500.0, movement=None, flat_share=None, \
    sharpness=0.5, coupling='joint', scale='max_edge', fixed=None, strength=None, ridge_weights=None, \
    delaunay=False, dual='barycentric', coarse_to_fine=None, solver='auto', tolerance=0.001, \
    max_iterations=None, memory_limit=None, threads=None, progress=None)";
    pub fn stylize(py: Python<'_>, solve, progress;
        mesh: &Mesh,
        iterations: i64,
        fidelity: f64,
        movement: Option<f64>,
        flat_share: Option<f64>,
        sharpness: f64,
        coupling: &str,
        scale: Option<&Bound<'_, PyAny>>,
        fixed: Option<&Bound<'_, PyAny>>,
        strength: Option<&Bound<'_, PyAny>>,
        ridge_weights: Option<&Bound<'_, PyAny>>,
        delaunay: bool,
        dual: &str,
        coarse_to_fine: Option<bool>,
    ) -> PyResult<Stylized> {
        let (n, m) = (mesh.n_vertices(), mesh.n_faces());
        let options = tools::StylizeOptions {
            iterations: at_least(py, "iterations", iterations, 0)?,
            fidelity,
            movement,
            flat_share,
            sharpness,
            coupling: options::coupling(py, coupling)?,
            scale: options::scale_or_length(py, scale, Scale::MaxEdge)?,
            fixed: arrays::mask("fixed", fixed, n, "vertex")?,
            strength: options::weights("strength", strength, n, "vertex")?,
            ridge_weights: options::weights("ridge_weights", ridge_weights, m, "face")?,
            delaunay,
            dual: options::dual(py, dual)?,
            levels: options::levels(coarse_to_fine),
            solve: solve()?,
        };
        let result = doorway::call(py, &progress, || tools::stylize(mesh.inner(), &options, &progress))?;
        let counts = result.solver_iterations.iter().map(|&count| i32::try_from(count).unwrap_or(i32::MAX));
        let [before, after] = result.flatness;
        let level_vertices =
            result.level_vertices.iter().map(|&count| i32::try_from(count).unwrap_or(i32::MAX));
        Ok(Stylized {
            flat_share: vec![before.flat_share, after.flat_share].into_pyarray(py).unbind(),
            n_facets: after.n_facets,
            vertices: arrays::float_rows(py, &result.vertices)?.unbind(),
            solver_iterations: counts.collect::<Vec<_>>().into_pyarray(py).unbind(),
            iterations: result.iterations,
            level_vertices: level_vertices.collect::<Vec<_>>().into_pyarray(py).unbind(),
            energy: result.energy.into_pyarray(py).unbind(),
            fidelities: result.fidelities.into_pyarray(py).unbind(),
            gap: result.gap.into_pyarray(py).unbind(),
            factorisations: result.factorisations,
            status: result.status.name(),
        })
    }
}
