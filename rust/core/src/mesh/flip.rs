//! Turning the edge between two triangles into the other diagonal of their quadrilateral.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::Connectivity;

/// What a flip did to the halfedges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flip {
    /// The two halfedges of the new edge, twins of each other.
    pub diagonal: [usize; 2],
    /// The four outer halfedges before and after, `(old, new)`.
    pub outer: [(usize, usize); 4],
}

impl Connectivity {
    /// Flips the edge of `h` if it is interior and has two different faces;
    /// else does nothing and returns nothing.
    ///
    /// The new edge may join two vertices that another edge joins already, or a vertex with itself: that is
    /// sound intrinsically, since twins are stored. A caller who flips a surface in space must rule it out
    /// first.
    pub fn flip(&mut self, h: usize) -> Option<Flip> {
        let twin = self.twin(h).filter(|twin| twin / 3 != h / 3)?;
        let (f, g) = (h / 3, twin / 3);
        let [tail, head, left, right] = [self.tail(h), self.head(h), self.opposite(h), self.opposite(twin)];
        let outer =
            [(next(twin), 3 * f), (previous(h), 3 * f + 2), (next(h), 3 * g), (previous(twin), 3 * g + 2)];
        let moved = |old: u32| {
            outer.iter().find(|(before, _)| *before == old as usize).map_or(old, |&(_, after)| after as u32)
        };
        let carried = outer.map(|(old, _)| (moved(self.mates[old]), self.kinds[old]));
        self.faces[f] = [left, tail, right];
        self.faces[g] = [right, head, left];
        for ((_, new), (mate, kind)) in outer.into_iter().zip(carried) {
            self.mates[new] = mate;
            self.kinds[new] = kind;
            if let Some(back) = self.mate(new) {
                self.mates[back] = new as u32;
            }
        }
        let diagonal = [3 * f + 1, 3 * g + 1];
        self.join(diagonal);
        Some(Flip { diagonal, outer })
    }
}
