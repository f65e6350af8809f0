//! Boundary loops: the rims of holes.

use std::collections::HashMap;

use crate::mesh::connectivity::{next, previous};
use crate::mesh::vector::{add, centroid, cross, dot, scale, sub, unit, Point};
use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

/// The walks along the edges with exactly one face.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Walks {
    /// Those that close, as cycles of vertices without repeats.
    pub loops: Vec<Vec<u32>>,
    /// Those that end, on both sides, at an edge with three faces or more, in the order of their vertices.
    pub chains: Vec<Vec<u32>>,
}

/// The boundary loops, each a cycle of vertices without repeats.
///
/// - A rim consists of edges with exactly one face ([`EdgeKind::Boundary`]). Edges with three or more faces
///   have no twin either, but they are no holes: a walk that ends at one, as on the pages of an open book, is
///   left out.
/// - A loop runs as the faces' halfedges do: seen from outside, clockwise around a hole. Where two faces
///   disagree on their orientation the walk goes on across their edge, against the halfedges from there on: a
///   Möbius strip has one loop.
/// - At a vertex that two fans of faces share, the walk goes on along the other side of the gap that it runs
///   around: holes that touch at their corners are loops of their own. Loops that still visit a vertex twice
///   are split there: two triangles that touch at a vertex have two loops.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn boundary_loops(connectivity: &Connectivity) -> Result<Vec<Vec<u32>>> {
    Ok(boundary_walks(connectivity, None)?.loops)
}

/// All walks along the boundary: see [`boundary_loops`]. With `positions`, gaps between more than two fans at
/// a vertex are told apart as well, by the order of the fans around it; without, the walk stays at its fan
/// there.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn boundary_walks(connectivity: &Connectivity, positions: Option<&[Point]>) -> Result<Walks> {
    let mut visited = memory::repeated(false, connectivity.n_halfedges())?;
    let gaps = Gaps::new(connectivity, positions)?;
    let step =
        |(h, forward): (usize, bool)| gaps.across(h, forward).or_else(|| own_fan(connectivity, h, forward));
    let place = memory::repeated(0, connectivity.n_vertices())?;
    let mut splitter = Splitter { loops: Vec::new(), place };
    let mut chains = Vec::new();
    for start in connectivity.boundary() {
        if visited[start] {
            continue;
        }
        visited[start] = true;
        let mut walk = vec![connectivity.tail(start)];
        let mut at = (start, true);
        let is_closed = loop {
            match step(at) {
                Some((h, _)) if h == start => break true,
                Some((h, _)) if visited[h] => break false,
                Some((h, forward)) => {
                    visited[h] = true;
                    memory::push(
                        &mut walk,
                        if forward { connectivity.tail(h) } else { connectivity.head(h) },
                    )?;
                    at = (h, forward);
                }
                None => break false,
            }
        };
        if is_closed {
            splitter.push(&walk)?;
            continue;
        }
        walk.push(if at.1 { connectivity.head(at.0) } else { connectivity.tail(at.0) });
        // What lies before the edge that was met first.
        at = (start, false);
        walk.reverse();
        while let Some((h, forward)) = step(at).filter(|&(h, _)| !visited[h]) {
            visited[h] = true;
            walk.push(if forward { connectivity.head(h) } else { connectivity.tail(h) });
            at = (h, forward);
        }
        walk.reverse();
        memory::push(&mut chains, walk)?;
    }
    Ok(Walks { loops: splitter.loops, chains })
}

/// The boundary halfedge after `h`, found by turning about the vertex where `h` (run backward unless
/// `forward`) ends, and whether it is run forward; nothing if the fan of faces ends at an edge that is no
/// boundary.
fn own_fan(connectivity: &Connectivity, h: usize, forward: bool) -> Option<(usize, bool)> {
    let (mut edge, mut leaves) = if forward { (next(h), true) } else { (previous(h), false) };
    while let Some(mate) = connectivity.mate(edge) {
        // `leaves`: whether the halfedge starts at the vertex. Twins run opposite ways.
        let mate_leaves = leaves != (connectivity.kind(edge) == EdgeKind::Interior);
        (edge, leaves) = if mate_leaves { (previous(mate), false) } else { (next(mate), true) };
    }
    (connectivity.kind(edge) == EdgeKind::Boundary).then_some((edge, leaves))
}

