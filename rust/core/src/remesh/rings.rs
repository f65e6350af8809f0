//! Faces within rings of a vertex, without sorting or allocating for each one.

use crate::memory;
use crate::remesh::EditableMesh;
use crate::Result;

/// Memory for many searches on one mesh, which must not change between them.
#[derive(Debug)]
pub struct Rings<'a> {
    mesh: &'a EditableMesh,
    /// The last search that met each face and each vertex.
    face_met: Vec<u32>,
    vertex_met: Vec<u32>,
    search: u32,
    front: Vec<u32>,
    next: Vec<u32>,
    faces: Vec<u32>,
}

impl<'a> Rings<'a> {
    /// For searches on `mesh`.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn new(mesh: &'a EditableMesh) -> Result<Self> {
        let face_met = memory::repeated(0, mesh.n_faces())?;
        let vertex_met = memory::repeated(0, mesh.n_vertices())?;
        let [front, next, faces] = [(); 3].map(|()| Vec::new());
        Ok(Self { mesh, face_met, vertex_met, search: 0, front, next, faces })
    }

    /// The faces with a vertex at most `rings - 1` edges away from `v`, ascending.
    pub fn within(&mut self, v: u32, rings: usize) -> &[u32] {
        if self.search == u32::MAX {
            self.face_met.fill(0);
            self.vertex_met.fill(0);
            self.search = 0;
        }
        self.search += 1;
        self.faces.clear();
        self.front.clear();
        self.front.push(v);
        self.vertex_met[v as usize] = self.search;
        for ring in 0..rings {
            self.next.clear();
            for &v in &self.front {
                for &f in self.mesh.faces_of(v) {
                    if self.face_met[f as usize] == self.search {
                        continue;
                    }
                    self.face_met[f as usize] = self.search;
                    self.faces.push(f);
                    if ring + 1 < rings {
                        for w in self.mesh.face(f).into_iter().flatten() {
                            if self.vertex_met[w as usize] != self.search {
                                self.vertex_met[w as usize] = self.search;
                                self.next.push(w);
                            }
                        }
                    }
                }
            }
            std::mem::swap(&mut self.front, &mut self.next);
        }
        self.faces.sort_unstable();
        &self.faces
    }
}
