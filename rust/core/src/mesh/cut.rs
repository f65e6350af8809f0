//! Cutting a mesh open along edges.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::partition::Partition;
use crate::mesh::{Connectivity, EdgeTable};
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
        // The corner where a halfedge starts is the index of the next halfedge,
        // that where it ends of the previous.
        let corner_at = |h: usize, vertex: u32| {
            let at = if connectivity.tail(h) == vertex { next(h) } else { previous(h) };
            at as u32
        };
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
