//! Which parts of a mesh pass through each other already.

use std::collections::{HashMap, HashSet};

use crate::memory;
use crate::mesh::partition::Partition;
use crate::mesh::vector::Point;
use crate::remesh::crossings::crossings;
use crate::Result;

/// What passes through itself on the mesh: facets may do so as well.
#[derive(Debug)]
pub(super) struct Standing {
    /// The connected piece of each face.
    piece: Vec<u32>,
    /// Pieces that pass through each other.
    pieces: HashSet<[u32; 2]>,
    /// Faces that pass through others of their piece.
    passing: Vec<u32>,
}

impl Standing {
    pub(super) fn new(faces: &[[u32; 3]], places: &[[Point; 3]]) -> Result<Self> {
        let mut joined = Partition::new(faces.len())?;
        let mut first: HashMap<u32, u32> = HashMap::new();
        for (f, face) in (0..).zip(faces) {
            memory::extend_map(&mut first, 3)?;
            face.iter().for_each(|&v| joined.unite(*first.entry(v).or_insert(f), f));
        }
        let piece: Vec<u32> = memory::gathered((0..faces.len() as u32).map(|f| joined.root(f)))?;
        let of = |[i, j]: [u32; 2]| ordered(piece[i as usize], piece[j as usize]);
        let all = crossings(faces, places)?;
        let is_within = |&pair: &[u32; 2]| of(pair)[0] == of(pair)[1];
        let pieces = memory::distinct(all.iter().filter(|pair| !is_within(pair)).map(|&pair| of(pair)))?;
        let passing = memory::sifted(all.iter().filter(|pair| is_within(pair)).flatten().copied())?;
        Ok(Self { pieces, piece, passing })
    }

    /// Whether anything passes through anything.
    pub(super) fn is_any(&self) -> bool {
        !(self.pieces.is_empty() && self.passing.is_empty())
    }

    /// Whether the pieces of two faces pass through each other.
    pub(super) fn has(&self, f: u32, g: u32) -> bool {
        self.pieces.contains(&ordered(self.piece[f as usize], self.piece[g as usize]))
    }

    /// The labels of faces that pass through others of their piece.
    pub(super) fn labels(&self, labels: &[u32]) -> Result<HashSet<u32>> {
        Ok(memory::distinct(self.passing.iter().map(|&f| labels[f as usize]))?)
    }
}

fn ordered(p: u32, q: u32) -> [u32; 2] {
    [p.min(q), p.max(q)]
}
