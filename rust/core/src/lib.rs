//! The L1 surface Hessian of triangle meshes [Rowe, Jacobson and Stein 2024]: operators, solvers, flows.
//!
//! Read in this order: [`mesh`] → [`operators`] → [`linear`] → [`solve`] → [`surfaces`] → [`tools`].
pub mod block_rows;
mod buckets;
pub mod error;
pub mod hole_filling;
pub mod intrinsic;
pub mod labelling;
pub mod levels;
pub mod limits;
pub mod linear;
pub mod memory;
pub mod mesh;
pub mod operators;
mod ordered;
pub mod progress;
#[doc(hidden)]
pub mod random;
pub mod remesh;
pub mod shape_guard;
#[doc(hidden)]
pub mod shapes;
pub mod solve;
pub mod surfaces;
pub mod threads;
pub mod tools;
pub mod unit;

pub use error::{Error, Result};
pub use progress::Progress;
