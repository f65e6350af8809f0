//! Cutting a mesh open along edges.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::partition::Partition;
use crate::mesh::vector::{cross, dot, scale, sub, unit, Point};
use crate::mesh::{Connectivity, EdgeKind, EdgeTable};
use crate::{memory, Result};

/// A mesh cut open along edges: a vertex has one copy for every sector of faces between the cut edges around
/// it.
///
/// A vertex without a cut edge has one copy, whether or not its faces form one fan; so has the end of a cut
/// inside the surface. The faces keep their order and corners, the copies the order of their first corner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutMesh {
    /// The copies at the corners of every face.
    pub faces: Vec<[u32; 3]>,
    /// The vertex of every copy; vertices without faces have none.
    pub vertices: Vec<u32>,
}

impl CutMesh {
    /// Cuts along the edges of the halfedges for which `cut` holds, an entry a halfedge;
    /// one of an edge is enough.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn new(connectivity: &Connectivity, table: &EdgeTable, cut: &[bool]) -> Result<Self> {
        let mut corners = Partition::new(connectivity.n_halfedges())?;
        let corner_at = |h: usize, vertex: u32| corner_at(connectivity, h, vertex);
        let mut touched = memory::repeated(false, connectivity.n_vertices())?;
        for mut edge in table.edges() {
            if edge.clone().any(|h| cut[h]) {
                for h in edge {
                    touched[connectivity.tail(h) as usize] = true;
                    touched[connectivity.head(h) as usize] = true;
                }
            } else if let Some(first) = edge.next() {
                let ends = [connectivity.tail(first), connectivity.head(first)];
                for h in edge {
                    ends.iter().for_each(|&v| corners.unite(corner_at(first, v), corner_at(h, v)));
                }
            }
        }
        Self::from_corners(connectivity, corners, &touched)
    }

    /// Parts surfaces that touch along edges: of four faces and more at an edge those two go together, in
    /// turns around it, that bound one part of the inside. Nothing where there is no such edge.
    ///
    /// A vertex has one copy for every sector of faces that go together. So the end of a line along which a
    /// surface touches itself has one, and an edge between two such ends stays as it is, as do edges of an
    /// odd number of faces and those whose faces disagree on what is outside.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn of_touching(connectivity: &Connectivity, positions: &[Point]) -> Result<Option<Self>> {
        if connectivity.edges().all(|h| connectivity.kind(h) != EdgeKind::NonManifold) {
            return Ok(None);
        }
        let table = EdgeTable::new(connectivity)?;
        let mut corners = Partition::new(connectivity.n_halfedges())?;
        let mut touched = memory::repeated(false, connectivity.n_vertices())?;
        let mut is_parted = false;
        for edge in table.edges() {
            let halfedges: Vec<usize> = edge.collect();
            let pairs = pairs_around(connectivity, positions, &halfedges);
            is_parted |= !pairs.is_empty();
            for h in halfedges.iter().filter(|_| !pairs.is_empty()) {
                touched[connectivity.tail(*h) as usize] = true;
                touched[connectivity.head(*h) as usize] = true;
            }
            let whole = halfedges.windows(2).map(|two| [two[0], two[1]]);
            let joined = if pairs.is_empty() { whole.collect() } else { pairs };
            for [one, other] in joined {
                for v in [connectivity.tail(one), connectivity.head(one)] {
                    corners.unite(corner_at(connectivity, one, v), corner_at(connectivity, other, v));
                }
            }
        }
        if is_parted {
            Ok(Some(Self::from_corners(connectivity, corners, &touched)?))
        } else {
            Ok(None)
        }
    }

    fn from_corners(connectivity: &Connectivity, mut corners: Partition, touched: &[bool]) -> Result<Self> {
        let mut first = memory::repeated(None, connectivity.n_vertices())?;
        for (f, face) in connectivity.faces().iter().enumerate() {
            let repeated = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
            for (i, &v) in face.iter().enumerate() {
                let corner = (3 * f + i) as u32;
                match first[v as usize] {
                    None => first[v as usize] = Some(corner),
                    // A face that names a vertex twice has no sides: it goes with the first sector.
                    Some(before) if repeated || !touched[v as usize] => corners.unite(before, corner),
                    Some(_) => {}
                }
            }
        }
        let mut copies = memory::repeated(0, connectivity.n_halfedges())?;
        let mut vertices = memory::room(connectivity.n_vertices())?;
        for corner in 0..connectivity.n_halfedges() {
            let root = corners.root(corner as u32) as usize;
            if root == corner {
                copies[corner] = vertices.len() as u32;
                memory::push(&mut vertices, connectivity.opposite(corner))?;
            }
            copies[corner] = copies[root];
        }
        Ok(Self { faces: memory::twin(copies.as_chunks().0)?, vertices })
    }

    /// How many copies there are.
    #[must_use]
    pub fn n_copies(&self) -> usize {
        self.vertices.len()
    }
}

