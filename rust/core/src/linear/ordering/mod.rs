//! Orders of rows that leave few entries in a factor.

mod dissection;
mod graph;
mod minimum_degree;
mod postorder;
mod separator;

pub use dissection::nested_dissection;
pub use minimum_degree::minimum_degree;
pub use postorder::postordered;
