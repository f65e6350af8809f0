//! What a remeshing must keep: borders, feature edges, corners, fixed vertices.

use std::collections::{HashMap, HashSet};

use crate::memory;
use crate::mesh::vector::{dot, norm, sub, Point};
use crate::remesh::closest::ClosestPoint;
use crate::remesh::{key, Edge, EditableMesh};
use crate::Result;

/// A vertex where a border or feature line turns by more than this (45 degrees) is a corner, and stays.
pub(crate) const CORNER_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How far a vertex may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// On the surface.
    Free,
    /// On the curve of that number.
    Curve(u32),
    /// Not at all.
    Fixed,
    /// Not at all, and no edge at it may collapse: it is not a manifold vertex.
    Pinched,
}

/// Borders and feature lines, as edges of the mesh under edit and as the segments that they were at first.
#[derive(Debug)]
pub(crate) struct Curves {
    /// The curve of every edge on one.
    edges: HashMap<[u32; 2], u32>,
    /// Edges that stay as they are.
    locked: HashSet<[u32; 2]>,
    /// The segments of every curve.
    segments: Vec<ClosestPoint>,
}

/// What is fixed and what counts as a feature.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Keep<'a> {
    /// The vertices that stay.
    pub(crate) fixed: &'a [bool],
    /// Whether faces with three such vertices stay too.
    pub(crate) fixed_faces: bool,
    /// Edges whose faces' normals have less than this cosine are features.
    pub(crate) feature_cosine: f64,
    /// Edges, smaller vertex first, that are features in any case.
    pub(crate) features: Option<&'a HashSet<[u32; 2]>>,
}

impl Curves {
    /// The curves of `mesh` and the role of every vertex.
    ///
    /// Border and feature edges are curves; those between two fixed vertices, non-manifold edges, and the
    /// edges of faces that stay are locked. A vertex is on a curve where exactly two curve edges meet without
    /// a corner; other vertices of curve or locked edges are fixed.
    pub(crate) fn new(mesh: &EditableMesh, keep: &Keep) -> Result<(Self, Vec<Role>)> {
        let (mut lines, mut locked) = (Vec::new(), HashSet::new());
        let mut ends = memory::repeated(Vec::new(), mesh.n_vertices())?;
        let mut roles =
            memory::gathered(keep.fixed.iter().map(|&f| if f { Role::Fixed } else { Role::Free }))?;
        let is_fixed = |v: u32| keep.fixed[v as usize];
        for [a, b] in mesh.edges()? {
            let is_line = match mesh.edge(a, b) {
                Edge::None => false,
                Edge::NonManifold => {
                    memory::extend_set(&mut locked, 1)?;
                    locked.insert([a, b]);
                    [a, b].iter().for_each(|&v| roles[v as usize] = Role::Pinched);
                    false
                }
                Edge::Border(..) => true,
                Edge::Interior(wings) => {
                    let [m, n] = wings.faces.map(|f| mesh.area_vector(f));
                    dot(m, n) < keep.feature_cosine * norm(m) * norm(n)
                        || keep.features.is_some_and(|features| features.contains(&[a, b]))
                }
            };
            if is_line && is_fixed(a) && is_fixed(b) {
                memory::extend_set(&mut locked, 1)?;
                locked.insert([a, b]);
            } else if is_line {
                memory::push(&mut lines, [a, b])?;
                ends[a as usize].push(b);
                ends[b as usize].push(a);
            }
        }
        if keep.fixed_faces {
            for (_, [a, b, c]) in mesh.faces().filter(|(_, face)| face.iter().all(|&v| is_fixed(v))) {
                memory::extend_set(&mut locked, 3)?;
                locked.extend([key(a, b), key(b, c), key(c, a)]);
            }
        }
        for v in 0..mesh.n_vertices() as u32 {
            if !mesh.is_manifold(v) {
                roles[v as usize] = Role::Pinched;
            } else if roles[v as usize] == Role::Free && !is_smooth(mesh, v, &ends[v as usize]) {
                roles[v as usize] = Role::Fixed;
            }
        }
        let (edges, count) = number_curves(&lines, &ends, &mut roles)?;
        // A tree for each: in one tree for all, the closest of one curve is searched for among those of all
        // others.
        let mut segments: Vec<Vec<[Point; 3]>> = memory::repeated(Vec::new(), count as usize)?;
        for line @ &[a, b] in &lines {
            if let Some(&curve) = edges.get(line) {
                memory::push(&mut segments[curve as usize], mesh.corners([a, b, b]))?;
            }
        }
        let mut trees = memory::room(segments.len())?;
        for of_curve in segments {
            trees.push(ClosestPoint::new(of_curve)?);
        }
        Ok((Self { edges, locked, segments: trees }, roles))
    }

