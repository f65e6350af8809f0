//! Changing the triangles of a surface but not its shape.
//!
//! [`EditableMesh`] is the mesh under edit, [`guard`] says which edits keep it unfolded; [`remesh`] is
//! isotropic remeshing [Botsch and Kobbelt 2004], with a file for each of its passes.

pub(crate) mod budget;
pub mod closest;
mod collapse;
pub(crate) mod crossings;
pub(crate) mod curves;
mod edge;
pub mod editable;
mod fans;
mod flips;
pub mod guard;
pub(crate) mod isotropic;
mod operations;
mod relax;
pub(crate) mod remesher;
mod repair;
mod rings;
pub(crate) mod sizing;
pub(crate) mod split;

pub use editable::{key, Edge, EditableMesh, Wings};
pub use isotropic::{remesh, RemeshOptions, Remeshed};
pub use rings::Rings;
