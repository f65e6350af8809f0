//! How to find parts.

use super::constants::{COST, EVEN_COST, USUAL_POWER};
use crate::mesh::Mesh;
use crate::tools::options::{check_edge_weights, check_faces, check_positive, check_weights, SolveOptions};
use crate::{tools, Error, Result};

/// How to find parts.
#[derive(Debug, Clone)]
pub struct PartsOptions {
    /// How many parts are wanted; as many as the coarseness makes where `None`.
    pub n_parts: Option<usize>,
    /// How much cheaper cuts must be than is usual, 1: larger finds fewer parts. A cut costs the length of
    /// its border, in hollows down to a tenth of it, over the 0.7th power of the area that it cuts off, both
    /// in units of the whole area; at 1.9 over the coarseness it is as likely as not that people make it, at
    /// less on shapes with hollows everywhere.
    pub coarseness: f64,
    /// What borders cost in each face, 1 neutral, smaller where they are welcome.
    pub face_weights: Option<Vec<f64>>,
    /// What borders cost along each edge, one row a face, column `i` opposite corner `i`; the mean of both
    /// faces' entries counts.
    pub edge_weights: Option<Vec<[f64; 3]>>,
    /// The faces to divide; all where `None`.
    pub faces: Option<Vec<bool>>,
    /// Threads to use; all where `None`. The result does not depend on it.
    pub threads: Option<usize>,
}

impl Default for PartsOptions {
    fn default() -> Self {
        Self {
            n_parts: None,
            coarseness: 1.0,
            face_weights: None,
            edge_weights: None,
            faces: None,
            threads: None,
        }
    }
}

impl PartsOptions {
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        let m = mesh.connectivity().n_faces();
        check_positive("coarseness", self.coarseness, "it must be positive")?;
        if self.n_parts == Some(0) {
            return Err(Error::argument("n_parts", "is 0; ask for at least one part"));
        }
        self.solve().settings()?;
        check_weights("face_weights", self.face_weights.as_ref(), m, "face")?;
        check_edge_weights(self.edge_weights.as_deref(), m)?;
        check_faces(self.faces.as_deref(), m)
    }

    /// Up to which cost cuts are made at first.
    pub(super) fn most_cost(&self) -> f64 {
        COST / self.coarseness
    }

    /// At which cost it is as likely as not that people make a cut of the whole shape, where a border usually
    /// costs that part of its length.
    pub(super) fn even_cost(&self, usual: f64) -> f64 {
        EVEN_COST * usual.powf(USUAL_POWER) / self.coarseness
    }

    /// The threads, checked where they are started.
    pub(super) fn solve(&self) -> SolveOptions {
        SolveOptions { threads: self.threads, ..SolveOptions::default() }
    }

    /// What a border along halfedge `h` costs, by its face's and its own weight.
    pub(super) fn weight(&self, h: usize) -> f64 {
        tools::options::painted_weight(self.edge_weights.as_ref(), self.face_weights.as_ref(), h)
    }
}
