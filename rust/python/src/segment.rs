//! `segment`: the faces that a person would name.

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use ridgeform_core::tools::{self, Fillets, Hierarchy, Scale, SegmentMethod};

use crate::columns::{self, Values};
use crate::mesh::Mesh;
use crate::nested::nested_divisions;
use crate::numbers::at_least_if;
use crate::{arrays, doorway, options};

/// What becomes of fillets, by name.
const FILLETS: [(&str, Fillets); 3] =
    [("automatic", Fillets::Automatic), ("apart", Fillets::Apart), ("joined", Fillets::Joined)];

/// What `segment` returns: a label for every face, and finer and coarser segmentations nested with it.
#[pyclass(frozen, module = "ridgeform")]
pub struct Segmentation {
    /// The segment of each face, (m,) int32, from 0 in the order of their first faces;
    /// -1 for faces that took no part.
    #[pyo3(get)]
    labels: Py<PyArray1<i32>>,
    /// Number of segments.
    #[pyo3(get)]
    n_segments: usize,
    /// (m,) float64, near 1 inside segments and near 0 at borders.
    #[pyo3(get)]
    indicator: Py<PyArray1<f64>>,
    /// The signal with borders sharpened, float64, in its shape and units;
    /// without `values` the vertices, (n,3).
    #[pyo3(get)]
    values: Py<PyAny>,
    /// The vertices of the edges between segments, (k,2) int32.
    #[pyo3(get)]
    boundary_edges: Py<PyArray2<i32>>,
    /// Standard deviation of the noise found in the signal, in its units; of positions, along the normal.
    #[pyo3(get)]
    noise: f64,
    /// The fidelity weight at the end.
    #[pyo3(get)]
    fidelity: f64,
    /// The values of epsilon that it went through, (k,) float64.
    #[pyo3(get)]
    epsilons: Py<PyArray1<f64>>,
    /// How often indicator and signal took turns.
    #[pyo3(get)]
    alternations: usize,
    /// "solved", or "stopped" (`Progress.finish` was called).
    #[pyo3(get)]
    status: &'static str,
    hierarchy: Hierarchy,
}

nested_divisions! { Segmentation, n_segments, "segments";
    /// The strength of the border that falls with each merge, ascending, from `range[1]` segments down to
    /// `range[0]`, float64. For shapes radians, the mean bend across the border.
    #[getter]
    fn strengths<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.hierarchy.strengths().to_vec().into_pyarray(py)
    }
}

