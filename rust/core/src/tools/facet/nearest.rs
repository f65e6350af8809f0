//! The facet nearest to each face.

use rayon::prelude::*;

use super::faces::Faces;
use super::faults::Inspection;
use super::shape::Shape;
use crate::memory;
use crate::mesh::vector::{area_vector, distance, dot, Point};
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// How far faces are from a surface of facets.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Distances {
    /// Root of the mean square over the area.
    pub rms: f64,
    /// The largest of a center.
    pub largest: f64,
}

impl Faces<'_> {
    /// The facet nearest to each face among those that look to the same side, and how far the surface is. A
    /// face that noise has turned over looks at the far side of the shape: where the facet found is farther
    /// than the surface by more than the face is long, it stays with its own.
    pub(super) fn nearest(&self, shape: &Shape, inspection: &Inspection) -> Result<(Vec<u32>, Distances)> {
        let tree = ClosestPoint::new(inspection.places(shape)?)?;
        let is_like = |k: u32, normal: Point| {
            let facet = &shape.facets[k as usize];
            !facet.is_held && dot(facet.plane.normal, normal) > 0.0
        };
        let found = memory::joined(self.scan.places.par_iter().enumerate().map(|(f, &corners)| {
            if self.is_held[f] {
                return (self.labels[f], 0.0);
            }
            let normal = area_vector(corners);
            let center = self.scan.centers[f];
            let accept = |t: u32| is_like(inspection.owners[t as usize], normal);
            let near = tree.closest(center, None, accept);
            let guess = near.as_ref().map(|near| near.triangle);
            let squared = tree.closest(center, guess, |_| true).map_or(0.0, |nearest| nearest.squared);
            let long = (0..3).map(|i| distance(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max);
            let beside = near.filter(|near| near.squared.sqrt() <= squared.sqrt() + long);
            let label = beside.map_or(self.labels[f], |near| inspection.owners[near.triangle as usize]);
            (label, squared)
        }))?;
        let weighted = found.iter().zip(&self.scan.moments);
        let squares: f64 = weighted.map(|((_, squared), m)| squared * m.area).sum();
        let largest = found.iter().map(|(_, squared)| squared.sqrt()).fold(0.0, f64::max);
        let rms = (squares / self.scan.area.max(f64::MIN_POSITIVE)).sqrt();
        let labels = memory::gathered(found.into_iter().map(|(label, _)| label))?;
        Ok((labels, Distances { rms, largest }))
    }
}
