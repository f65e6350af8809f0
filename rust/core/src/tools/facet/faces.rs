//! The faces of the mesh, and the facet that each belongs to.

use std::collections::HashSet;

use super::borders::Borders;
use super::constants::LITTLE;
use super::crossings::Standing;
use super::moments::Moments;
use super::shape::{Facet, Shape};
use crate::memory;
use crate::mesh::vector::{area_vector, between, centroid, distance, norm, Point};
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
    /// Sides that more than one face has, from vertex to vertex, sorted.
    doubled: Vec<[u32; 2]>,
    tree: ClosestPoint,
    /// What faces change sides by, where facets are to be regions of the mesh to the end.
    pub borders: Option<Borders>,
}

impl Scan {
    /// Faces by their vertices and places.
    pub(super) fn new(faces: &[[u32; 3]], places: Vec<[Point; 3]>, borders: Option<Borders>) -> Result<Self> {
        let moments = memory::gathered(places.iter().map(|&corners| Moments::of(corners)))?;
        Ok(Self {
            centers: memory::gathered(places.iter().map(|&corners| centroid(corners)))?,
            area: moments.iter().map(|m| m.area).sum(),
            standing: Standing::new(faces, &places)?,
            doubled: doubled(faces)?,
            tree: ClosestPoint::new(memory::twin(&places)?)?,
            moments,
            places,
            borders,
        })
    }

    /// Whether more than one face has a side, from vertex to vertex.
    pub(super) fn is_doubled(&self, side: [u32; 2]) -> bool {
        self.doubled.binary_search(&side).is_ok()
    }

    /// The point of the mesh nearest to another.
    pub(super) fn on_mesh(&self, point: Point) -> Point {
        self.tree.closest(point, None, |_| true).map_or(point, |near| near.point)
    }

    /// The integral of the squared distance of a triangle from the mesh, by the rule of three points, exact
    /// for squares.
    pub(super) fn off_mesh(&self, corners: [Point; 3]) -> f64 {
        let middle = centroid(corners);
        let points = corners.map(|corner| between(middle, corner, 0.5));
        let squares = points.map(|p| distance(p, self.on_mesh(p)).powi(2));
        norm(area_vector(corners)) / 3.0 * squares.iter().sum::<f64>()
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
    /// Facets with faces that pass through others of their piece on the mesh, and those that share a corner
    /// with one of them: where larger facets pass is beside where the faces did.
    pub(super) fn standing(&self, shape: &Shape) -> Result<HashSet<u32>> {
        let passing = self.scan.standing.labels(&self.labels)?;
        let of_passing = |(k, _): &(u32, &Facet)| passing.contains(k);
        let facets = || (0..).zip(&shape.facets);
        let corners: HashSet<u32> =
            memory::distinct(facets().filter(of_passing).flat_map(|(_, facet)| facet.corners()))?;
        let is_beside = |(_, facet): &(u32, &Facet)| facet.corners().any(|c| corners.contains(&c));
        Ok(memory::distinct(facets().filter(is_beside).map(|(k, _)| k))?)
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

/// The sides that more than one of the faces has, sorted.
fn doubled(faces: &[[u32; 3]]) -> Result<Vec<[u32; 2]>> {
    let mut all: Vec<[u32; 2]> =
        memory::sifted(faces.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]))?;
    all.sort_unstable();
    Ok(memory::sifted(all.chunk_by(|a, b| a == b).filter(|group| group.len() > 1).map(|group| group[0]))?)
}
