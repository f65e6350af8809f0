//! Smooth or sharp: whether the curvature around a hole is spread or concentrated in ridges.

use super::constants::{ALIKE, CONTRAST, LEAST_RIDGE_ANGLE};
use super::region::Region;
use super::surface::FaceGeometry;
use crate::memory;
use crate::mesh::vector::distance;
use crate::Result;

/// The ridges that reach a hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ridges {
    /// The bend of the least bent one, in radians.
    pub least: f64,
    /// That of the most bent one.
    pub most: f64,
}

impl Ridges {
    /// Bends (radians) that part smooth parts: the least, and where ridges are of different kinds the most.
    pub(super) fn bends(self) -> impl Iterator<Item = f64> {
        std::iter::once(self.least).chain((self.most >= ALIKE * self.least).then_some(self.most))
    }
}

/// What the edges around a hole say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bends {
    /// The surface is smooth.
    Smooth,
    /// Edges at the hole are bent as ridges are, and so are many others: noise, perhaps.
    Unclear,
    /// Ridges reach the hole.
    Ridges(Ridges),
}

/// Whether ridges reach the hole: edges at its rim, not of the patch, that are bent by more
/// than 25 degrees and by far more than edges around the hole commonly are.
///
/// What is common is found by adding the edges of the surroundings from the least bent on, until one is
/// [`CONTRAST`] times as bent as the root mean square (by length) of those before.
pub(super) fn bends_around(region: &Region) -> Result<Bends> {
    let surface = FaceGeometry::of(region)?;
    let mesh = &region.mesh;
    let mut on_rim = memory::repeated(false, mesh.n_vertices())?;
    region.patch_faces().for_each(|(_, face)| face.into_iter().for_each(|v| on_rim[v as usize] = true));
    let bend = |[a, b]: [u32; 2]| {
        let wings = mesh.wings(a, b)?;
        let around = wings.faces.iter().all(|&f| !region.is_patch(f));
        let length = distance(mesh.position(a), mesh.position(b));
        around.then(|| (surface.dihedral(wings.faces), length, on_rim[a as usize] || on_rim[b as usize]))
    };
    let mut edges = memory::sifted(mesh.edges()?.into_iter().filter_map(bend))?;
    edges.sort_by(|x, y| x.0.total_cmp(&y.0));
    let (mut squares, mut length) = (0.0, 0.0);
    for (i, &(angle, l, _)) in edges.iter().enumerate() {
        let common = f64::sqrt(squares / length);
        if length > 0.0 && angle > LEAST_RIDGE_ANGLE && angle > CONTRAST * common {
            let mut bends = edges[i..].iter().filter(|(_, _, at_rim)| *at_rim).map(|(angle, ..)| *angle);
            let Some(least) = bends.next() else { break };
            return Ok(Bends::Ridges(Ridges { least, most: bends.next_back().unwrap_or(least) }));
        }
        squares += l * angle * angle;
        length += l;
    }
    let is_bent = edges.iter().any(|&(angle, _, at_rim)| at_rim && angle > LEAST_RIDGE_ANGLE);
    Ok(if is_bent { Bends::Unclear } else { Bends::Smooth })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use crate::shapes::{self, Shape};
    use crate::tools::fill_holes::region::tests::around_hole;

    fn bends(shape: Shape, place: [f64; 3], radius: f64) -> Bends {
        bends_around(&around_hole(&shape, place, radius)).unwrap()
    }

    #[test]
    fn a_cubes_edge_is_a_ridge_of_a_right_angle() {
        let Bends::Ridges(found) = bends(shapes::cube(12), [1.0, 1.0, 0.1], 0.4) else { panic!("no ridge") };
        assert!((found.least - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{found:?}");
        assert!((found.most - found.least).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn ridges_that_do_not_reach_the_hole_do_not_count() {
        assert_eq!(bends(shapes::cube(12), [1.0, 0.0, 0.0], 0.4), Bends::Smooth);
    }

    #[test]
    fn smooth_and_noisy_surfaces_have_no_ridges() {
        assert_eq!(bends(shapes::icosphere(3), [0.0, 0.0, 1.0], 0.4), Bends::Smooth);
        assert_eq!(bends(shapes::icosphere(3).noisy(0.02, 1), [0.0, 0.0, 1.0], 0.4), Bends::Smooth);
    }
}
