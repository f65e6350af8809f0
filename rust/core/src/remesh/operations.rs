//! What changes the connectivity of an [`EditableMesh`]: flips, splits and collapses.

use crate::memory;
use crate::mesh::vector::Point;
use crate::remesh::edge::{Edge, Wings};
use crate::remesh::editable::{EditableMesh, GONE};
use crate::Result;

impl EditableMesh {
    /// The two faces that [`EditableMesh::flip`] would make, in the place of `wings.faces`;
    /// nothing if it would refuse.
    #[must_use]
    pub fn flipped(&self, a: u32, b: u32) -> Option<[[u32; 3]; 2]> {
        let Wings { tips: [left, right], .. } = self.wings(a, b)?;
        (left != right && !self.is_taken(left, right)).then_some([[left, a, right], [right, b, left]])
    }

    /// Flips the edge `a b` into the other diagonal of its two faces, and returns its ends; does nothing and
    /// returns nothing if the edge is not interior or the new one exists already or is forbidden. The two
    /// face numbers stay.
    pub fn flip(&mut self, a: u32, b: u32) -> Option<[u32; 2]> {
        let new = self.flipped(a, b)?;
        let Wings { faces: [f, g], tips: [left, right] } = self.wings(a, b)?;
        // `f` was a, b, left and loses b; `g` was b, a, right and loses a.
        self.detach(b, f);
        self.detach(a, g);
        self.faces_of[right as usize].push(f);
        self.faces_of[left as usize].push(g);
        (self.faces[f as usize], self.faces[g as usize]) = (new[0], new[1]);
        Some([left, right])
    }

    /// Splits the edge `a b` and its one or two faces at a new vertex at `position`, and returns that vertex;
    /// does nothing and returns nothing if there is no such edge or it is not manifold, or if its two faces
    /// lie back to back: the edge to the tip that both have would get four.
    ///
    /// The old face numbers stay at `a`; the new faces at `b` are the last ones,
    /// that of `wings.faces[0]` first.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`]; the mesh is as it was.
    pub fn split(&mut self, a: u32, b: u32, position: Point) -> Result<Option<u32>> {
        let faces: &[u32] = match &self.edge(a, b) {
            Edge::Border(f, _) => &[*f],
            Edge::Interior(wings) if wings.tips[0] != wings.tips[1] => &wings.faces.clone(),
            Edge::Interior(_) | Edge::None | Edge::NonManifold => return Ok(None),
        };
        self.make_room()?;
        let new = self.add_vertex(position);
        for &f in faces {
            let old = self.faces[f as usize];
            self.detach(b, f);
            self.faces_of[new as usize].push(f);
            self.faces[f as usize] = old.map(|v| if v == b { new } else { v });
            self.add_face(old.map(|v| if v == a { new } else { v }));
        }
        Ok(Some(new))
    }

    /// Splits face `f` into three at a new vertex at `position`, and returns that vertex;
    /// nothing if `f` was removed.
    ///
    /// The part at the face's first edge keeps the number, the two others are the last faces.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`]; the mesh is as it was.
    pub fn split_face(&mut self, f: u32, position: Point) -> Result<Option<u32>> {
        let Some([a, b, c]) = self.face(f) else { return Ok(None) };
        self.make_room()?;
        let new = self.add_vertex(position);
        self.detach(c, f);
        self.faces_of[new as usize].push(f);
        self.faces[f as usize] = [a, b, new];
        self.add_face([b, c, new]);
        self.add_face([c, a, new]);
        Ok(Some(new))
    }

    /// Whether [`EditableMesh::collapse`] keeps the surface as it is but for its size: the link condition
    /// (Dey et al. 1999), and no vertex is left with less than a fan.
    #[must_use]
    pub fn can_collapse(&self, from: u32, to: u32) -> bool {
        let (tips, interior) = match self.edge(from, to) {
            Edge::Border(_, tip) => ([tip, tip], false),
            Edge::Interior(wings) => (wings.tips, true),
            Edge::None | Edge::NonManifold => return false,
        };
        if interior && self.is_border(from) && self.is_border(to) {
            return false;
        }
        // A tip loses a face: one with three faces all around it would be left with two, back to back.
        let thin = |&tip: &u32| {
            let count = self.faces_of(tip).len();
            count <= 1 || count <= 3 && !self.is_border(tip)
        };
        !tips.iter().any(thin)
            && self.neighbors(from).into_iter().all(|w| w == to || tips.contains(&w) || !self.is_taken(to, w))
    }

    /// Collapses the edge into its end `to`, which moves to `position`; `from` is gone. Does nothing and
    /// returns false unless [`EditableMesh::can_collapse`]. Both must be manifold vertices
    /// ([`EditableMesh::is_manifold`]).
    pub fn collapse(&mut self, from: u32, to: u32, position: Point) -> bool {
        if !self.can_collapse(from, to) {
            return false;
        }
        for f in std::mem::take(&mut self.faces_of[from as usize]) {
            let old = self.faces[f as usize];
            if old.contains(&to) {
                old.into_iter().filter(|&v| v != from).for_each(|v| self.detach(v, f));
                self.faces[f as usize] = GONE;
            } else {
                self.faces[f as usize] = old.map(|v| if v == from { to } else { v });
                self.faces_of[to as usize].push(f);
            }
        }
        self.set_position(to, position);
        true
    }

    /// Room for one more vertex and the two more faces that come with it at most.
    fn make_room(&mut self) -> Result<()> {
        memory::extend(&mut self.positions, 1)?;
        memory::extend(&mut self.faces_of, 1)?;
        Ok(memory::extend(&mut self.faces, 2)?)
    }

    fn add_vertex(&mut self, position: Point) -> u32 {
        self.positions.push(position);
        self.faces_of.push(Vec::with_capacity(6));
        self.positions.len() as u32 - 1
    }

    fn add_face(&mut self, face: [u32; 3]) {
        face.iter().for_each(|&v| self.faces_of[v as usize].push(self.faces.len() as u32));
        self.faces.push(face);
    }

    /// Takes face `f` from the list of `v`.
    fn detach(&mut self, v: u32, f: u32) {
        // Found and closed up in blocks, which for ten thousand faces takes no longer than for ten.
        let faces = &mut self.faces_of[v as usize];
        if let Some(place) = faces.iter().position(|&g| g == f) {
            faces.remove(place);
        }
    }
}
