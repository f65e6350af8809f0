//! What restoring is asked, and what it answers.

use crate::mesh::Mesh;
use crate::surfaces::Surface;
use crate::tools::options::{check_faces, check_fixed, check_positive, check_range};
use crate::tools::SolveOptions;
use crate::Result;

/// How to restore.
#[derive(Debug, Clone)]
pub struct RestoreOptions {
    /// How far a vertex may move at most, in the mesh's unit; where `None` four standard deviations of the
    /// noise and half a mean edge. Vertices that would have to move farther go onto fewer of their surfaces,
    /// or stay.
    pub max_move: Option<f64>,
    /// Standard deviation of the noise along the normal, in the mesh's unit and less than its size; found in
    /// the mesh where `None`.
    pub noise: Option<f64>,
    /// Degrees up to which directions count as parallel or orthogonal and are made so, and radii as equal in
    /// proportion. `None`: surfaces stay as they were fitted.
    pub regularize: Option<f64>,
    /// Whether pieces of no known kind are denoised by the flow; otherwise they stay.
    pub free: bool,
    /// Vertices that do not move.
    pub fixed: Option<Vec<bool>>,
    /// The faces to restore; all where `None`. Vertices of others do not move.
    pub faces: Option<Vec<bool>>,
    /// The solver of segments and flow.
    pub solve: SolveOptions,
}

impl Default for RestoreOptions {
    fn default() -> Self {
        Self {
            max_move: None,
            noise: None,
            regularize: None,
            free: true,
            fixed: None,
            faces: None,
            solve: SolveOptions::default(),
        }
    }
}

/// How restoring ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RestoreStatus {
    /// Vertices are on their surfaces.
    Restored,
    /// No piece is sure to be a surface of a known kind: nothing moved.
    Unsure,
    /// The caller asked to finish early.
    Stopped,
}

impl RestoreStatus {
    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Restored => "restored",
            Self::Unsure => "unsure",
            Self::Stopped => "stopped",
        }
    }
}

/// A piece of the mesh and the surface that it lies on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestoredSurface {
    /// The surface; `None` of free pieces.
    pub surface: Option<Surface>,
    /// Whether the faces look to the side on which the surface's distance is negative, as in a bore.
    pub is_inside_out: bool,
    /// Root mean square distance of the piece's vertices, as they came, from the surface.
    pub rms: f64,
    /// How many faces it has.
    pub n_faces: usize,
}

/// What came out of restoring.
#[derive(Debug, Clone, PartialEq)]
pub struct Restored {
    /// The vertices, as many and in the order of the input.
    pub vertices: Vec<[f64; 3]>,
    /// Index of the piece of each face, −1 for faces that took no part.
    pub labels: Vec<i32>,
    /// The pieces.
    pub surfaces: Vec<RestoredSurface>,
    /// Standard deviation of the noise along the normal that was reckoned with.
    pub noise: f64,
    /// What was made parallel, orthogonal or equal, in words.
    pub relations: Vec<String>,
    /// Vertices that would have had to move too far and are on fewer surfaces than their faces are,
    /// or where they were.
    pub n_held: usize,
    /// Faces that are still folded over their surface.
    pub n_folded: usize,
    /// How it ended.
    pub status: RestoreStatus,
}

impl RestoreOptions {
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        let (n, m) = (mesh.connectivity().n_vertices(), mesh.connectivity().n_faces());
        for (name, value) in [("max_move", self.max_move), ("noise", self.noise)] {
            check_positive(name, value, "it must be a positive length, or None")?;
        }
        if let Some(degrees) = self.regularize {
            check_range("regularize", degrees, 0.0, 30.0)?;
        }
        check_faces(self.faces.as_deref(), m)?;
        self.solve.settings()?;
        check_fixed(self.fixed.as_deref(), n)
    }

    /// Segments stop on residuals, which is enough for them.
    pub(super) fn segment_solve(&self) -> SolveOptions {
        self.solve.within().on_residuals()
    }
}