/// The two sides of each gap at vertices that several fans share.
#[derive(Default)]
struct Gaps {
    /// The halfedge that leaves the vertex on the other side of the gap, for those that end there,
    /// and the other way round.
    leaving: HashMap<usize, usize>,
    arriving: HashMap<usize, usize>,
}

impl Gaps {
    fn new(connectivity: &Connectivity, positions: Option<&[Point]>) -> Result<Self> {
        let mut gaps = Self::default();
        // Where faces disagree there is no order around a vertex.
        if connectivity.has_any(&[EdgeKind::Inconsistent]) {
            return Ok(gaps);
        }
        let mut n_fans = memory::repeated(0_u8, connectivity.n_vertices())?;
        connectivity.boundary().for_each(|h| {
            let count = &mut n_fans[connectivity.head(h) as usize];
            *count = count.saturating_add(1);
        });
        let mut fans: HashMap<u32, Vec<[usize; 2]>> = HashMap::new();
        for h in connectivity.boundary().filter(|&h| n_fans[connectivity.head(h) as usize] > 1) {
            if let Some((leaving, _)) = own_fan(connectivity, h, true) {
                memory::extend_map(&mut fans, 1)?;
                fans.entry(connectivity.head(h)).or_default().push([h, leaving]);
            }
        }
        for (vertex, mut fans) in fans {
            match (fans.len(), positions) {
                (0 | 1, _) => continue,
                (2, _) => {}
                (_, None) => continue,
                (_, Some(positions)) => order_around(connectivity, positions, vertex, &mut fans),
            }
            memory::extend_map(&mut gaps.leaving, fans.len())?;
            memory::extend_map(&mut gaps.arriving, fans.len())?;
            for (i, &[arriving, _]) in fans.iter().enumerate() {
                let [_, leaving] = fans[(i + 1) % fans.len()];
                gaps.leaving.insert(arriving, leaving);
                gaps.arriving.insert(leaving, arriving);
            }
        }
        Ok(gaps)
    }

    fn across(&self, h: usize, forward: bool) -> Option<(usize, bool)> {
        let side = if forward { &self.leaving } else { &self.arriving };
        side.get(&h).map(|&h| (h, forward))
    }
}

/// Sorts the fans, each by the halfedges that arrive at the vertex and leave it,
/// counterclockwise seen from outside.
fn order_around(connectivity: &Connectivity, positions: &[Point], vertex: u32, fans: &mut [[usize; 2]]) {
    let at = positions[vertex as usize];
    let middle = |&[arriving, leaving]: &[usize; 2]| {
        let [a, b] = [arriving, leaving]
            .map(|h| unit(sub(centroid(connectivity.faces()[h / 3].map(|v| positions[v as usize])), at)));
        add(a, b)
    };
    let normal = fans.iter().flatten().fold([0.0; 3], |sum, &h| {
        let [a, b, c] = connectivity.faces()[h / 3].map(|v| positions[v as usize]);
        add(sum, unit(cross(sub(b, a), sub(c, a))))
    });
    let (first, normal) = (middle(&fans[0]), unit(normal));
    let up = cross(normal, first);
    let angle = |fan: &[usize; 2]| {
        let direction = middle(fan);
        let angle = dot(direction, up).atan2(dot(direction, first));
        if angle < 0.0 {
            angle + std::f64::consts::TAU
        } else {
            angle
        }
    };
    // The first is the origin, whatever rounding says.
    fans[1..].sort_by(|a, b| angle(a).total_cmp(&angle(b)));
}

/// Splits closed walks at the vertices that they visit twice.
struct Splitter {
    loops: Vec<Vec<u32>>,
    /// Where each vertex is in the walk so far, from 1 on; 0 if it is not.
    place: Vec<u32>,
}

