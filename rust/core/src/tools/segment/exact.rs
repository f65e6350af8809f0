//! Shapes that were modeled, not measured: every vertex lies where it should,
//! and a side may be two triangles.
//!
//! The Hessian needs some rows of faces to tell a side from noise. Where the shape is exact there is no
//! noise: faces in one plane are one side, and the angle between two planes is known from one edge.

use super::constants::{
    FEW_FACES, FLAT_SHARE, LEAST_INSIDE, MOST_TURN_IN_A_PLANE, SINGLE_PRECISION, SLIVER_ROUNDINGS,
};
use super::surface::Surface;
use crate::mesh::partition::contiguous;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, distance, norm, sub, unit, Point};
use crate::mesh::FILE_ROUNDING;
use crate::{memory, Result};

/// The flat sides of an exact shape.
pub(super) struct Planes {
    /// The plane of each face, from 0.
    pub labels: Vec<u32>,
    /// The unit normal of the plane of each face.
    pub normals: Vec<Point>,
    /// Only sides of one group are one where they bend little: a group for each face.
    pub groups: Option<Vec<u32>>,
}

/// The planes of a shape that is exact and has sides too coarse for the Hessian, where borders are none if
/// the unit normals differ by less than `bend`; nothing for any other shape.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn coarse_planes(surface: &Surface<'_>, bend: f64) -> Result<Option<Planes>> {
    let largest = surface.positions.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let facets = Facets::new(surface, FILE_ROUNDING.max(SINGLE_PRECISION * largest))?;
    let edges = facets.turns()?;
    let flat = edges.iter().filter(|edge| edge.is_flat).count();
    if surface.n_faces() >= FEW_FACES && (flat as f64) < FLAT_SHARE * edges.len() as f64 {
        return Ok(None);
    }
    let sides = facets.joined(&edges, |edge| edge.turn < bend)?;
    if !is_coarse(surface, &sides)? {
        return Ok(None);
    }
    let labels = facets.joined(&edges, |edge| edge.is_flat)?;
    let mut sums = memory::repeated([0.0; 3], labels.iter().map(|l| *l as usize + 1).max().unwrap_or(0))?;
    for (f, &label) in labels.iter().enumerate() {
        sums[label as usize] = add(sums[label as usize], surface.vector_area(f));
    }
    let normals = memory::gathered(labels.iter().map(|&label| unit(sums[label as usize])))?;
    Ok(Some(Planes { labels, normals, groups: None }))
}

/// Whether a side has too few faces inside.
fn is_coarse(surface: &Surface<'_>, sides: &[u32]) -> Result<bool> {
    let mut inside = memory::repeated(0, sides.iter().map(|l| *l as usize + 1).max().unwrap_or(0))?;
    for (f, &side) in sides.iter().enumerate() {
        inside[side as usize] += usize::from(!surface.is_at_border(sides, f));
    }
    Ok(inside.iter().any(|count| *count < LEAST_INSIDE))
}

/// The faces with what rounding makes of them.
pub(super) struct Facets<'a> {
    surface: &'a Surface<'a>,
    rounding: f64,
    normals: Vec<Point>,
    slivers: Vec<bool>,
}

/// An edge between two faces, neither a sliver, with the distance between their unit normals.
pub(super) struct Turn {
    faces: [u32; 2],
    turn: f64,
    pub is_flat: bool,
}

