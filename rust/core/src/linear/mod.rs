//! Matrices, and nothing of what they stand for: patterns, orderings, one sparse Cholesky factorization,
//! iterations that need products only.
//!
//! [`cholesky`] analyzes a [`pattern`] in an [`ordering`]; `multifrontal` factors;
//! `triangular` and `subtrees` solve.

pub mod bounded;
pub mod cholesky;
mod columns;
pub mod conjugate_gradients;
mod factor;
mod multifrontal;
pub mod ordering;
pub mod pattern;
mod real;
pub mod small;

mod subtrees;
mod triangular;

pub use columns::Columns;
