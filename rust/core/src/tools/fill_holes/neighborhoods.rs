//! What lies near a hole, found in time that depends on what lies near it.

use std::collections::HashSet;

use crate::memory;
use crate::mesh::Connectivity;
use crate::Result;

/// The faces at the loops of a mesh, and those around them on demand.
pub(super) struct Neighborhoods<'a> {
    connectivity: &'a Connectivity,
    /// Every vertex of a face at a loop, with that face; sorted.
    corners: Vec<(u32, u32)>,
}

impl<'a> Neighborhoods<'a> {
    /// Those of `connectivity`, given the faces at the loops ([`crate::hole_filling::faces_at`]).
    pub(super) fn new(connectivity: &'a Connectivity, at_loops: &[u32]) -> Result<Self> {
        let corners = |&f: &u32| connectivity.faces()[f as usize].map(|v| (v, f));
        let mut corners = memory::sifted(at_loops.iter().flat_map(corners))?;
        corners.sort_unstable();
        Ok(Self { connectivity, corners })
    }

    /// The faces of a vertex on a loop.
    fn at(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.corners.partition_point(|&(w, _)| w < v);
        self.corners[first..].iter().take_while(move |&&(w, _)| w == v).map(|&(_, f)| f)
    }

    /// The faces of `seeds`, which are on loops, and `rings - 1` rings around those, ascending.
    ///
    /// Rings grow about every vertex through the edges with two faces. Of surfaces that touch in a vertex or
    /// an edge away from the seeds, only those belong to it that one reaches otherwise.
    pub(super) fn within(&self, seeds: &[u32], rings: usize) -> Result<Vec<u32>> {
        let mut front = memory::sifted(seeds.iter().flat_map(|&v| self.at(v)))?;
        front.sort_unstable();
        front.dedup();
        let mut found = HashSet::new();
        memory::extend_set(&mut found, front.len())?;
        found.extend(front.iter().copied());
        let mut faces = memory::twin(&front)?;
        let mut turned = HashSet::new();
        for _ in 1..rings {
            let mut next = Vec::new();
            for corner in front.iter().flat_map(|&f| 3 * f..3 * f + 3) {
                self.turn(corner, &mut turned, |f| {
                    memory::extend_set(&mut found, 1)?;
                    if found.insert(f) {
                        memory::push(&mut next, f)?;
                    }
                    Ok(())
                })?;
            }
            memory::extend(&mut faces, next.len())?;
            faces.extend_from_slice(&next);
            front = next;
        }
        faces.sort_unstable();
        Ok(faces)
    }

    /// Visits the faces of the fan about the vertex at `corner`,
    /// unless one of its corners was `turned` before.
    fn turn(
        &self,
        corner: u32,
        turned: &mut HashSet<u32>,
        mut visit: impl FnMut(u32) -> Result<()>,
    ) -> Result<()> {
        let faces = self.connectivity.faces();
        let vertex = faces[corner as usize / 3][corner as usize % 3];
        let mut stack = vec![corner];
        while let Some(corner) = stack.pop() {
            memory::extend_set(turned, 1)?;
            if !turned.insert(corner) {
                continue;
            }
            let f = corner / 3;
            visit(f)?;
            for h in (3 * f..3 * f + 3).filter(|&h| h != corner) {
                let Some(mate) = self.connectivity.mate(h as usize) else { continue };
                let beside = faces[mate / 3].iter().position(|&v| v == vertex);
                stack.extend(beside.map(|i| (mate - mate % 3 + i) as u32));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::hole_filling::faces_at;
    use crate::mesh::boundary_loops;
    use crate::shapes::{cube, grid};

    use super::*;

    /// Ring by ring over all faces.
    fn by_passes(faces: &[[u32; 3]], seeds: &[u32], rings: usize) -> Vec<u32> {
        let mut vertices: HashSet<u32> = seeds.iter().copied().collect();
        let mut found = Vec::new();
        for _ in 0..rings {
            found = (0..faces.len() as u32)
                .filter(|&f| faces[f as usize].iter().any(|v| vertices.contains(v)))
                .collect();
            vertices.extend(found.iter().flat_map(|&f| faces[f as usize]));
        }
        found
    }

    #[test]
    fn rings_around_one_of_two_holes() {
        let open = cube(12).without_faces(|f| (f % 97 == 5 || f % 97 == 6) && f < 200);
        for shape in [open, grid(9, 7)] {
            let mesh = shape.mesh().unwrap();
            let loops = boundary_loops(mesh.connectivity()).unwrap();
            let near = Neighborhoods::new(mesh.connectivity(), &faces_at(&mesh, &loops).unwrap()).unwrap();
            for (vertices, rings) in
                loops.iter().flat_map(|vertices| [1, 2, 5].map(|rings| (vertices, rings)))
            {
                let expected = by_passes(mesh.connectivity().faces(), vertices, rings);
                assert_eq!(near.within(vertices, rings).unwrap(), expected);
            }
        }
    }

    #[test]
    fn all_fans_at_the_loop_belong_to_its_first_ring() {
        // Two tetrahedra, open at the bottom, that touch in vertex 0 of both loops.
        let faces = vec![[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 4, 6], [4, 5, 6], [5, 0, 6]];
        let connectivity = Connectivity::new(faces, 7).unwrap();
        let near = Neighborhoods::new(&connectivity, &[0, 1, 2, 3, 5]).unwrap();
        assert_eq!(near.within(&[0, 1, 2], 1).unwrap(), [0, 1, 2, 3, 5]);
        assert_eq!(near.within(&[0, 1, 2], 2).unwrap(), [0, 1, 2, 3, 4, 5]);
    }
}
