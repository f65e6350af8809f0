//! Vertices in the middle of others' border edges (T-junctions), and faces split there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::mesh::vector::{add, distance, dot, scale, sub, Point};
use crate::mesh::welding::{rounding, OF_EDGE};
use crate::mesh::{Connectivity, Mesh};
use crate::{memory, Result};

/// Border edges along which two sides meet in different vertices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TJunctions {
    /// The vertices in the middle of each border halfedge that has some, from its tail to its head.
    on: BTreeMap<usize, Vec<u32>>,
}

impl TJunctions {
    /// Finds the border vertices that lie on border edges (those with one face), up to the rounding of
    /// coordinates, where the two sides would share an edge if both were split there. Vertices in one place
    /// should be one ([`crate::mesh::Weld::of_seams`]). Nothing where there are none.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub fn find(connectivity: &Connectivity, positions: &[Point]) -> Result<Option<Self>> {
        let border: Vec<usize> = memory::sifted(connectivity.boundary())?;
        let ends = |h: usize| [connectivity.tail(h), connectivity.head(h)];
        let length = |h: usize| {
            let [a, b] = ends(h).map(|v| positions[v as usize]);
            distance(a, b)
        };
        let mean = border.iter().map(|&h| length(h)).sum::<f64>() / border.len().max(1) as f64;
        if !(mean > 0.0 && mean.is_finite()) {
            return Ok(None);
        }
        let vertices: BTreeSet<u32> = border.iter().flat_map(|&h| ends(h)).collect();
        let tolerance = rounding(vertices.iter().map(|&v| positions[v as usize]));
        let tree = Tree::new(positions, &vertices)?;
        let mut on = BTreeMap::new();
        for &h in &border {
            let [a, b] = ends(h).map(|v| positions[v as usize]);
            let (along, length) = (sub(b, a), length(h));
            let off = tolerance.min(OF_EDGE * length.min(mean));
            let place = |v: u32| {
                let p = positions[v as usize];
                let t = dot(sub(p, a), along) / dot(along, along);
                let inside = t * length > off && (1.0 - t) * length > off;
                (inside && distance(add(a, scale(along, t)), p) <= off).then_some((t, v))
            };
            let own = connectivity.faces()[h / 3];
            // Twice as far, so that rounding on the way loses none.
            let near = tree.near(a, b, 2.0 * tolerance).into_iter().filter(|v| !own.contains(v));
            let mut inside: Vec<(f64, u32)> = near.filter_map(place).collect();
            inside.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            if !inside.is_empty() {
                on.insert(h, inside.into_iter().map(|(_, v)| v).collect());
            }
        }
        Self { on }.matched(connectivity, &border)
    }

    /// Those at edges of which a part is a part of just one other edge.
    fn matched(mut self, connectivity: &Connectivity, border: &[usize]) -> Result<Option<Self>> {
        if self.on.is_empty() {
            return Ok(None);
        }
        let mut faces_at: HashMap<[u32; 2], u32> = HashMap::new();
        let parts = |h: usize, inside: &[u32]| -> Vec<[u32; 2]> {
            let chain: Vec<u32> = [connectivity.tail(h)]
                .into_iter()
                .chain(inside.iter().copied())
                .chain([connectivity.head(h)])
                .collect();
            chain.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]).collect()
        };
        for &h in border {
            for part in parts(h, self.on.get(&h).map_or(&[], Vec::as_slice)) {
                memory::extend_map(&mut faces_at, 1)?;
                *faces_at.entry(part).or_default() += 1;
            }
        }
        self.on.retain(|&h, inside| parts(h, inside).iter().any(|part| faces_at[part] == 2));
        Ok((!self.on.is_empty()).then_some(self))
    }

    /// The vertices in the middle of edges, ascending.
    #[must_use]
    pub fn vertices(&self) -> Vec<u32> {
        self.on.values().flatten().copied().collect::<BTreeSet<u32>>().into_iter().collect()
    }

    /// The mesh with its faces split at these vertices, so that the sides share edges.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn split(&self, mesh: &Mesh, positions: &[Point]) -> Result<SplitFaces> {
        let connectivity = mesh.connectivity();
        let (mut faces, mut parent, mut edge) = (Vec::new(), Vec::new(), Vec::new());
        for (f, &corners) in connectivity.faces().iter().enumerate() {
            let inside = [0, 1, 2].map(|i| self.on.get(&(3 * f + i)).cloned().unwrap_or_default());
            let mut left = vec![Piece { corners, inside, edge: [0, 1, 2].map(|i| Some((3 * f + i) as u32)) }];
            while let Some(piece) = left.pop() {
                match piece.halves() {
                    Some(halves) => left.extend(halves),
                    None => {
                        memory::push(&mut faces, piece.corners)?;
                        memory::push(&mut parent, f as u32)?;
                        memory::push(&mut edge, piece.edge)?;
                    }
                }
            }
        }
        Ok(SplitFaces { mesh: Mesh::new(memory::twin(positions)?, faces)?, parent, edge })
    }
}

