//! What making facets gives.

use std::sync::Arc;

use super::coarse::Coarse;
use super::keeping::KeptTriangles;
use super::merging::Merges;
use crate::mesh::vector::Point;
use crate::solve::Status;
use crate::Result;

/// A mesh made of facets.
#[derive(Debug, Clone, PartialEq)]
pub struct Faceted {
    /// The corners of the facets, and the vertices of faces that were to stay.
    pub vertices: Vec<Point>,
    /// The vertex of the mesh where each vertex comes from.
    pub origins: Vec<u32>,
    /// The facets as simple polygons, counterclockwise seen from outside; one with holes is several.
    pub polygons: Vec<Vec<u32>>,
    /// The facet of each polygon.
    pub polygon_facets: Vec<u32>,
    /// The facets as triangles.
    pub faces: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub face_facets: Vec<u32>,
    /// The facet nearest to each face of the mesh; −1 for faces that name a vertex twice.
    pub labels: Vec<i32>,
    /// The plane of each facet: its unit normal and its distance from the origin along that.
    pub planes: Vec<[f64; 4]>,
    /// How many facets were made; further ones are faces that stayed.
    pub n_facets: usize,
    /// Root mean square distance from the faces of the mesh to the facets.
    pub rms: f64,
    /// The largest distance from the middle of a face.
    pub largest: f64,
    /// Pairs of facets that pass through each other, and do not on the mesh.
    pub n_crossings: usize,
    /// The mesh's own triangles on the facets, where they were asked for.
    pub kept: Option<KeptTriangles>,
    /// `Solved`, or `Stopped` if the caller asked to finish early.
    pub status: Status,
    /// What other numbers of facets start from.
    pub merges: FacetMerges,
}

/// The order in which faces were merged: with it other numbers of facets are quick,
/// and nested where they start.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FacetMerges {
    pub(super) merges: Merges,
    /// The mesh whose faces were merged, where that is a coarser one.
    pub(super) coarse: Option<Arc<Coarse>>,
}

impl FacetMerges {
    /// The same.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn twin(&self) -> Result<Self> {
        Ok(Self { merges: self.merges.twin()?, coarse: self.coarse.clone() })
    }
}
