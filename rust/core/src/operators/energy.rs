//! The smoothness energies: ours, and those that Rowe et al. 2024 compare it with, all as rows and weights.

use crate::block_rows::BlockRows;
use crate::mesh::Mesh;
use crate::operators::hessian::assembled;
use crate::operators::hinge::usable_areas;
use crate::operators::vertex_weights::of_vertices;
use crate::operators::{
    curved_hessian_squares, edge_laplacian_rows, laplacian_squares, mixed_hessian_rows,
    mixed_hessian_squares, Dual,
};
use crate::unit::Unit;
use crate::{memory, Error, Result};

/// What to minimize.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Energy {
    /// `E_H = Σ_f A_f ‖H_f u‖` (Rowe et al. 2024, eq. (18)): sharp ridges, intrinsic.
    #[default]
    L1Hessian,
    /// `½ ∫ ‖H_u‖²` with natural boundary conditions, on the coordinates of space (Stein et al. 2018b):
    /// smooth.
    L2Hessian,
    /// `½ ∫ ‖∇du‖² + κ |du|²` with natural boundary conditions, intrinsic (Stein et al. 2020a): smooth.
    L2CurvedHessian,
    /// `½ ∫ |Δu|²` with zero Neumann boundary conditions: smooth, isolines meet the boundary at right angles.
    L2Laplacian,
    /// `Σ |entries|` of the Hessian on the coordinates of space (Stein et al. 2018b): ridges along the axes.
    L1HessianStein2018,
    /// `Σ |edge Laplacian|` (He and Schaefer 2013): ridges along mesh edges.
    L1EdgeLaplacian,
}

impl Energy {
    /// Every energy with the name that users see.
    pub const ALL: [(&'static str, Self); 6] = [
        ("l1_hessian", Self::L1Hessian),
        ("l2_hessian", Self::L2Hessian),
        ("l2_curved_hessian", Self::L2CurvedHessian),
        ("l2_laplacian", Self::L2Laplacian),
        ("l1_hessian_stein2018", Self::L1HessianStein2018),
        ("l1_edge_laplacian", Self::L1EdgeLaplacian),
    ];

    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, energy)| *energy == self).map_or("", |(name, _)| name)
    }

    /// Whether it is a sum of squares, minimized by one linear system.
    #[must_use]
    pub fn is_quadratic(self) -> bool {
        matches!(self, Self::L2Hessian | Self::L2CurvedHessian | Self::L2Laplacian)
    }

    /// The unit of the energy where lengths and values are measured in those given.
    #[must_use]
    pub fn unit(self, length: Unit, value: Unit) -> Unit {
        if self.is_quadratic() {
            value.power(2).times(length.power(-2))
        } else {
            value
        }
    }

    /// Whether it needs vertex positions, not only edge lengths.
    #[must_use]
    pub fn is_extrinsic(self) -> bool {
        matches!(self, Self::L2Hessian | Self::L1HessianStein2018)
    }
}

/// An energy on a mesh: `Σ_b w_b ‖(H u)_b‖`, or `½ Σ_b w_b ‖(H u)_b‖²` where it is quadratic.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyForm {
    /// `H`.
    pub operator: BlockRows,
    /// `w`, one per block; at least 0 but for [`Energy::L2CurvedHessian`].
    pub weights: Vec<f64>,
    /// Which energy it is.
    pub energy: Energy,
}

impl EnergyForm {
    /// The rows and weights of `energy` on `mesh`.
    ///
    /// `face_weights` scale the energy of each face; a block that belongs to an edge or a vertex takes the
    /// mean of its faces' weights, by area at a vertex. `dual` is that of [`Energy::L1Hessian`]; the others
    /// have no dual edges.
    ///
    /// # Errors
    /// [`Error::Argument`] for another dual than the default where there is none, or face weights of the
    /// wrong length; [`crate::error::MeshError`] for a zero circumcentric dual edge, missing positions, or a
    /// mesh without any block.
    pub fn new(energy: Energy, mesh: &Mesh, face_weights: Option<&[f64]>, dual: Dual) -> Result<Self> {
        let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
        if energy != Energy::L1Hessian && dual != Dual::default() {
            let problem =
                format!("the energy {} has no dual edges; leave dual at its default", energy.name());
            return Err(Error::argument("dual", problem));
        }
        if let Some(found) = face_weights.map(<[f64]>::len).filter(|found| *found != connectivity.n_faces()) {
            let problem = format!("has {found} entries, expected one per face: {}", connectivity.n_faces());
            return Err(Error::argument("face_weights", problem));
        }
        let at_vertices = || face_weights.map(|w| of_vertices(connectivity, &usable_areas(lengths), w));
        let (operator, weights) = match energy {
            Energy::L1Hessian => (assembled(mesh, dual)?, face_weights.map(memory::twin).transpose()?),
            Energy::L2CurvedHessian => {
                let (rows, weights) = curved_hessian_squares(mesh, face_weights);
                (rows, Some(weights))
            }
            Energy::L2Laplacian => (laplacian_squares(connectivity, lengths)?, at_vertices()),
            Energy::L2Hessian | Energy::L1HessianStein2018 => {
                let make =
                    if energy == Energy::L2Hessian { mixed_hessian_squares } else { mixed_hessian_rows };
                let (rows, vertices) = make(mesh)?;
                let weights = at_vertices().map(|w| vertices.iter().map(|&v| w[v as usize]).collect());
                (rows, weights)
            }
            Energy::L1EdgeLaplacian => {
                let (rows, faces) = edge_laplacian_rows(mesh);
                let weights = face_weights.map(|w| faces.iter().map(|&[f, g]| 0.5 * (w[f] + w[g])).collect());
                (rows, weights)
            }
        };
        let weights = match weights {
            Some(weights) => weights,
            None => memory::repeated(1.0, operator.n_blocks())?,
        };
        Ok(Self { operator, weights, energy })
    }

    /// The energy of `values` (column-major, a row a vertex): one norm a block over all columns, or the sum
    /// of the columns' energies where it is quadratic. For [`Energy::L1Hessian`]: Rowe et al. 2024, eq. (18).
    ///
    /// # Errors
    /// [`Error::Argument`] if `values` are not whole columns.
    pub fn evaluate(&self, values: &[f64]) -> Result<f64> {
        let squares = self.operator.block_squares(values)?;
        let terms = squares.iter().zip(&self.weights);
        if self.energy.is_quadratic() {
            Ok(terms.map(|(square, weight)| 0.5 * weight * square).sum())
        } else {
            Ok(terms.map(|(square, weight)| weight * square.sqrt()).sum())
        }
    }
}

/// The energy of `values` on `mesh`, both of any size:
/// [`EnergyForm::new`] and [`EnergyForm::evaluate`] in their own units.
///
/// # Errors
/// Those of both, and [`crate::error::SolveError::NoNumber`].
pub fn energy(
    kind: Energy,
    mesh: &Mesh,
    values: &[f64],
    face_weights: Option<&[f64]>,
    dual: Dual,
) -> Result<f64> {
    let (length, value) = (mesh.unit(), Unit::of(values.iter().copied()));
    let form = EnergyForm::new(kind, mesh.measured(length)?.as_ref(), face_weights, dual)?;
    kind.unit(length, value).restore_finite("the energy", form.evaluate(&value.measure_all(values))?)
}
