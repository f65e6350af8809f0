//! What the tools take at their peak, as functions of the size of the mesh:
//! fitted to measured resident memory.
//!
//! Measured by `make bench-memory` on grids with noise of 10 thousand to a million vertices, each call in a
//! process of its own; the table with what was measured and what is said here is in `docs/reliability.md`. A
//! mesh of another shape has another factor: on a strip it is smaller than said, so that solvers ask again
//! with the exact size once they have analyzed the matrix.

/// A tool, or any other call that takes memory in proportion to the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tool {
    /// Making a mesh from arrays.
    Mesh,
    /// [`crate::mesh::report`].
    Report,
    /// [`crate::operators::hessian`] and what is made of it.
    Hessian,
    /// [`crate::operators::cotangent_laplacian`].
    Laplacian,
    /// An energy or a norm.
    Energy,
    /// Intrinsic Delaunay flips.
    Delaunay,
    /// [`crate::hole_filling::find_holes`].
    FindHoles,
    /// [`crate::tools::stylize`].
    Stylize,
    /// [`crate::tools::denoise`].
    Denoise,
    /// [`crate::tools::interpolate`].
    Interpolate,
    /// Both with a quadratic energy.
    Quadratic,
    /// [`crate::tools::vibration_modes`]: a column for each mode.
    Modes,
    /// The same with a quadratic energy.
    QuadraticModes,
    /// [`crate::tools::segment`].
    Segment,
    /// The same with segments found on a coarser mesh.
    SegmentByLevels,
    /// [`crate::tools::parts`].
    Parts,
    /// [`crate::tools::facet`].
    Facet,
    /// The same with facets found on a coarser mesh.
    FacetByLevels,
    /// [`crate::tools::restore`].
    Restore,
    /// [`crate::tools::fill_holes`].
    FillHoles,
    /// [`crate::remesh::remesh`].
    Remesh,
    /// [`crate::tools::diffusion_curves`].
    DiffusionCurves,
    /// [`crate::tools::redraw`].
    Redraw,
    /// [`crate::tools::trace_curves`] and [`crate::tools::smooth_curves`].
    Curves,
}

/// Bytes of one call: `face · m + factor · m log₂ m` for `m` faces, and so much for every further column that
/// is computed with: rows are of 1, 2, 4, 8 or 16.
pub(super) struct Cost {
    pub face: f64,
    pub logarithmic: f64,
    pub column: f64,
}

impl Tool {
    /// Every tool by the name that users call it by.
    pub const ALL: [(&'static str, Self); 26] = [
        ("mesh", Self::Mesh),
        ("report", Self::Report),
        ("hessian", Self::Hessian),
        ("cotangent_laplacian", Self::Laplacian),
        ("energy", Self::Energy),
        ("intrinsic_delaunay", Self::Delaunay),
        ("find_holes", Self::FindHoles),
        ("stylize", Self::Stylize),
        ("denoise", Self::Denoise),
        ("interpolate", Self::Interpolate),
        ("denoise_quadratic", Self::Quadratic),
        ("interpolate_quadratic", Self::Quadratic),
        ("vibration_modes", Self::Modes),
        ("vibration_modes_quadratic", Self::QuadraticModes),
        ("segment", Self::Segment),
        ("segment_coarse_to_fine", Self::SegmentByLevels),
        ("parts", Self::Parts),
        ("facet", Self::Facet),
        ("facet_coarse_to_fine", Self::FacetByLevels),
        ("restore", Self::Restore),
        ("fill_holes", Self::FillHoles),
        ("remesh", Self::Remesh),
        ("diffusion_curves", Self::DiffusionCurves),
        ("redraw", Self::Redraw),
        ("trace_curves", Self::Curves),
        ("smooth_curves", Self::Curves),
    ];

    /// Whether columns are kept as they are; otherwise they are computed with in rows of 1, 2, 4, 8 or 16,
    /// which fill vector registers.
    pub(super) const fn has_single_columns(self) -> bool {
        matches!(self, Self::Modes | Self::QuadraticModes)
    }

    /// The name in errors.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, tool)| *tool == self).map_or("the call", |(name, _)| name)
    }

    /// Whether a linear system is solved in it.
    pub(super) const fn solves(self) -> bool {
        self.cost().logarithmic > 0.0 || matches!(self, Self::FillHoles | Self::Parts | Self::SegmentByLevels)
    }

    pub(super) const fn cost(self) -> Cost {
        let (face, logarithmic, column) = match self {
            Self::Mesh => (60.0, 0.0, 0.0),
            Self::Report => (22.0, 0.0, 0.0),
            Self::Hessian => (603.0, 0.0, 0.0),
            Self::Laplacian => (200.0, 0.0, 0.0),
            Self::Energy => (225.0, 0.0, 8.0),
            Self::Delaunay => (63.0, 0.0, 0.0),
            Self::FindHoles => (10.0, 0.0, 0.0),
            Self::Stylize => (1340.0, 43.0, 0.0),
            Self::Denoise => (100.0, 113.0, 115.0),
            Self::Interpolate => (20.0, 140.0, 115.0),
            Self::Quadratic => (670.0, 101.0, 24.0),
            Self::Modes => (1200.0, 55.0, 40.0),
            Self::QuadraticModes => (830.0, 62.0, 30.0),
            Self::Segment => (2000.0, 62.0, 0.0),
            Self::SegmentByLevels => (345.0, 0.0, 0.0),
            Self::Parts => (520.0, 0.0, 0.0),
            Self::Facet => (820.0, 0.0, 0.0),
            Self::FacetByLevels => (580.0, 0.0, 0.0),
            Self::Restore => (2500.0, 77.0, 0.0),
            Self::FillHoles => (2500.0, 0.0, 0.0),
            Self::Remesh => (350.0, 0.0, 0.0),
            Self::DiffusionCurves => (1200.0, 150.0, 0.0),
            Self::Redraw => (1000.0, 60.0, 0.0),
            Self::Curves => (205.0, 0.0, 0.0),
        };
        Cost { face, logarithmic, column }
    }
}

/// Bytes that Clarabel takes for a face and for a column of values,
/// with the factorization of its larger matrix.
pub(super) const CLARABEL: Cost = Cost { face: 4600.0, logarithmic: 100.0, column: 7200.0 };

/// Parts are divided on so many faces or clusters of them at most, which take so many bytes each.
pub(super) const DIVIDED: (f64, f64) = (4500.0, 1300.0);

/// What segments and facets on a coarser mesh take beside its faces.
pub(super) const ON_COARSER: [f64; 2] = [36e6, 9e6];

/// The vertices from which there is a coarser mesh.
pub(super) const COARSER: usize = 18_000;

/// Bytes for a vertex without faces, in every array that has an entry for each vertex: where a linear system
/// is solved, and elsewhere.
pub(super) const LOOSE: [f64; 2] = [400.0, 40.0];
