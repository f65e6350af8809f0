//! Denoising of functions on a surface (Rowe et al. 2024, eqs. (21) and (23)).

use super::scalar::{ScalarOptions, ScalarProblem};
use crate::linear::Columns;
use crate::memory;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::solve::Solution;
use crate::tools::options::{check_fixed, check_positive};
use crate::Result;

/// How to denoise.
#[derive(Debug, Clone)]
pub struct DenoiseOptions {
    /// `α`: how close to stay to the data.
    pub fidelity: f64,
    /// Vertices that keep their values.
    pub fixed: Option<Vec<bool>>,
    /// The energy and everything else.
    pub scalar: ScalarOptions,
}

impl Default for DenoiseOptions {
    fn default() -> Self {
        Self { fidelity: 1.0, fixed: None, scalar: ScalarOptions::default() }
    }
}

/// `min_u E(u) + α (u − u₀)ᵀ M (u − u₀)`, for the columns of `values` (n × k) on the vertices, with the
/// energy `E` of the options and the Voronoi mass `M`.
///
/// Source: Rowe et al. 2024, eq. (23).
///
/// # Errors
/// Arguments of the wrong shape or range, a fidelity that is not positive, an energy that the mesh does not
/// have, and the errors of [`crate::solve::solve`].
pub fn denoise(
    mesh: &Mesh,
    values: &Columns,
    options: &DenoiseOptions,
    progress: &Progress,
) -> Result<Solution> {
    check_positive("fidelity", options.fidelity, "it must be positive")?;
    let n = mesh.connectivity().n_vertices();
    values.check("values", n)?;
    check_fixed(options.fixed.as_deref(), n)?;
    let fixed = options.fixed.clone().unwrap_or_else(|| vec![false; n]);
    let data = memory::copied("values", &values.data)?;
    let target = Columns { n_rows: values.n_rows, n_columns: values.n_columns, data };
    let problem = ScalarProblem { mesh, options: &options.scalar, fidelity: options.fidelity, target, fixed };
    problem.run(progress)
}
