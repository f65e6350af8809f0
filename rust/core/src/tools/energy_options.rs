//! Which energy, on which triangulation of the surface.

use std::borrow::Cow;

use super::options::check_weights;
use crate::error::MeshError;
use crate::intrinsic::delaunay_flips_carrying;
use crate::mesh::{Mesh, Working};
use crate::operators::{Dual, Energy, EnergyForm};
use crate::solve::Solver;
use crate::{Error, Result};

/// What every problem with an energy can be told about it.
#[derive(Debug, Clone, Default)]
pub struct EnergyOptions {
    /// What to minimize.
    pub kind: Energy,
    /// A weight for each face: smaller where ridges are welcome.
    /// See [`EnergyForm::new`] for energies that do not live on faces.
    pub face_weights: Option<Vec<f64>>,
    /// Dual edges of the operator.
    pub dual: Dual,
    /// Whether to flip edges to the intrinsic Delaunay triangulation first (Rowe et al. 2024, section 6.1);
    /// values stay at the vertices, and face weights are carried over by [`delaunay_flips_carrying`].
    pub delaunay: bool,
}

impl EnergyOptions {
    /// The surface to work on, its faces oriented, and the energy on it.
    ///
    /// # Errors
    /// The errors of [`EnergyForm::new`], face weights that are negative or not finite, flips for an energy
    /// that needs positions, and a mesh on which the energy has no terms.
    pub(super) fn on<'a>(&self, mesh: &'a Mesh) -> Result<(Cow<'a, Mesh>, EnergyForm)> {
        check_weights("face_weights", self.face_weights.as_ref(), mesh.connectivity().n_faces(), "face")?;
        let mesh = Working::unwelded(mesh)?.into_mesh();
        let (mesh, weights) = if self.delaunay {
            if self.kind.is_extrinsic() {
                let problem = format!(
                    "flips edges intrinsically, but {} needs a mesh in space; pass False",
                    self.kind.name()
                );
                return Err(Error::argument("delaunay", problem));
            }
            let mut weights = self.face_weights.clone();
            let carried = weights.as_deref_mut().unwrap_or_default();
            let (connectivity, lengths, _) =
                delaunay_flips_carrying(mesh.connectivity(), mesh.edge_lengths(), carried)?;
            (Cow::Owned(Mesh::from_connectivity(connectivity, lengths)?), weights.map(Cow::Owned))
        } else {
            (mesh, self.face_weights.as_ref().map(Cow::Borrowed))
        };
        let form = EnergyForm::new(self.kind, &mesh, weights.as_deref().map(Vec::as_slice), self.dual)?;
        self.refuse_empty(&form)?;
        Ok((mesh, form))
    }

    /// Refuses an operator without any entry: a mesh of loose or degenerate faces has no energy.
    fn refuse_empty(&self, form: &EnergyForm) -> Result<()> {
        if form.operator.values.iter().any(|v| v.iter().any(|x| *x != 0.0)) {
            return Ok(());
        }
        if self.kind.is_extrinsic() {
            let name = self.kind.name();
            let problem =
                format!("{name} needs vertices inside the surface, and this mesh has none; use another");
            return Err(Error::argument("energy", problem));
        }
        Err(MeshError::NoFaces.into())
    }

    /// Refuses a conic solver for an energy that needs none.
    pub(super) fn check_solver(&self, solver: Solver) -> Result<()> {
        match solver {
            Solver::Auto | Solver::Cholesky => Ok(()),
            _ if !self.kind.is_quadratic() => Ok(()),
            _ => {
                let name = self.kind.name();
                Err(Error::argument(
                    "solver",
                    format!("{name} is quadratic and takes one factorization; use auto"),
                ))
            }
        }
    }
}
