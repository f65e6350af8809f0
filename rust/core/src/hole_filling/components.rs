//! The edge-connected components at the loops, and which are open sheets.

use crate::mesh::vector::{add, area_vector, norm, scale, Point};
use crate::mesh::{loop_area_vector, Connectivity, EdgeKind};

/// A component counts as an open sheet if its mean normal is longer than this (1 on a flat sheet, 0 on a
/// closed surface or a tube). Between a hemisphere at 0.5, which is closed with a lid, and a sheet bent to
/// half a tube at 0.64, which is not.
const OPEN_SHEET: f64 = 0.57;

/// The components that were asked for.
///
/// The area vectors of a component add up to those of its loops, so that nothing is an open sheet whose area
/// is larger than the area vectors of all loops together allow: such a component is left as soon as that much
/// of it was seen. Small holes in a large closed surface are told apart from its border by the faces near
/// them.
pub(super) struct Components<'a> {
    connectivity: &'a Connectivity,
    positions: &'a [Point],
    /// For every face one more than the entry of `found` that it was seen for; 0 where it was not.
    seen: Vec<u32>,
    found: Vec<Component>,
    /// A component with more area is no open sheet.
    largest_sheet: f64,
}

/// A set of faces connected across edges.
struct Component {
    area: f64,
    area_vector: Point,
    /// An earlier entry that is the same component.
    same_as: Option<usize>,
    /// Whether all its faces were seen.
    is_whole: bool,
}

impl<'a> Components<'a> {
    /// Those of a mesh with these boundary loops.
    pub(super) fn new(connectivity: &'a Connectivity, positions: &'a [Point], loops: &[Vec<u32>]) -> Self {
        // Edges of other kinds bound faces, or turn them over, without being on a loop.
        let is_plain = !connectivity.has_any(&[EdgeKind::NonManifold, EdgeKind::Inconsistent]);
        let total: f64 = loops.iter().map(|vertices| norm(loop_area_vector(vertices, positions))).sum();
        // Rounding must not end a search that one more face would have made whole.
        let largest_sheet = if is_plain { 1.01 * total / OPEN_SHEET } else { f64::INFINITY };
        Self {
            connectivity,
            positions,
            seen: vec![0; connectivity.n_faces()],
            found: Vec::new(),
            largest_sheet,
        }
    }

    /// The number of the component of a face.
    pub(super) fn of_face(&mut self, face: usize) -> usize {
        match self.seen[face] {
            0 => self.search(face),
            number => self.root(number as usize - 1),
        }
    }

    /// The direction of the mean normal of a component, of length 1, if it is an open sheet.
    pub(super) fn sheet_normal(&self, number: usize) -> Option<Point> {
        let component = &self.found[number];
        let length = norm(component.area_vector);
        (component.is_whole && length > OPEN_SHEET * component.area)
            .then(|| scale(component.area_vector, 1.0 / length))
    }

    fn root(&self, number: usize) -> usize {
        self.found[number].same_as.unwrap_or(number)
    }

    /// Adds the component of `seed`. A face that disagrees with its neighbors on the orientation counts the
    /// other way round.
    fn search(&mut self, seed: usize) -> usize {
        let number = self.found.len();
        let mut component = Component { area: 0.0, area_vector: [0.0; 3], same_as: None, is_whole: true };
        self.seen[seed] = number as u32 + 1;
        let mut stack = vec![(seed, 1.0)];
        'search: while let Some((f, sign)) = stack.pop() {
            let area = area_vector(self.connectivity.faces()[f].map(|v| self.positions[v as usize]));
            component.area += norm(area);
            component.area_vector = add(component.area_vector, scale(area, sign));
            if component.area > self.largest_sheet {
                component.is_whole = false;
                break;
            }
            for h in 3 * f..3 * f + 3 {
                let Some(mate) = self.connectivity.mate(h) else { continue };
                match self.seen[mate / 3] as usize {
                    0 => {
                        self.seen[mate / 3] = number as u32 + 1;
                        let is_turned = self.connectivity.kind(h) != EdgeKind::Interior;
                        stack.push((mate / 3, if is_turned { -sign } else { sign }));
                    }
                    other if other != number + 1 => {
                        // The search for that one was left early.
                        component.is_whole = false;
                        component.same_as = Some(self.root(other - 1));
                        break 'search;
                    }
                    _ => {}
                }
            }
        }
        self.found.push(component);
        self.root(number)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::hole_filling::find_holes;
    use crate::mesh::boundary_loops;
    use crate::shapes::{grid, icosphere, Shape};

    use super::*;

    /// A shape without the faces whose centers lie within `radius` of one of `places`.
    fn pierced(shape: &Shape, places: &[Point], radius: f64) -> Shape {
        let near = |f: usize| {
            let center = crate::mesh::vector::centroid(shape.faces[f].map(|v| shape.vertices[v as usize]));
            places.iter().any(|&p| crate::mesh::vector::distance(center, p) < radius)
        };
        shape.clone().without_faces(near)
    }

    #[test]
    fn small_holes_are_told_from_borders_by_the_faces_near_them() {
        let shape = pierced(&icosphere(5), &[[0.0, 0.0, 1.0], [0.2, 0.0, 0.98], [0.0, -1.0, 0.0]], 0.05);
        let mesh = shape.mesh().unwrap();
        let loops = boundary_loops(mesh.connectivity()).unwrap();
        assert_eq!(loops.len(), 3);
        let mut components = Components::new(mesh.connectivity(), mesh.positions().unwrap(), &loops);
        for vertices in &loops {
            let face =
                mesh.connectivity().faces().iter().position(|face| face.contains(&vertices[0])).unwrap();
            let number = components.of_face(face);
            assert_eq!(components.sheet_normal(number), None);
        }
        let seen = components.seen.iter().filter(|&&number| number > 0).count();
        assert!(20 * seen < mesh.connectivity().n_faces(), "{seen} faces");
    }

    #[test]
    fn a_sheet_beside_a_closed_surface_has_its_own_border() {
        let sheet = pierced(&grid(20, 20), &[[5.0, 5.0, 0.0], [15.0, 12.0, 0.0]], 1.5);
        let sphere = pierced(&icosphere(3), &[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], 0.2);
        for shape in [sheet.clone().and(&sphere), sphere.and(&sheet)] {
            let holes = find_holes(&shape.mesh().unwrap()).unwrap();
            assert_eq!(holes.len(), 5);
            let outer: Vec<usize> =
                holes.iter().filter(|h| h.is_outer_border).map(|h| h.vertices.len()).collect();
            assert_eq!(outer, [80]);
        }
    }

    #[test]
    fn with_a_face_turned_over_all_is_looked_at() {
        let mut shape = pierced(&icosphere(3), &[[0.0, 0.0, 1.0]], 0.3);
        let last = shape.faces.len() - 1;
        shape.faces[last].swap(0, 1);
        let mesh = shape.mesh().unwrap();
        let loops = boundary_loops(mesh.connectivity()).unwrap();
        let mut components = Components::new(mesh.connectivity(), mesh.positions().unwrap(), &loops);
        let number = components.of_face(0);
        assert_eq!(components.sheet_normal(number), None);
        assert!(components.seen.iter().all(|&seen| seen > 0));
    }
}