solver_function! {
    /// Divide the faces into segments on which the shape, or a function on it, is nearly plane (affine), with
    /// borders along the ridges.
    ///
    /// Minimizes fidelity ‖u - u₀‖²_M + Σ_f v_f² ‖(H u)_f‖ + length_weight (epsilon vᵀ L v + ‖1 - v‖² / (4
    /// epsilon)) in turns over the signal u and the indicator of borders v on the faces, epsilon halved from
    /// start to end. Smoothly curved parts stay one segment.
    ///
    /// Parameters
    /// ----------
    /// mesh : Mesh with positions
    /// values : (n,) or (n,k) array, the signal, k ≤ 16; None for the positions.
    ///     A signal is scaled to a range of 1
    /// length_weight : float > 0, what a border costs per length: two parts of a shape that meet at an edge
    ///     bent by less than about 0.8 times this (radians) become one; smaller gives more segments
    /// fidelity : float > 0, how closely u follows the signal; None:
    ///     as the noise found in the signal wants it (1000 for "paper")
    /// epsilon_start, epsilon_end : widths of the bands in which v falls, in the unit that `scale` sets;
    ///     "fitted" goes no lower than the mesh is fine
    /// inner_tolerance : the mean squared change of v at which epsilon is halved
    /// cut_threshold : 0 to 1, edges with a lower v are cut; for "paper"
    /// min_faces : segments of fewer faces are merged; None: 20, and for "fitted" down to 4 the less noise
    ///     there is, and 0 for modeled shapes
    /// scale : "extent" (a cube has its side, whatever its rotation),
    ///     "bounding_box" (the longest side is 1), "area" or "max_edge"
    /// method : "fitted" (watershed of v, merging of what bends little, border faces moved to the segment
    ///     that they fit best) or "paper" (cuts below the threshold, small pieces merged by majority)
    /// fillets : for shapes by "fitted" without `fidelity`; "automatic" (segments are told by the planes,
    ///     spheres, cylinders, cones and tori that their faces lie on, so every fillet is one, and by bends
    ///     where a smooth surface would do as well), "apart" (by such surfaces wherever they explain the
    ///     faces, also in patches of a free shape) or "joined" (as "automatic", and fillets and bevels belong
    ///     to the larger side beside them)
    /// n_segments : number of segments wanted, or None; fewer where the finest segmentation has fewer
    /// face_weights : (m,) array ≥ 0, what borders cost there: 1 is neutral, smaller attracts them
    /// edge_weights : (m,3) array ≥ 0, the same for edges, column i opposite corner i;
    ///     the mean of both faces' entries counts
    /// faces : faces to segment, (m,) booleans or (j,) indices; None for all
    /// noise : standard deviation of the noise in the signal, ≥ 0, in its units, of positions along the
    ///     normal; None where it is to be found
    /// coarse_to_fine : bool or None. True: segments are found on a mesh of some 9000 vertices, and their
    ///     borders moved to where finer ones have them; False: on the mesh itself; None: on a coarser mesh
    ///     from 18000 vertices on, for shapes by "fitted" without `fidelity` and `edge_weights`
    solver keywords
    /// progress : Progress or None
    ///
    /// Returns
    /// -------
    /// Segmentation
    ///
    /// Raises
    /// ------
    /// ArgumentError, MeshError (no positions, no face with area), SolveError, Cancelled
    ///
    /// References
    /// ----------
    /// Rowe et al. 2024, eqs. (25) and (41), section 7.5, supplement E.
    signature = (mesh, *, values=None, length_weight=0.5, fidelity=None, epsilon_start=0.1, epsilon_end=0.001,
        inner_tolerance=1e-5, cut_threshold=0.6, min_faces=None, scale=None, method="fitted",
        fillets="automatic", n_segments=None, face_weights=None, edge_weights=None, faces=None, noise=None,
        coarse_to_fine=None),
        tolerance = None,
        text_signature = "(mesh, *, values=None, length_weight=0.5, fidelity=None, epsilon_start=0.1, \
    epsilon_end=0.001, inner_tolerance=1e-05, cut_threshold=0.6, min_faces=None, scale='extent', \
    method='fitted', fillets='automatic', n_segments=None, face_weights=None, edge_weights=None, \
    faces=None, noise=None, coarse_to_fine=None, solver='auto', tolerance=None, max_iterations=None, \
    memory_limit=None, threads=None, progress=None)";
    pub fn segment(py: Python<'_>, solve, progress;
        mesh: &Mesh,
        values: Option<&Bound<'_, PyAny>>,
        length_weight: f64,
        fidelity: Option<f64>,
        epsilon_start: f64,
        epsilon_end: f64,
        inner_tolerance: f64,
        cut_threshold: f64,
        min_faces: Option<i64>,
        scale: Option<&Bound<'_, PyAny>>,
        method: &str,
        fillets: &str,
        n_segments: Option<i64>,
        face_weights: Option<&Bound<'_, PyAny>>,
        edge_weights: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
        noise: Option<f64>,
        coarse_to_fine: Option<bool>,
    ) -> PyResult<Segmentation> {
        let (n, m) = (mesh.n_vertices(), mesh.n_faces());
        let signal = values.map(|given| columns::read("values", given, n, "vertex")).transpose()?;
        let methods = [("fitted", SegmentMethod::Fitted), ("paper", SegmentMethod::Paper)];
        let options = tools::SegmentOptions {
            method: options::choice(py, "method", method, &methods)?,
            fillets: options::choice(py, "fillets", fillets, &FILLETS)?,
            length_weight,
            fidelity,
            epsilon_start,
            epsilon_end,
            inner_tolerance,
            cut_threshold,
            min_faces: at_least_if(py, "min_faces", min_faces, 0)?,
            n_segments: at_least_if(py, "n_segments", n_segments, 1)?,
            scale: options::scale_or_length(py, scale, Scale::Extent)?,
            face_weights: options::weights("face_weights", face_weights, m, "face")?,
            edge_weights: options::edge_weights(py, edge_weights)?,
            faces: arrays::mask("faces", faces, m, "face")?,
            noise,
            levels: options::levels(coarse_to_fine),
            solve: solve()?,
        };
        let given = signal.as_ref().map(|signal| &signal.columns);
        let found =
            doorway::call(py, &progress, || tools::segment(mesh.inner(), given, &options, &progress))?;
        let single = signal.as_ref().is_some_and(|signal| signal.single);
        Ok(Segmentation {
            labels: found.labels.into_pyarray(py).unbind(),
            n_segments: found.n_segments,
            indicator: found.indicator.into_pyarray(py).unbind(),
            values: columns::write(py, Values { columns: found.values, single }).unbind(),
            boundary_edges: arrays::index_rows(py, &found.boundary_edges)?.unbind(),
            noise: found.noise,
            fidelity: found.fidelity,
            epsilons: found.epsilons.into_pyarray(py).unbind(),
            alternations: found.alternations,
            status: found.status.name(),
            hierarchy: found.hierarchy,
        })
    }
}
