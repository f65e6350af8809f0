//! How far a shape is made of planes: the angles at its edges.

use rayon::prelude::*;

use crate::mesh::partition::Partition;
use crate::mesh::{vector, Connectivity};
use crate::tools::scale::extent;
use crate::{memory, Result};

/// Faces that meet at less than this angle lie in one plane to the eye (radians; 2 degrees), where the
/// smallest facet that one would count has room for no more than the two.
///
/// Where it has room for more, they may bend by that much all in all: otherwise a dense mesh of anything
/// round is one plane. Meshes of known spheres are flat nowhere at any density, and what the flow has made
/// flat stays so: the median angle within its facets is below 0.005 degrees on six scans.
const FLAT: f64 = 2.0 / 180.0 * std::f64::consts::PI;

/// How far rounding to single precision moves faces against their neighbors, in parts of the shape's size:
/// 1.2 times its precision at most on flat sheets of known shape.
const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// Edges with less than this angle are soft to the eye, whatever the shading (radians; 20 degrees).
const SOFT: f64 = 20.0 / 180.0 * std::f64::consts::PI;

/// The least part of the area that a facet has which one would count:
/// a sixtieth of the width of a square picture, squared.
const SEEN: f64 = 3e-4;

/// What the angles at the edges of a shape say about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flatness {
    /// The part of the area in faces that lie in one plane with all their neighbors: that meet them at less
    /// than two degrees, and at less where they are smaller than the smallest facet that one would count.
    pub flat_share: f64,
    /// The part of the bend `Σ length · angle` that lies in edges of less than twenty degrees.
    pub soft_share: f64,
    /// The part of the area in planes of two and more such faces.
    pub plane_share: f64,
    /// Planes that have at least 3e-4 of the area: facets that one would count.
    pub n_facets: usize,
}

impl Flatness {
    /// Measures the surface with these faces and `points`. Faces without area take no part.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn of(connectivity: &Connectivity, points: &[[f64; 3]]) -> Result<Self> {
        let faces = connectivity.faces();
        let corners = |f: usize| faces[f].map(|v| points[v as usize]);
        let mut vectors = memory::room(faces.len())?;
        (0..faces.len())
            .into_par_iter()
            .map(|f| vector::area_vector(corners(f)))
            .collect_into_vec(&mut vectors);
        let areas: Vec<f64> = memory::gathered(vectors.iter().map(|&n| vector::norm(n)))?;
        let total: f64 = areas.iter().sum();
        let width = (SEEN * total).sqrt();
        let rounding = ROUNDING * extent(connectivity, points).0;
        let mut is_flat = memory::repeated(true, faces.len())?;
        let mut facets = Partition::new(faces.len())?;
        let (mut bend, mut soft) = (0.0, 0.0);
        for h in connectivity.edges() {
            let Some(mate) = connectivity.mate(h) else { continue };
            let (f, g) = (h / 3, mate / 3);
            if areas[f] <= 0.0 || areas[g] <= 0.0 {
                continue;
            }
            let angle =
                angle_between(vectors[f], vectors[g], connectivity.tail(h) == connectivity.tail(mate));
            let [a, b] = [connectivity.tail(h), connectivity.head(h)].map(|v| points[v as usize]);
            let length = vector::distance(a, b);
            // How far the two middles are apart across the edge: a third of each height.
            let across = 2.0 / 3.0 * (areas[f] + areas[g]) / length;
            // What rounding bends is no bend: loose flat cards have no other.
            if angle > rounding / across {
                bend += length * angle;
                soft += if angle < SOFT { length * angle } else { 0.0 };
            }
            if angle < FLAT.min((FLAT * across / width).max(rounding / across)) {
                facets.unite(f as u32, g as u32);
            } else {
                is_flat[f] = false;
                is_flat[g] = false;
            }
        }
        let mut sizes = memory::repeated(0.0, faces.len())?;
        let mut counts = memory::repeated(0_u32, faces.len())?;
        for (f, area) in areas.iter().enumerate() {
            let root = facets.root(f as u32) as usize;
            sizes[root] += area;
            counts[root] += 1;
        }
        let planes: f64 =
            sizes.iter().zip(&counts).filter(|(_, count)| **count > 1).map(|(size, _)| size).sum();
        let flat: f64 = areas.iter().zip(&is_flat).filter(|(_, is)| **is).map(|(area, _)| area).sum();
        let part = |of: f64, whole: f64| if whole > 0.0 { of / whole + 0.0 } else { 0.0 };
        Ok(Self {
            flat_share: part(flat, total),
            soft_share: part(soft, bend),
            plane_share: part(planes, total),
            n_facets: sizes.iter().filter(|&&size| size >= SEEN * total && size > 0.0).count(),
        })
    }
}

/// The angle between two normals of any length, exact for tiny ones; `reversed` where their faces run along
/// their edge the same way, so that one of the normals points to the other side.
fn angle_between(a: vector::Point, b: vector::Point, reversed: bool) -> f64 {
    let b = if reversed { vector::scale(b, -1.0) } else { b };
    vector::norm(vector::cross(a, b)).atan2(vector::dot(a, b))
}
