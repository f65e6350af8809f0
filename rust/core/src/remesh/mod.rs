//! Changing the triangles of a surface but not its shape.
//!
//! [`EditableMesh`] is the mesh that the passes work on; [`guard`] says which edits keep the surface unfolded.

pub mod editable;
pub mod guard;

pub use editable::{Edge, EditableMesh, Wings};
