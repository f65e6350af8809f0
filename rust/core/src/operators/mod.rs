//! The discrete operators, all from edge lengths.

mod curved_hessian;
mod dual;
mod edge_laplacian;
mod energy;
mod face_laplacian;
#[cfg(test)]
mod factors;
mod hessian;
mod hinge;
mod laplacian;
mod mass;
mod mixed_hessian;
mod mollification;
mod vertex_weights;

pub use curved_hessian::curved_hessian_squares;
pub use edge_laplacian::edge_laplacian_rows;
pub use energy::{energy, Energy, EnergyForm};
pub use face_laplacian::face_laplacian_weights;
pub use hessian::{hessian, hessian_norm, HessianPattern};
pub(crate) use hinge::Hinge;
pub use laplacian::{cotangent_laplacian, laplacian_squares};
pub use mass::{mass_of, voronoi_mass};
pub use mixed_hessian::{mixed_hessian_rows, mixed_hessian_squares};
pub use mollification::{mollify, MOLLIFICATION_MARGIN};

/// Which centers the dual edges join.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dual {
    /// Barycenters: the paper's choice, defined on every mesh.
    #[default]
    Barycentric,
    /// Circumcenters: the dual edge is normal to its edge, but may have no length, which is an error.
    Circumcentric,
    /// Circumcenters, but barycenters for the dual edges that would have no length.
    CircumcentricOrBarycentric,
}