/// A mesh with some faces split into several.
#[derive(Debug, Clone)]
pub struct SplitFaces {
    /// The vertices of the whole mesh, and its faces or parts of them.
    pub mesh: Mesh,
    /// The face of the whole mesh that each is a part of, ascending.
    pub parent: Vec<u32>,
    /// The halfedge of the whole mesh that each edge is a part of, column `i` opposite corner `i`;
    /// `None` for cuts through faces.
    pub edge: Vec<[Option<u32>; 3]>,
}

/// A part of a face, with the vertices that are still in the middle of its edges.
struct Piece {
    corners: [u32; 3],
    inside: [Vec<u32>; 3],
    edge: [Option<u32>; 3],
}

impl Piece {
    /// The two parts on either side of a vertex in the middle of an edge; nothing where there is none.
    fn halves(&self) -> Option<[Self; 2]> {
        let i = (0..3).find(|&i| !self.inside[i].is_empty())?;
        let [apex, tail, head] = [0, 1, 2].map(|k| (i + k) % 3);
        let along = &self.inside[i];
        let middle = along.len() / 2;
        let corner = [apex, tail, head].map(|k| self.corners[k]);
        let part = |corners, near: &[u32], kept: usize, place: usize| {
            let (mut inside, mut edge): ([Vec<u32>; 3], _) = (Default::default(), [self.edge[i], None, None]);
            inside[0] = near.to_vec();
            inside[place].clone_from(&self.inside[kept]);
            edge[place] = self.edge[kept];
            Self { corners, inside, edge }
        };
        Some([
            part([corner[0], corner[1], along[middle]], &along[..middle], head, 2),
            part([corner[0], along[middle], corner[2]], &along[middle + 1..], tail, 1),
        ])
    }
}

/// Vertices in a tree of boxes: thousands of long edges may meet where there are thousands of vertices, and a
/// grid as wide as edges are long has them all in one cell.
struct Tree<'a> {
    positions: &'a [Point],
    vertices: Vec<u32>,
    nodes: Vec<Node>,
}

/// Vertices of a tree from `start` to `end`. The first child follows its parent; 0 for the `second` of a
/// leaf.
struct Node {
    low: Point,
    high: Point,
    start: usize,
    end: usize,
    second: usize,
}

impl<'a> Tree<'a> {
    /// Vertices that a leaf holds.
    const LEAF: usize = 8;

    fn new(positions: &'a [Point], vertices: &BTreeSet<u32>) -> Result<Self> {
        let vertices = memory::gathered(vertices.iter().copied())?;
        let n = vertices.len();
        let mut tree = Self { positions, vertices, nodes: Vec::new() };
        tree.build(0, n)?;
        Ok(tree)
    }

    fn build(&mut self, start: usize, end: usize) -> Result<()> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in self.vertices[start..end].iter().map(|&v| self.positions[v as usize]) {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
            }
        }
        let node = self.nodes.len();
        memory::push(&mut self.nodes, Node { low, high, start, end, second: 0 })?;
        if end - start > Self::LEAF {
            let extent = sub(high, low);
            let axis = (1..3).fold(0, |most, c| if extent[c] > extent[most] { c } else { most });
            let middle = (end - start) / 2;
            let at = |v: u32| self.positions[v as usize][axis];
            self.vertices[start..end]
                .select_nth_unstable_by(middle, |&v, &w| at(v).total_cmp(&at(w)).then(v.cmp(&w)));
            self.build(start, start + middle)?;
            self.nodes[node].second = self.nodes.len();
            self.build(start + middle, end)?;
        }
        Ok(())
    }

    /// The vertices not farther than `off` from the segment from `a` to `b`, and others near it; ascending.
    fn near(&self, a: Point, b: Point, off: f64) -> Vec<u32> {
        let (mut found, mut stack) = (Vec::new(), vec![0]);
        while let Some(n) = stack.pop() {
            let node = &self.nodes[n];
            if !node.is_met(a, b, off) {
                continue;
            }
            if node.second == 0 {
                found.extend(&self.vertices[node.start..node.end]);
            } else {
                stack.extend([node.second, n + 1]);
            }
        }
        found.sort_unstable();
        found
    }
}

impl Node {
    /// Whether a segment comes as near as `off` to the box, or nearly so.
    fn is_met(&self, a: Point, b: Point, off: f64) -> bool {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for c in 0..3 {
            let along = b[c] - a[c];
            let (low, high) = (self.low[c] - off - a[c], self.high[c] + off - a[c]);
            if along == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
            } else {
                let (p, q) = (low / along, high / along);
                (from, to) = (from.max(p.min(q)), to.min(p.max(q)));
            }
        }
        from <= to
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::{triangle, Weld};
    use crate::shapes::{self, Shape};