impl Splitter {
    fn push(&mut self, walk: &[u32]) -> Result<()> {
        let mut open: Vec<u32> = memory::room(walk.len())?;
        for &vertex in walk {
            let place = self.place[vertex as usize] as usize;
            if place > 0 {
                let closed = memory::twin(&open[place - 1..])?;
                open.truncate(place - 1);
                self.close(closed)?;
            }
            open.push(vertex);
            self.place[vertex as usize] = open.len() as u32;
        }
        self.close(open)
    }

    fn close(&mut self, vertices: Vec<u32>) -> Result<()> {
        for &vertex in &vertices {
            self.place[vertex as usize] = 0;
        }
        Ok(memory::push(&mut self.loops, vertices)?)
    }
}

/// The edges of a closed loop.
pub(crate) fn cycle(vertices: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Half the sum of the cross products of successive positions:
/// the area vector of any surface that the loop bounds.
pub(crate) fn loop_area_vector(vertices: &[u32], positions: &[Point]) -> Point {
    let Some(&first) = vertices.first() else { return [0.0; 3] };
    let at = |v: u32| sub(positions[v as usize], positions[first as usize]);
    cycle(vertices).fold([0.0; 3], |sum, [a, b]| add(sum, scale(cross(at(a), at(b)), 0.5)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::{grid, Shape};

    /// A grid of cells, of two triangles each, without some of its cells.
    fn without(n: usize, cells: &[[usize; 2]]) -> Shape {
        grid(n, n).without_faces(|f| cells.contains(&[f / 2 % n, f / 2 / n]))
    }

    fn lengths(shape: &Shape) -> Vec<usize> {
        let mesh = shape.mesh().unwrap();
        let mut lengths: Vec<usize> = boundary_walks(mesh.connectivity(), mesh.positions())
            .unwrap()
            .loops
            .iter()
            .map(Vec::len)
            .collect();
        lengths.sort_unstable();
        lengths
    }

    #[test]
    fn holes_of_a_checkerboard_are_loops_of_their_own() {
        let cells: Vec<[usize; 2]> =
            (0..36).map(|k| [k % 6 + 2, k / 6 + 2]).filter(|[i, j]| (i + j) % 2 == 1).collect();
        let mut expected = vec![4; 18];
        expected.push(40);
        assert_eq!(lengths(&without(10, &cells)), expected);
    }

    #[test]
    fn three_fans_at_a_vertex_have_three_gaps() {
        // A hexagon around vertex 0 without every other triangle.
        let at = |k: usize| {
            let angle = std::f64::consts::FRAC_PI_3 * k as f64;
            [angle.cos(), angle.sin(), 0.0]
        };
        let mut vertices = vec![[0.0; 3]];
        vertices.extend((0..6).map(at));
        vertices.extend((0..6).map(at).map(|p| p.map(|x| 2.0 * x)));
        let mut faces = vec![[0, 1, 2], [0, 3, 4], [0, 5, 6]];
        for k in 0..6_u32 {
            let (a, b) = (1 + k, 1 + (k + 1) % 6);
            faces.extend([[a, a + 6, b + 6], [a, b + 6, b]]);
        }
        assert_eq!(lengths(&Shape { vertices, faces }), [3, 3, 3, 6]);
    }

    #[test]
    fn a_walk_that_ends_at_an_inner_wall_is_a_chain() {
        // Two pages of four faces each and a third one at the same spine.
        let page = grid(2, 1);
        let mut shape = page.clone();
        let spine = [0, 3];
        for angle in [2.0, 4.0] {
            let turned = page.clone().rotated([0.0, 1.0, 0.0], angle);
            let offset = shape.vertices.len() as u32;
            shape.vertices.extend(&turned.vertices);
            let number = |v: u32| if spine.contains(&v) { v } else { offset + v };
            shape.faces.extend(turned.faces.iter().map(|face| face.map(number)));
        }
        let mesh = shape.mesh().unwrap();
        let walks = boundary_walks(mesh.connectivity(), mesh.positions()).unwrap();
        assert!(walks.loops.is_empty());
        assert_eq!(walks.chains.len(), 3);
        for chain in &walks.chains {
            assert_eq!(chain.len(), 6);
            let mut ends = [chain[0], chain[5]];
            ends.sort_unstable();
            assert_eq!(ends, spine);
        }
    }
}
