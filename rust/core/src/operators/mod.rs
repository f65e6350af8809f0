//! The discrete operators, all from edge lengths.

mod dual;
pub mod factors;
mod hessian;
mod laplacian;
mod mass;
mod mollification;

pub use hessian::{energy, hessian, hessian_norm, HessianPattern};
pub use laplacian::cotangent_laplacian;
pub use mass::voronoi_mass;
pub use mollification::{mollify, MOLLIFICATION_MARGIN};

/// Which centres the dual edges join.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dual {
    /// Barycentres: the paper's choice, defined on every mesh.
    #[default]
    Barycentric,
    /// Circumcentres: the dual edge is normal to its edge, but may have no length.
    Circumcentric,
}
