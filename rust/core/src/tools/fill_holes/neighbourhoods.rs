//! What lies near a hole, found in time that depends on what lies near it.

use crate::mesh::Connectivity;

/// The faces of every vertex of a mesh.
pub(super) struct Neighbourhoods<'a> {
    connectivity: &'a Connectivity,
    starts: Vec<u32>,
    faces: Vec<u32>,
}

impl<'a> Neighbourhoods<'a> {
    /// Those of `connectivity`, in one pass.
    pub(super) fn new(connectivity: &'a Connectivity) -> Self {
        let mut starts = vec![0_u32; connectivity.n_vertices() + 1];
        for &v in connectivity.faces().iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..connectivity.n_vertices() {
            starts[v + 1] += starts[v];
        }
        let mut fill = starts.clone();
        let mut faces = vec![0; 3 * connectivity.n_faces()];
        for (f, face) in (0..).zip(connectivity.faces()) {
            for &v in face {
                faces[fill[v as usize] as usize] = f;
                fill[v as usize] += 1;
            }
        }
        Self { connectivity, starts, faces }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.faces[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The faces with a vertex at most `rings - 1` edges away from one of `seeds`, ascending.
    pub(super) fn within(&self, seeds: &[u32], rings: usize) -> Vec<u32> {
        let (mut faces, mut front) = (Vec::new(), seeds.to_vec());
        for _ in 0..rings {
            faces = front.iter().flat_map(|&v| self.of(v)).copied().collect();
            faces.sort_unstable();
            faces.dedup();
            front = faces.iter().flat_map(|&f| self.connectivity.faces()[f as usize]).collect();
            front.sort_unstable();
            front.dedup();
        }
        faces
    }
}