    /// The curve that the edge is on.
    pub(crate) fn curve(&self, a: u32, b: u32) -> Option<u32> {
        self.edges.get(&key(a, b)).copied()
    }

    /// Whether the edge must stay.
    pub(crate) fn is_locked(&self, a: u32, b: u32) -> bool {
        self.locked.contains(&key(a, b))
    }

    /// The edges that must stay, ascending.
    pub(crate) fn locked_edges(&self) -> Result<Vec<[u32; 2]>> {
        let mut edges = memory::gathered(self.locked.iter().copied())?;
        edges.sort_unstable();
        Ok(edges)
    }

    /// The point of `curve` closest to `p`.
    pub(crate) fn project(&self, curve: u32, p: Point) -> Point {
        self.segments[curve as usize].closest(p, None, |_| true).map_or(p, |found| found.point)
    }

    /// Puts edges onto a curve in place of an old one.
    pub(crate) fn replace(&mut self, old: [u32; 2], new: &[[u32; 2]], curve: u32) -> Result<()> {
        memory::extend_map(&mut self.edges, new.len())?;
        self.edges.remove(&key(old[0], old[1]));
        self.edges.extend(new.iter().map(|&[a, b]| (key(a, b), curve)));
        Ok(())
    }
}

/// Whether `v` is on no line, or on one that passes through it without a corner.
fn is_smooth(mesh: &EditableMesh, v: u32, ends: &[u32]) -> bool {
    match *ends {
        [] => true,
        [a, b] => {
            let (before, after) =
                (sub(mesh.position(v), mesh.position(a)), sub(mesh.position(b), mesh.position(v)));
            dot(before, after) > CORNER_COSINE * norm(before) * norm(after)
        }
        _ => false,
    }
}

/// Numbers the curves: lines that meet at a vertex that is free to move along them are one. Gives those
/// vertices their role. Returns the curve of every line, and how many there are.
fn number_curves(
    lines: &[[u32; 2]],
    ends: &[Vec<u32>],
    roles: &mut [Role],
) -> Result<(HashMap<[u32; 2], u32>, u32)> {
    let mut number: HashMap<[u32; 2], u32> = HashMap::new();
    memory::extend_map(&mut number, lines.len())?;
    let mut count = 0;
    for &line in lines {
        if number.contains_key(&line) {
            continue;
        }
        number.insert(line, count);
        for [mut at, mut from] in [line, [line[1], line[0]]] {
            while roles[at as usize] == Role::Free {
                roles[at as usize] = Role::Curve(count);
                let Some(&following) = ends[at as usize].iter().find(|&&w| w != from) else { break };
                number.insert(key(at, following), count);
                (from, at) = (at, following);
            }
        }
        count += 1;
    }
    Ok((number, count))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_point_comes_back_onto_its_own_curve_though_another_is_closer() {
        let triangle = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let positions = [triangle(0.0), triangle(0.1)].concat();
        let mesh = EditableMesh::new(positions, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        let keep = Keep { fixed: &[false; 6], fixed_faces: false, feature_cosine: -2.0, features: None };
        let (curves, roles) = Curves::new(&mesh, &keep).unwrap();
        assert_eq!(roles, [Role::Fixed; 6], "every corner is one");
        for (edge, z) in [([0, 1], 0.0), ([3, 4], 0.1)] {
            let curve = curves.curve(edge[0], edge[1]).unwrap();
            for close in [-0.05, 0.02, 0.09, 0.2] {
                assert_eq!(curves.project(curve, [0.25, 0.1, close]), [0.25, 0.0, z]);
            }
        }
    }
}
