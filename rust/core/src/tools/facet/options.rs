//! How to make facets.

use crate::mesh::Mesh;
use crate::tools::options::{check_edge_weights, check_faces, check_positive, Levels, SolveOptions};
use crate::{Error, Result};

/// What a mesh is symmetric across: the plane across an axis of coordinates through the origin, or through
/// the middle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symmetric {
    /// The axis: 0, 1 or 2.
    Across(usize),
    /// The first axis that it is symmetric across.
    Found,
}

/// How to make facets.
#[derive(Debug, Clone, Default)]
pub struct FacetOptions {
    /// How many facets are wanted.
    pub facets: Option<usize>,
    /// The root mean square distance of the faces from the facets that is allowed, in the unit of the mesh,
    /// where `facets` is `None`. Where both are: as many as the faces give evidence for (Bayesian information
    /// criterion, Schwarz 1978), at most as many as it takes for every facet to be within half a percent of
    /// the diagonal of the bounding box.
    pub error: Option<f64>,
    /// What borders of facets cost along each edge, one row a face, column `i` opposite corner `i`; smaller
    /// attracts them. The entry of either face counts.
    pub edge_weights: Option<Vec<[f64; 3]>>,
    /// The faces to make facets of, all where `None`; the others, and all vertices of theirs, stay.
    pub faces: Option<Vec<bool>>,
    /// Whether the mesh's own triangles are to be kept on the facets, each of which is then a region of the
    /// mesh.
    pub keep_triangles: bool,
    /// Whether the facets are to enclose the volume that the mesh does, which must be closed.
    pub keep_volume: bool,
    /// Whether the facets of a mesh that is symmetric are to be so, and how.
    pub symmetric: Option<Symmetric>,
    /// Whether the facets of a large mesh are found on a coarser one: not where faces stay, borders cost
    /// something, triangles or the volume are kept, or the shape is to be symmetric.
    pub levels: Levels,
    /// Threads to use; all where `None`. The result does not depend on it.
    pub threads: Option<usize>,
}

impl FacetOptions {
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        let m = mesh.connectivity().n_faces();
        if self.facets == Some(0) {
            return Err(Error::argument("facets", "is 0; ask for at least one facet"));
        }
        check_positive("error", self.error, "it must be positive, a distance")?;
        self.solve().settings()?;
        check_edge_weights(self.edge_weights.as_deref(), m)?;
        check_faces(self.faces.as_deref(), m)?;
        let others = [
            ("faces", self.faces.is_some()),
            ("keep_triangles", self.keep_triangles),
            ("keep_volume", self.keep_volume),
        ];
        match others.into_iter().find(|(_, given)| self.symmetric.is_some() && *given) {
            Some((other, _)) => Err(Error::argument("symmetric", format!("does not go with {other}"))),
            None => Ok(()),
        }
    }

    /// Whether the facets of a mesh with so many vertices are found on one with `enough` of them.
    pub(super) fn use_levels(&self, n_vertices: usize, enough: usize) -> bool {
        let is_plain = self.edge_weights.is_none() && self.faces.is_none() && self.symmetric.is_none();
        let is_suited = is_plain && !self.keep_triangles && !self.keep_volume;
        is_suited && self.levels.are_used(n_vertices, enough, true)
    }

    /// The threads, checked where they are started.
    pub(super) fn solve(&self) -> SolveOptions {
        SolveOptions { threads: self.threads, ..SolveOptions::default() }
    }
}
