//! Boundary loops: the rims of holes.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::vector::{add, cross, scale, sub, Point};
use crate::mesh::{Connectivity, EdgeKind};

/// The boundary loops, each a cycle of vertices without repeats.
///
/// - A rim consists of edges with exactly one face ([`EdgeKind::Boundary`]). Edges with three or more faces have no twin
///   either, but they are no holes: a walk that ends at one, as on the pages of an open book, is left out.
/// - A loop runs as the faces' halfedges do: seen from outside, clockwise around a hole. Where two faces disagree on
///   their orientation the walk goes on across their edge, against the halfedges from there on: a Möbius strip has one
///   loop.
/// - At a vertex that several fans of faces share, the walk stays in its fan; loops that then visit a vertex twice are
///   split there. Two triangles that touch at a vertex have two loops, and so have two holes that touch at a vertex.
#[must_use]
pub fn boundary_loops(connectivity: &Connectivity) -> Vec<Vec<u32>> {
    let mut visited = vec![false; connectivity.n_halfedges()];
    let mut splitter = Splitter { loops: Vec::new(), place: vec![0; connectivity.n_vertices()] };
    for start in connectivity.boundary() {
        if visited[start] {
            continue;
        }
        let mut walk = Vec::new();
        let mut at = (start, true);
        loop {
            let (h, forward) = at;
            visited[h] = true;
            walk.push(if forward { connectivity.tail(h) } else { connectivity.head(h) });
            match step(connectivity, h, forward) {
                Some((h, _)) if h == start => {
                    splitter.push(&walk);
                    break;
                }
                Some((h, _)) if visited[h] => break,
                Some(following) => at = following,
                None => break,
            }
        }
    }
    splitter.loops
}

/// The boundary halfedge after `h`, found by turning about the vertex where `h` (run backward unless `forward`) ends, and
/// whether it is run forward; nothing if the fan of faces ends at an edge that is no boundary.
fn step(connectivity: &Connectivity, h: usize, forward: bool) -> Option<(usize, bool)> {
    let (mut edge, mut leaves) = if forward { (next(h), true) } else { (previous(h), false) };
    while let Some(mate) = connectivity.mate(edge) {
        // `leaves`: whether the halfedge starts at the vertex. Twins run opposite ways.
        let mate_leaves = leaves != (connectivity.kind(edge) == EdgeKind::Interior);
        (edge, leaves) = if mate_leaves { (previous(mate), false) } else { (next(mate), true) };
    }
    (connectivity.kind(edge) == EdgeKind::Boundary).then_some((edge, leaves))
}

/// Splits closed walks at the vertices that they visit twice.
struct Splitter {
    loops: Vec<Vec<u32>>,
    /// Where each vertex is in the walk so far, from 1 on; 0 if it is not. Memory of zeros costs nothing where it is not read.
    place: Vec<u32>,
}

impl Splitter {
    fn push(&mut self, walk: &[u32]) {
        let mut open: Vec<u32> = Vec::with_capacity(walk.len());
        for &vertex in walk {
            let place = self.place[vertex as usize] as usize;
            if place > 0 {
                self.close(open.split_off(place - 1));
            }
            open.push(vertex);
            self.place[vertex as usize] = open.len() as u32;
        }
        self.close(open);
    }

    fn close(&mut self, vertices: Vec<u32>) {
        for &vertex in &vertices {
            self.place[vertex as usize] = 0;
        }
        self.loops.push(vertices);
    }
}

/// The edges of a closed loop.
pub(crate) fn cycle(vertices: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Half the sum of the cross products of successive positions: the area vector of any surface that the loop bounds.
pub(crate) fn loop_area_vector(vertices: &[u32], positions: &[Point]) -> Point {
    let Some(&first) = vertices.first() else { return [0.0; 3] };
    let at = |v: u32| sub(positions[v as usize], positions[first as usize]);
    cycle(vertices).fold([0.0; 3], |sum, [a, b]| add(sum, scale(cross(at(a), at(b)), 0.5)))
}