    /// Two strips of `n` and `m` squares along the line x = 1, welded.
    fn strips(n: usize, m: usize) -> Mesh {
        let scaled = |k: usize, shift: f64| {
            shapes::grid(k, k).map(|[x, y, z]| [x / k as f64 + shift, y / k as f64, z / k as f64])
        };
        welded(&scaled(n, 0.0).and(&scaled(m, 1.0)))
    }

    fn welded(shape: &Shape) -> Mesh {
        let mesh = shape.mesh().unwrap();
        let weld = Weld::of_seams(mesh.connectivity(), &shape.vertices, None).unwrap().unwrap();
        Mesh::new(weld.firsts(&shape.vertices).unwrap(), weld.faces(&shape.faces).unwrap()).unwrap()
    }

    fn split(mesh: &Mesh) -> Option<(usize, SplitFaces)> {
        let positions = mesh.positions().unwrap();
        let found = TJunctions::find(mesh.connectivity(), positions).unwrap()?;
        Some((found.vertices().len(), found.split(mesh, positions).unwrap()))
    }

    #[test]
    fn two_strips_become_one_sheet() {
        for (n, m, count) in [(1, 2, 1), (6, 7, 11), (2, 4, 2)] {
            let mesh = strips(n, m);
            let (found, split) = split(&mesh).unwrap();
            assert_eq!(found, count);
            // Around both strips; the line between them is closed.
            assert_eq!(split.mesh.connectivity().boundary().count(), 3 * n + 3 * m);
            let area = |mesh: &Mesh| mesh.edge_lengths().iter().map(|&l| triangle::area(l)).sum::<f64>();
            assert!((area(&split.mesh) - area(&mesh)).abs() < 1e-12);
            assert!(!split.mesh.edge_lengths().iter().any(|&l| triangle::is_degenerate(l)));
            for (f, edges) in split.edge.iter().enumerate() {
                let parts = edges.iter().enumerate().filter_map(|(i, h)| h.map(|h| (i, h as usize)));
                assert!(parts.into_iter().all(|(_, h)| h / 3 == split.parent[f] as usize));
            }
        }
    }

    #[test]
    fn a_face_with_vertices_on_all_edges_is_split_on_all() {
        // A triangle among three that are each split in two at the middle of its edges.
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let middles = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let outer = [[1.0, -1.0, 0.0], [2.0, 2.0, 0.0], [-1.0, 1.0, 0.0]];
        let mut faces = vec![[0, 1, 2]];
        for i in 0..3_u32 {
            let next = (i + 1) % 3;
            faces.extend([[i, 6 + i, 3 + i], [3 + i, 6 + i, next]]);
        }
        let mesh = Mesh::new([corners, middles, outer].concat(), faces).unwrap();
        let (found, split) = split(&mesh).unwrap();
        assert_eq!((found, split.mesh.connectivity().n_faces()), (3, 10));
        assert_eq!(split.mesh.connectivity().boundary().count(), 6);
        assert_eq!(split.parent.iter().filter(|&&f| f == 0).count(), 4);
    }

    #[test]
    fn clean_meshes_and_sheets_that_only_touch_have_none() {
        for shape in [shapes::grid(5, 4), shapes::cube(3), shapes::grid(3, 3).and(&shapes::icosphere(1))] {
            assert_eq!(split(&shape.mesh().unwrap()).map(|found| found.0), None);
        }
        // A large sheet so far away that its coordinates hold no edge of the small one.
        let far = shapes::grid(40, 40).map(|p| p.map(|x| 1e6 * x + 1e18));
        assert_eq!(split(&shapes::grid(30, 30).and(&far).mesh().unwrap()).map(|found| found.0), None);
        // The corner of a sheet that stands on the border of another one.
        let standing = Mesh::new(
            vec![
                [0.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, -1.0, 1.0],
                [2.0, -1.0, 1.0],
            ],
            vec![[0, 1, 2], [3, 5, 4]],
        );
        assert_eq!(split(&standing.unwrap()).map(|found| found.0), None);
    }

    #[test]
    fn of_thousands_of_edges_that_meet_in_a_cell_each_has_few_vertices_near() {
        let n = 4000;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let tips = (0..n).map(|i| [angle(i).cos(), angle(i).sin(), 0.5]);
        let points: Vec<Point> = [[0.0; 3], [0.0, 0.0, 1.0]].into_iter().chain(tips).collect();
        let tree = Tree::new(&points, &(0..points.len() as u32).collect()).unwrap();
        for v in 2..points.len() as u32 {
            let near = tree.near(points[0], points[v as usize], 1e-12);
            assert!(near.contains(&0) && near.contains(&v) && near.len() <= 8 * Tree::LEAF, "{}", near.len());
        }
    }
}
