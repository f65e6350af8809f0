//! Where each vertex of a mesh lies on a coarser one.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::buckets::Buckets;
use crate::error::MeshError;
use crate::mesh::vector::{add, area_vector, dot, scale, sub, Point};
use crate::mesh::Mesh;
use crate::remesh::closest::{closest_on_triangle, ClosestPoint};
use crate::remesh::editable::HUB;
use crate::{memory, Progress, Result};

/// Vertices between two looks at whether to go on: some hundredths of a second.
const AT_ONCE: usize = 1 << 15;

/// For every vertex of a fine mesh that is not held a point of a coarser one: three of its vertices with
/// weights that sum to one.
#[derive(Debug, Clone)]
pub struct Carry {
    places: Vec<Option<Place>>,
}

/// A point of the coarser mesh.
#[derive(Debug, Clone, Copy)]
struct Place {
    face: u32,
    corners: [u32; 3],
    weights: [f64; 3],
}

impl Carry {
    /// The closest points around the vertices that the fine ones collapsed into: the surface is walked from
    /// there to ever closer faces, so that no point is found across a gap or on the other side of a sheet.
    ///
    /// # Errors
    /// [`MeshError::NoPositions`], [`crate::Error::Cancelled`]; [`crate::Error::Solve`] where memory is
    /// missing, here and below.
    pub(super) fn new(
        fine: &[Point],
        parents: &[u32],
        is_held: &[bool],
        coarse: &Mesh,
        progress: &Progress,
    ) -> Result<Self> {
        let points = coarse.positions().ok_or(MeshError::NoPositions)?;
        let faces = coarse.connectivity().faces();
        let around = Buckets::new(points.len(), |visit| {
            for (f, face) in (0_u32..).zip(faces) {
                face.iter().for_each(|&v| visit(v as usize, f));
            }
        })?;
        let corners = |f: u32| faces[f as usize].map(|v| points[v as usize]);
        // Where thousands of faces meet, every vertex around would look at all of them.
        let mut trees: BTreeMap<u32, ClosestPoint> = BTreeMap::new();
        for v in (0..points.len()).filter(|&v| around.of(v).len() > HUB) {
            let own = memory::gathered(around.of(v).iter().map(|&f| corners(f)))?;
            trees.insert(v as u32, ClosestPoint::new(own)?);
        }
        let place = |p: Point, parent: u32| {
            let mut best: Option<(f64, u32, Point)> = None;
            let (mut known, mut from): ([u32; 3], &[u32]) = ([u32::MAX; 3], &[parent]);
            loop {
                let before = best.map_or(u32::MAX, |found| found.1);
                let mut compare = |f: u32, point: Point| {
                    let distance = squared(p, point);
                    if best.is_none_or(|found| distance < found.0) {
                        best = Some((distance, f, point));
                    }
                };
                for &v in from.iter().filter(|v| !known.contains(v)) {
                    let own = around.of(v as usize);
                    match trees.get(&v).map(|tree| tree.closest(p, None, |_| true)) {
                        Some(near) => {
                            near.iter().for_each(|near| compare(own[near.triangle as usize], near.point))
                        }
                        None => own.iter().for_each(|&f| compare(f, closest_on_triangle(p, corners(f)))),
                    }
                }
                let (_, f, point) = best?;
                if f == before {
                    let weights = weights(corners(f), point);
                    return Some(Place { face: f, corners: faces[f as usize], weights });
                }
                known = std::array::from_fn(|k| from.get(k).copied().unwrap_or(u32::MAX));
                from = &faces[f as usize];
            }
        };
        let carried = |v: usize| {
            if is_held[v] || parents[v] == u32::MAX {
                None
            } else {
                place(fine[v], parents[v])
            }
        };
        let mut places = memory::room(fine.len())?;
        for first in (0..fine.len()).step_by(AT_ONCE) {
            progress.check()?;
            let many = first..fine.len().min(first + AT_ONCE);
            places.par_extend(many.into_par_iter().map(carried));
        }
        Ok(Self { places })
    }

