//! Vertices in the middle of others' border edges (T-junctions), and faces split there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::mesh::vector::{add, between, distance, dot, norm, scale, sub, Point};
use crate::mesh::welding::{rounding, OF_EDGE};
use crate::mesh::{Connectivity, Mesh};
use crate::{memory, Result};

/// A segment of a cell, with a tenth of one on either side, begins and ends so many cells apart at most.
const MOST_CELLS: i64 = 2;

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
        let cell = border.iter().map(|&h| length(h)).sum::<f64>() / border.len().max(1) as f64;
        if !(cell > 0.0 && cell.is_finite()) {
            return Ok(None);
        }
        let vertices: BTreeSet<u32> = border.iter().flat_map(|&h| ends(h)).collect();
        let tolerance = rounding(vertices.iter().map(|&v| positions[v as usize]));
        let grid = Grid::new(positions, &vertices, cell)?;
        let mut on = BTreeMap::new();
        for &h in &border {
            let [a, b] = ends(h).map(|v| positions[v as usize]);
            let (along, length) = (sub(b, a), length(h));
            let off = tolerance.min(OF_EDGE * length.min(cell));
            let place = |v: u32| {
                let p = positions[v as usize];
                let t = dot(sub(p, a), along) / dot(along, along);
                let inside = t * length > off && (1.0 - t) * length > off;
                (inside && distance(add(a, scale(along, t)), p) <= off).then_some((t, v))
            };
            let own = connectivity.faces()[h / 3];
            let near = grid.near(a, b, off).into_iter().filter(|v| !own.contains(v));
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

/// Vertices by cells.
struct Grid {
    cells: HashMap<[i64; 3], Vec<u32>>,
    origin: Point,
    cell: f64,
}

impl Grid {
    fn new(positions: &[Point], vertices: &BTreeSet<u32>, cell: f64) -> Result<Self> {
        let origin = vertices.first().map_or([0.0; 3], |&v| positions[v as usize]);
        let mut grid = Self { cells: HashMap::new(), origin, cell };
        for &v in vertices {
            memory::extend_map(&mut grid.cells, 1)?;
            grid.cells.entry(grid.key(positions[v as usize])).or_default().push(v);
        }
        Ok(grid)
    }

    #[allow(clippy::cast_possible_truncation)]
    fn key(&self, p: Point) -> [i64; 3] {
        sub(p, self.origin).map(|x| (x / self.cell).floor() as i64)
    }

    /// The vertices in the cells that the segment from `a` to `b` runs through, and not farther off than
    /// `off`, at least; ascending.
    fn near(&self, a: Point, b: Point, off: f64) -> BTreeSet<u32> {
        let steps = (norm(sub(b, a)) / self.cell).ceil().max(1.0) as usize;
        let mut found = BTreeSet::new();
        for k in 0..steps {
            let [p, q] = [k, k + 1].map(|k| between(a, b, k as f64 / steps as f64));
            let low = self.key([0, 1, 2].map(|c| p[c].min(q[c]) - off));
            let high = self.key([0, 1, 2].map(|c| p[c].max(q[c]) + off));
            // No more than a cell long: what takes more of them is rounding, so far from the origin that
            // places are not told apart.
            if [0, 1, 2].iter().any(|&c| high[c].saturating_sub(low[c]) > MOST_CELLS) {
                continue;
            }
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        found.extend(self.cells.get(&[x, y, z]).into_iter().flatten());
                    }
                }
            }
        }
        found
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
}