/// The corner of a halfedge's face at one of its ends. Where it starts that is the index of the next
/// halfedge, where it ends of the previous.
fn corner_at(connectivity: &Connectivity, h: usize, vertex: u32) -> u32 {
    let at = if connectivity.tail(h) == vertex { next(h) } else { previous(h) };
    at as u32
}

/// Which faces at an edge go together, by their halfedges; none where they do not alternate around it.
fn pairs_around(connectivity: &Connectivity, positions: &[Point], halfedges: &[usize]) -> Vec<[usize; 2]> {
    if halfedges.len() < 4 || !halfedges.len().is_multiple_of(2) {
        return Vec::new();
    }
    let place = |v: u32| positions[v as usize];
    let first = connectivity.tail(halfedges[0]);
    let (tail, head) = (place(first), place(connectivity.head(halfedges[0])));
    let along = unit(sub(head, tail));
    let across = |h: usize| {
        let to = sub(place(connectivity.opposite(h)), tail);
        sub(to, scale(along, dot(to, along)))
    };
    let start = unit(across(halfedges[0]));
    let side = cross(along, start);
    let angle = |h: usize| dot(across(h), side).atan2(dot(across(h), start));
    let mut around: Vec<(f64, usize)> = halfedges.iter().map(|&h| (angle(h), h)).collect();
    around.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Beyond a face whose halfedge runs the other way lies the inside, up to the next one.
    let is_along = |h: usize| connectivity.tail(h) == first;
    let begin = usize::from(is_along(around[0].1));
    around.rotate_left(begin);
    let pairs: Vec<[usize; 2]> = around.chunks_exact(2).map(|two| [two[0].1, two[1].1]).collect();
    if pairs.iter().all(|&[one, other]| !is_along(one) && is_along(other)) {
        pairs
    } else {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Two tetrahedra with one edge in common, on the two sides of a plane through it.
    fn touching(second: [[u32; 3]; 4]) -> (Connectivity, Vec<Point>) {
        let points = vec![
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.5, 0.5],
            [1.0, -0.5, 0.5],
            [-1.0, -0.5, 0.5],
            [-1.0, 0.5, 0.5],
        ];
        let faces = vec![[0, 3, 1], [0, 1, 2], [0, 2, 3], [1, 3, 2]];
        (Connectivity::new([faces, second.to_vec()].concat(), 6).unwrap(), points)
    }

    #[test]
    fn surfaces_that_touch_are_parted_where_each_is_closed() {
        let (connectivity, points) = touching([[0, 5, 1], [0, 1, 4], [0, 4, 5], [1, 5, 4]]);
        let cut = CutMesh::of_touching(&connectivity, &points).unwrap().unwrap();
        assert_eq!(cut.n_copies(), 8);
        let apart = Connectivity::new(cut.faces.clone(), 8).unwrap();
        assert!(apart.edges().all(|h| apart.kind(h) == EdgeKind::Interior));
        assert_eq!(cut.vertices.iter().filter(|&&v| v < 2).count(), 4);
    }

    #[test]
    fn faces_that_disagree_on_the_outside_stay_together() {
        let (connectivity, points) = touching([[0, 1, 5], [0, 4, 1], [0, 5, 4], [1, 4, 5]]);
        assert_eq!(CutMesh::of_touching(&connectivity, &points).unwrap(), None);
    }
}
