//! The faces of the mesh, and the facet that each belongs to.

use rayon::prelude::*;

use super::constants::LITTLE;
use super::faults::Inspection;
use super::moments::Moments;
use super::shape::Shape;
use crate::memory;
use crate::mesh::vector::{area_vector, centroid, distance, dot, Point};
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// The faces of a mesh, shared out among facets.
#[derive(Debug)]
pub(super) struct Faces {
    places: Vec<[Point; 3]>,
    pub centers: Vec<Point>,
    pub moments: Vec<Moments>,
    pub labels: Vec<u32>,
    /// Whether each stays as it is: a facet of its own.
    is_held: Vec<bool>,
    area: f64,
    tree: ClosestPoint,
}

/// How far faces are from a surface of facets.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Distances {
    /// Root of the mean square over the area.
    pub rms: f64,
    /// The largest of a center.
    pub largest: f64,
}

impl Faces {
    /// The faces with these places, each of the facet `labels` names.
    pub(super) fn new(places: Vec<[Point; 3]>, labels: Vec<u32>, is_held: Vec<bool>) -> Result<Self> {
        let moments = memory::gathered(places.iter().map(|&corners| Moments::of(corners)))?;
        let area = moments.iter().map(|m| m.area).sum();
        let tree = ClosestPoint::new(memory::twin(&places)?)?;
        Ok(Self {
            centers: memory::gathered(places.iter().map(|&corners| centroid(corners)))?,
            places,
            moments,
            labels,
            is_held,
            area,
            tree,
        })
    }

    /// The point of the mesh nearest to another.
    pub(super) fn on_mesh(&self, point: Point) -> Point {
        self.tree.closest(point, None, |_| true).map_or(point, |near| near.point)
    }

    /// Gives every facet the integrals over its faces; over its polygon where they are too few.
    pub(super) fn fit(&self, shape: &mut Shape) {
        let mut sums = vec![Moments::default(); shape.facets.len()];
        for (&label, moments) in self.labels.iter().zip(&self.moments) {
            sums[label as usize] = sums[label as usize].plus(moments);
        }
        for (k, sum) in sums.into_iter().enumerate() {
            let own = shape.polygon_moments(&shape.facets[k]);
            shape.facets[k].moments = if sum.area > LITTLE * own.area { sum } else { own };
        }
    }

    /// The facet nearest to each face among those that look to the same side, and how far the surface is. A
    /// face that noise has turned over looks at the far side of the shape: where the facet found is farther
    /// than the surface by more than the face is long, it stays with its own.
    pub(super) fn nearest(&self, shape: &Shape, inspection: &Inspection) -> Result<(Vec<u32>, Distances)> {
        let tree = ClosestPoint::new(inspection.places(shape)?)?;
        let is_like = |k: u32, normal: Point| {
            let facet = &shape.facets[k as usize];
            !facet.is_held && dot(facet.plane.normal, normal) > 0.0
        };
        let found = memory::joined(self.places.par_iter().enumerate().map(|(f, &corners)| {
            if self.is_held[f] {
                return (self.labels[f], 0.0);
            }
            let normal = area_vector(corners);
            let center = self.centers[f];
            let accept = |t: u32| is_like(inspection.owners[t as usize], normal);
            let near = tree.closest(center, None, accept);
            let guess = near.as_ref().map(|near| near.triangle);
            let squared = tree.closest(center, guess, |_| true).map_or(0.0, |nearest| nearest.squared);
            let long = (0..3).map(|i| distance(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max);
            let beside = near.filter(|near| near.squared.sqrt() <= squared.sqrt() + long);
            let label = beside.map_or(self.labels[f], |near| inspection.owners[near.triangle as usize]);
            (label, squared)
        }))?;
        let squares: f64 = found.iter().zip(&self.moments).map(|((_, squared), m)| squared * m.area).sum();
        let largest = found.iter().map(|(_, squared)| squared.sqrt()).fold(0.0, f64::max);
        let rms = (squares / self.area.max(f64::MIN_POSITIVE)).sqrt();
        let labels = memory::gathered(found.into_iter().map(|(label, _)| label))?;
        Ok((labels, Distances { rms, largest }))
    }
}