    /// For every vertex the coarse face that its point is on, and the weights of that face's corners; nothing
    /// where a vertex is held or has no faces.
    pub fn places(&self) -> impl Iterator<Item = Option<(u32, [f64; 3])>> + '_ {
        self.places.iter().map(|place| place.map(|place| (place.face, place.weights)))
    }

    /// What `coarse` has at the vertices' points; `none` where a vertex is held or has no faces.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn points(&self, coarse: &[Point], none: Point) -> Result<Vec<Point>> {
        let value = |Place { corners, weights, .. }: &Place| {
            (0..3).fold([0.0; 3], |sum, k| add(sum, scale(coarse[corners[k] as usize], weights[k])))
        };
        Ok(memory::joined(self.places.par_iter().map(|place| place.as_ref().map_or(none, value)))?)
    }

    /// For each of the `fine` faces, of the coarse ones that its corners lie on the one that is closest to
    /// its middle; `None` where they lie on none.
    ///
    /// # Errors
    /// [`MeshError::NoPositions`]; [`crate::Error::Solve`] where memory is missing, here and below.
    pub fn faces(&self, fine: &Mesh, coarse: &Mesh) -> Result<Vec<Option<u32>>> {
        let positions = fine.positions().ok_or(MeshError::NoPositions)?;
        let points = coarse.positions().ok_or(MeshError::NoPositions)?;
        let corners = coarse.connectivity().faces();
        let closest = |face: &[u32; 3]| {
            let sum = face.iter().fold([0.0; 3], |sum, &v| add(sum, positions[v as usize]));
            let middle = scale(sum, 1.0 / 3.0);
            let away = |f: u32| {
                let corners = corners[f as usize].map(|v| points[v as usize]);
                squared(middle, closest_on_triangle(middle, corners))
            };
            let found = face.iter().filter_map(|&v| self.places[v as usize]).map(|place| place.face);
            found.min_by(|&f, &g| away(f).total_cmp(&away(g)))
        };
        Ok(memory::joined(fine.connectivity().faces().par_iter().map(closest))?)
    }

    /// The geometric mean of what the faces have that the corners of each of the `fine` faces lie on; 1 where
    /// none does.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn factors(&self, coarse: &[f64], fine: &[[u32; 3]]) -> Result<Vec<f64>> {
        let mean = |face: &[u32; 3]| {
            let places = face.iter().filter_map(|&v| self.places[v as usize]);
            let (sum, count) = places.fold((0.0, 0.0), |(sum, count), place| {
                (sum + coarse[place.face as usize].ln(), count + 1.0)
            });
            if count > 0.0 {
                f64::exp(sum / count)
            } else {
                1.0
            }
        };
        Ok(memory::joined(fine.par_iter().map(mean))?)
    }
}

fn squared(p: Point, q: Point) -> f64 {
    dot(sub(p, q), sub(p, q))
}

/// The weights of the corners at a point of their triangle.
fn weights(corners: [Point; 3], point: Point) -> [f64; 3] {
    let normal = area_vector(corners);
    let square = dot(normal, normal);
    let part = |k: usize| {
        let area = area_vector([point, corners[(k + 1) % 3], corners[(k + 2) % 3]]);
        (dot(area, normal) / square).clamp(0.0, 1.0)
    };
    let found: [f64; 3] = std::array::from_fn(part);
    let sum: f64 = found.iter().sum();
    if square <= 0.0 || !sum.is_normal() {
        // A triangle without area, or with one that is lost in rounding: the closest corner.
        let nearest = (0..3).min_by(|&i, &j| {
            let distance = |k: usize| squared(corners[k], point);
            distance(i).total_cmp(&distance(j))
        });
        return std::array::from_fn(|k| if Some(k) == nearest { 1.0 } else { 0.0 });
    }
    found.map(|weight| weight / sum)
}
