//! What a run of a solver on a reduced problem found.

use crate::solve::cones::Block;
use crate::solve::problem::Status;

/// What a finished run leaves to the next, similar problem,
/// in units that survive new weights and a new operator.
#[derive(Debug, Clone)]
pub struct Warm<const K: usize> {
    /// The split variable.
    pub z: Vec<Block<K>>,
    /// The multipliers, divided by the weights.
    pub p: Vec<Block<K>>,
    /// The typical length of `(H u + c)_b` and `z_b`.
    pub length: Vec<f64>,
}

/// The result of a run, free rows only.
#[derive(Debug)]
pub struct Outcome<const K: usize> {
    /// The best point found.
    pub u: Vec<[f64; K]>,
    /// Its objective.
    pub primal: f64,
    /// The best lower bound found.
    pub dual: f64,
    /// What counts as an objective of zero, see [`crate::solve::Reduced::floor`].
    pub floor: f64,
    /// Iterations made.
    pub iterations: usize,
    /// Why it stopped.
    pub status: Status,
    /// For the next problem, from solvers that can use it.
    pub warm: Option<Warm<K>>,
}
