//! The faces of the mesh, and the facet that each belongs to.

use std::collections::HashSet;

use super::constants::LITTLE;
use super::crossings::Standing;
use super::moments::Moments;
use super::shape::Shape;
use crate::memory;
use crate::mesh::vector::{centroid, Point};
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// The faces of a mesh: what does not change however they are shared out.
#[derive(Debug)]
pub(super) struct Scan {
    pub places: Vec<[Point; 3]>,
    pub centers: Vec<Point>,
    pub moments: Vec<Moments>,
    pub area: f64,
    pub standing: Standing,
    tree: ClosestPoint,
}

impl Scan {
    /// Faces by their vertices and places.
    pub(super) fn new(faces: &[[u32; 3]], places: Vec<[Point; 3]>) -> Result<Self> {
        let moments = memory::gathered(places.iter().map(|&corners| Moments::of(corners)))?;
        Ok(Self {
            centers: memory::gathered(places.iter().map(|&corners| centroid(corners)))?,
            area: moments.iter().map(|m| m.area).sum(),
            standing: Standing::new(faces, &places)?,
            tree: ClosestPoint::new(memory::twin(&places)?)?,
            moments,
            places,
        })
    }

    /// The point of the mesh nearest to another.
    pub(super) fn on_mesh(&self, point: Point) -> Point {
        self.tree.closest(point, None, |_| true).map_or(point, |near| near.point)
    }

    /// The integrals over the faces of each of `n` labels.
    pub(super) fn sums(&self, labels: &[u32], n: usize) -> Result<Vec<Moments>> {
        let mut sums = memory::repeated(Moments::default(), n)?;
        for (&label, moments) in labels.iter().zip(&self.moments) {
            sums[label as usize] = sums[label as usize].plus(moments);
        }
        Ok(sums)
    }
}

/// The faces of a mesh, shared out among facets.
#[derive(Debug)]
pub(super) struct Faces<'s> {
    pub scan: &'s Scan,
    pub labels: Vec<u32>,
    /// Whether each stays as it is: a facet of its own.
    pub is_held: Vec<bool>,
}

impl Faces<'_> {
    /// Facets with faces that pass through others of their piece on the mesh.
    pub(super) fn standing(&self) -> Result<HashSet<u32>> {
        self.scan.standing.labels(&self.labels)
    }

    /// Gives every facet the integrals over its faces; over its polygon where they are too few.
    pub(super) fn fit(&self, shape: &mut Shape) -> Result<()> {
        for (k, sum) in self.scan.sums(&self.labels, shape.facets.len())?.into_iter().enumerate() {
            let own = shape.polygon_moments(&shape.facets[k]);
            shape.facets[k].moments = if sum.area > LITTLE * own.area { sum } else { own };
        }
        Ok(())
    }
}
