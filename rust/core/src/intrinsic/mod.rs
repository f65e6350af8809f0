//! Intrinsic triangulations: the same surface under other edges.

mod delaunay;

pub use delaunay::{delaunay_flips, delaunay_flips_carrying};