impl<'a> Facets<'a> {
    /// The faces of `surface`, whose coordinates are off by `rounding` at most.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn new(surface: &'a Surface<'a>, rounding: f64) -> Result<Self> {
        let n = surface.n_faces();
        let (normals, slivers) = (memory::room(n)?, memory::room(n)?);
        let mut facets = Self { surface, rounding, normals, slivers };
        for f in 0..n {
            facets.normals.push(unit(surface.vector_area(f)));
            let longest = facets.longest(f).0;
            let height = 2.0 * norm(surface.vector_area(f)) / longest.max(f64::MIN_POSITIVE);
            facets.slivers.push(height < SLIVER_ROUNDINGS * rounding);
        }
        Ok(facets)
    }

    /// The length of the longest edge of face `f`, and its halfedge.
    fn longest(&self, f: usize) -> (f64, usize) {
        let face = self.surface.connectivity.faces()[f];
        let length = |i: usize| {
            let [a, b] = [1, 2].map(|k| self.surface.positions[face[(i + k) % 3] as usize]);
            (distance(a, b), 3 * f + i)
        };
        [length(1), length(2)]
            .into_iter()
            .fold(length(0), |most, held| if held.0 > most.0 { held } else { most })
    }

    /// All edges between faces that have normals.
    pub(super) fn turns(&self) -> Result<Vec<Turn>> {
        let connectivity = self.surface.connectivity;
        let turn = |h: usize| {
            let twin = connectivity.twin(h)?;
            let (f, g) = (h / 3, twin / 3);
            if self.slivers[f] || self.slivers[g] {
                return None;
            }
            let turn = distance(self.normals[f], self.normals[g]);
            // Rounding turns a face by as much over its height.
            let rounded = self.rounding * (1.0 / self.height(h) + 1.0 / self.height(twin));
            Some(Turn {
                faces: [f as u32, g as u32],
                turn,
                is_flat: turn < (4.0 * rounded).min(MOST_TURN_IN_A_PLANE),
            })
        };
        Ok(memory::sifted(connectivity.edges().filter_map(turn))?)
    }

    /// The height of a face over the edge of its halfedge `h`.
    fn height(&self, h: usize) -> f64 {
        let (connectivity, p) = (self.surface.connectivity, &self.surface.positions);
        let [tail, head] = [connectivity.tail(h), connectivity.head(h)].map(|v| p[v as usize]);
        let length = norm(sub(head, tail)).max(f64::MIN_POSITIVE);
        (2.0 * norm(self.surface.vector_area(h / 3)) / length).max(f64::MIN_POSITIVE)
    }

    /// The faces joined over the edges that `joins`, slivers with the neighbor at their longest edge:
    /// a label for each, from 0.
    pub(super) fn joined(&self, edges: &[Turn], joins: impl Fn(&Turn) -> bool) -> Result<Vec<u32>> {
        let n = self.surface.n_faces();
        let mut partition = Partition::new(n)?;
        for edge in edges.iter().filter(|edge| joins(edge)) {
            partition.unite(edge.faces[0], edge.faces[1]);
        }
        self.place_slivers(&mut partition)?;
        let roots: Vec<u32> = memory::gathered((0..n as u32).map(|f| partition.root(f)))?;
        Ok(contiguous(&roots)?.0)
    }

    /// Joins each sliver with the neighbor at its longest edge, or where that leads to slivers only,
    /// at another one.
    fn place_slivers(&self, partition: &mut Partition) -> Result<()> {
        let mut placed: Vec<bool> = memory::gathered(self.slivers.iter().map(|sliver| !sliver))?;
        let mut left: Vec<usize> = memory::sifted((0..placed.len()).filter(|&f| !placed[f]))?;
        for any_edge in [false, true] {
            loop {
                let before = left.len();
                left.retain(|&f| {
                    let edges = if any_edge { [0, 1, 2].map(|i| 3 * f + i) } else { [self.longest(f).1; 3] };
                    let twins = edges.into_iter().filter_map(|h| self.surface.connectivity.twin(h));
                    let Some(twin) = twins.into_iter().find(|twin| placed[twin / 3]) else { return true };
                    partition.unite(f as u32, (twin / 3) as u32);
                    placed[f] = true;
                    false
                });
                if left.len() == before {
                    break;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::Mesh;
    use crate::shapes;

    fn planes(mesh: &Mesh) -> Option<usize> {
        let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
        let costs = vec![[1.0; 3]; connectivity.n_faces()];
        let surface = Surface::new(connectivity, positions, 1.0, costs).unwrap();
        coarse_planes(&surface, 0.4).unwrap().map(|planes| contiguous(&planes.labels).unwrap().1)
    }

    #[test]
    fn coarse_exact_sides_are_planes() {
        for n in 1..=3 {
            assert_eq!(
                planes(&shapes::cube(n).rotated([0.3, -1.0, 0.7], 0.8).mesh().unwrap()),
                Some(6),
                "{n}"
            );
        }
        assert_eq!(planes(&shapes::tetrahedron().mesh().unwrap()), Some(4));
    }

    #[test]
    fn fine_noisy_and_smooth_surfaces_are_left_to_the_functional() {
        assert_eq!(planes(&shapes::cube(8).mesh().unwrap()), None);
        assert_eq!(planes(&shapes::cube(5).noisy(0.02, 1).mesh().unwrap()), None);
        assert_eq!(planes(&shapes::icosphere(3).mesh().unwrap()), None);
    }
}
