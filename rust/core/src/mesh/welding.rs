//! Joining the sides of split seams: vertices on open borders that lie in one place, up to rounding.

use std::collections::HashMap;

use crate::mesh::partition::Partition;
use crate::mesh::vector::{distance, place, sub, Point};
use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

/// The sides of a seam differ by the rounding of its coordinates:
/// files of six digits lose this part of the shape's size.
const SIX_DIGITS: f64 = 1e-5;

/// Units in the last place by which coordinates of one place may differ: each was rounded once or twice.
const UNITS: f64 = 4.0;

/// Nothing is joined over more than this part of the shortest border edge there: it would not be rounding.
pub(super) const OF_EDGE: f64 = 0.1;

/// Which vertices are one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Weld {
    /// The welded vertex of every vertex.
    pub vertex: Vec<u32>,
    /// The first vertex of every welded one, ascending: welded vertices keep the order of these.
    pub first: Vec<u32>,
}

impl Weld {
    /// Welds vertices on open borders (edges with one face) whose coordinates differ by no more than
    /// `tolerance` each. Without one they may differ by the rounding of their coordinates: a
    /// hundred-thousandth of the shape's size, as files of six digits have it, or four units in the last
    /// place (of single precision, where all coordinates have it), but a tenth of the shortest border edge
    /// there at most. All others stay as they are. Nothing where none are welded.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub fn of_seams(
        connectivity: &Connectivity,
        positions: &[Point],
        tolerance: Option<f64>,
    ) -> Result<Option<Self>> {
        let mut reach: HashMap<u32, f64> = HashMap::new();
        for h in connectivity.boundary() {
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            let length = distance(positions[tail as usize], positions[head as usize]);
            memory::extend_map(&mut reach, 2)?;
            for v in [tail, head] {
                reach
                    .entry(v)
                    .and_modify(|least| *least = least.min(OF_EDGE * length))
                    .or_insert(OF_EDGE * length);
            }
        }
        if reach.is_empty() {
            return Ok(None);
        }
        let tolerance = match tolerance {
            Some(tolerance) => {
                reach.values_mut().for_each(|least| *least = f64::INFINITY);
                tolerance
            }
            None => rounding(reach.keys().map(|&v| positions[v as usize])),
        };
        let mut border: Vec<(u32, f64)> =
            memory::gathered(reach.into_iter().map(|(v, least)| (v, least.min(tolerance))))?;
        border.sort_unstable_by_key(|&(v, _)| v);
        let mut partition = Partition::new(positions.len())?;
        if !unite_near(&border, positions, tolerance, &mut partition)? {
            return Ok(None);
        }
        Ok(Some(Self::of(partition, positions.len())?))
    }

    /// This weld, or none, with the ends of sides of length 0 joined as well: clamped bevels and decimated
    /// scans leave faces without area there. As before where an edge would have more than two faces then.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn contracted(
        before: Option<Self>,
        connectivity: &Connectivity,
        positions: &[Point],
    ) -> Result<Option<Self>> {
        let at = |v: u32| place(positions[v as usize]);
        let is_side = |h: &usize| connectivity.tail(*h) != connectivity.head(*h);
        let sides = 0..3 * connectivity.n_faces();
        let named = sides.filter(is_side).map(|h| [connectivity.tail(h), connectivity.head(h)]);
        let mut short = named.filter(|[a, b]| at(*a) == at(*b)).peekable();
        if short.peek().is_none() {
            return Ok(before);
        }
        let mut partition = Partition::new(positions.len())?;
        if let Some(weld) = &before {
            (0..).zip(&weld.vertex).for_each(|(v, &w)| partition.unite(v, weld.first[w as usize]));
        }
        short.for_each(|[a, b]| partition.unite(a, b));
        let weld = Self::of(partition, positions.len())?;
        let crowded = |weld: Option<&Self>| -> Result<bool> {
            let Some(weld) = weld else { return Ok(connectivity.has_any(&[EdgeKind::NonManifold])) };
            let joined = Connectivity::new(weld.faces(connectivity.faces())?, weld.first.len())?;
            Ok(joined.has_any(&[EdgeKind::NonManifold]))
        };
        Ok(if crowded(Some(&weld))? && !crowded(before.as_ref())? { before } else { Some(weld) })
    }

    /// What is one in `partition`.
    fn of(mut partition: Partition, n: usize) -> Result<Self> {
        let mut weld = Self { vertex: memory::room(n)?, first: Vec::new() };
        for v in 0..n as u32 {
            let root = partition.root(v);
            if root == v {
                weld.vertex.push(weld.first.len() as u32);
                memory::push(&mut weld.first, v)?;
            } else {
                // Roots are least elements: theirs is known.
                weld.vertex.push(weld.vertex[root as usize]);
            }
        }
        Ok(weld)
    }

    /// The faces in welded vertices. One whose corners became one names a vertex twice.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn faces(&self, faces: &[[u32; 3]]) -> Result<Vec<[u32; 3]>> {
        Ok(memory::gathered(faces.iter().map(|face| face.map(|v| self.vertex[v as usize])))?)
    }

    /// The entries of the first vertices.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn firsts<T: Copy>(&self, entries: &[T]) -> Result<Vec<T>> {
        Ok(memory::gathered(self.first.iter().map(|&v| entries[v as usize]))?)
    }
}

/// How far apart roundings of one place may be, by the `points` that were rounded: those on borders, so that
/// a closed surface of any size costs nothing.
pub(super) fn rounding(points: impl Iterator<Item = Point>) -> f64 {
    let (mut low, mut high, mut largest) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
    let mut is_single = true;
    for p in points {
        #[allow(clippy::cast_possible_truncation, clippy::float_cmp)]
        let single = p.iter().all(|&x| f64::from(x as f32) == x);
        is_single &= single;
        for c in 0..3 {
            low[c] = low[c].min(p[c]);
            high[c] = high[c].max(p[c]);
            largest = largest.max(p[c].abs());
        }
    }
    let size = sub(high, low).into_iter().fold(0.0, f64::max);
    let unit = if is_single { f64::from(f32::EPSILON) } else { f64::EPSILON };
    (SIX_DIGITS * size).max(UNITS * unit * largest)
}

/// Unites vertices, each with its own reach, that are no farther apart in any coordinate;
/// returns whether there were any.
fn unite_near(
    border: &[(u32, f64)],
    positions: &[Point],
    tolerance: f64,
    partition: &mut Partition,
) -> Result<bool> {
    let origin = positions[border[0].0 as usize];
    let width = tolerance.max(f64::MIN_POSITIVE);
    // Cells as wide as the tolerance: what is near lies in the next one at most. Beyond 2^53 of them cells
    // are not neighbors, but then coordinates are not told apart either.
    let cell = |v: u32| sub(positions[v as usize], origin).map(|x| (x / width).floor());
    let mut cells: HashMap<[u64; 3], Vec<(u32, f64)>> = HashMap::new();
    memory::extend_map(&mut cells, border.len())?;
    let mut any = false;
    for &(v, reach) in border {
        let at = cell(v);
        for step in 0..27 {
            let near = [
                at[0] + f64::from(step % 3 - 1),
                at[1] + f64::from(step / 3 % 3 - 1),
                at[2] + f64::from(step / 9 - 1),
            ];
            for &(w, other) in cells.get(&place(near)).into_iter().flatten() {
                let apart = sub(positions[v as usize], positions[w as usize])
                    .into_iter()
                    .fold(0.0, |a: f64, x| a.max(x.abs()));
                if apart <= reach.min(other) {
                    partition.unite(v, w);
                    any = true;
                }
            }
        }
        cells.entry(place(at)).or_default().push((v, reach));
    }
    Ok(any)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::{self, Random, Shape};

    /// Every triangle with vertices of its own, each coordinate off by up to `rounding`.
    fn soup(shape: &Shape, rounding: f64) -> Shape {
        let mut random = Random::new(5);
        let vertices: Vec<Point> =
            shape.faces.iter().flatten().map(|&v| shape.vertices[v as usize]).collect();
        let faces = (0..shape.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        Shape { vertices, faces }.map(|p| p.map(|x| x + rounding * random.symmetric()))
    }

    fn welded(shape: &Shape, tolerance: Option<f64>) -> Option<Weld> {
        let mesh = shape.mesh().unwrap();
        Weld::of_seams(mesh.connectivity(), mesh.positions().unwrap(), tolerance).unwrap()
    }

    #[test]
    fn a_soup_of_triangles_becomes_the_mesh_that_it_was() {
        let shape = shapes::icosphere(2);
        for rounding in [0.0, 1e-7, 1e-6] {
            for shift in [0.0, 5e5, 1e7] {
                let soup = soup(&shape, rounding).map(|p| p.map(|x| x + shift));
                let weld = welded(&soup, None).unwrap();
                assert_eq!(weld.first.len(), shape.vertices.len(), "{rounding} {shift}");
                assert!(weld.first.is_sorted());
                let closed = Connectivity::new(weld.faces(&soup.faces).unwrap(), weld.first.len()).unwrap();
                assert_eq!(closed.boundary().count(), 0);
            }
        }
    }

    #[test]
    fn gaps_that_are_no_rounding_stay() {
        assert_eq!(welded(&soup(&shapes::icosphere(2), 1e-3), None), None);
        assert!(welded(&soup(&shapes::icosphere(2), 1e-3), Some(2e-3)).is_some());
        // Inner vertices in one place are two sheets, not a seam.
        assert_eq!(welded(&shapes::icosphere(1).and(&shapes::icosphere(1)), None), None);
    }

    #[test]
    fn fine_details_far_from_the_origin_are_not_rounding() {
        let tiny = shapes::grid(4, 4).map(|p| p.map(|x| 1e-7 * x));
        let large = shapes::grid(1, 1).map(|[x, y, z]| [10.0 * x + 5.0, y, z]);
        assert_eq!(welded(&tiny.and(&large), None), None);
    }

    #[test]
    fn single_precision_far_away_is_taken_for_what_it_is() {
        let shape = shapes::grid(6, 6);
        let far = soup(&shape, 0.01).map(|p| p.map(|x| f64::from((x + 5e5) as f32)));
        let weld = welded(&far, None).unwrap();
        assert_eq!(weld.first.len(), shape.vertices.len());
    }

    /// The first side of `shape` that `is_such` holds for, of length 0.
    fn pinched(mut shape: Shape, is_such: impl Fn(Point, Point) -> bool) -> Shape {
        let sides = shape.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let at = |v: u32| shape.vertices[v as usize];
        let [a, b] = sides.into_iter().find(|&[a, b]| is_such(at(a), at(b))).unwrap();
        shape.vertices[b as usize] = at(a);
        shape
    }

    #[test]
    fn sides_of_length_0_are_contracted_but_no_edge_gets_more_than_two_faces() {
        let contracted = |shape: &Shape| {
            let connectivity = Connectivity::new(shape.faces.clone(), shape.vertices.len()).unwrap();
            Weld::contracted(None, &connectivity, &shape.vertices).unwrap()
        };
        let cube = shapes::cube(3);
        assert_eq!(contracted(&cube), None);
        let weld = contracted(&pinched(cube.clone(), |_, _| true)).unwrap();
        assert_eq!(weld.first.len(), cube.vertices.len() - 1);
        let faces = weld.faces(&cube.faces).unwrap();
        assert_eq!(faces.iter().filter(|f| f[0] == f[1] || f[1] == f[2] || f[2] == f[0]).count(), 2);
        assert_eq!(Connectivity::new(faces, weld.first.len()).unwrap().boundary().count(), 0);
        // A tube of three sides: across a side around it, both its ends have the third as their neighbor.
        let radius = |p: Point| p[0].hypot(p[1]);
        let tube = shapes::torus(8, 3, 2.0, 0.5);
        let around = |p: Point, q: Point| {
            (p[0] * q[1] - p[1] * q[0]).abs() < 1e-9
                && (radius(p) - radius(q)).abs() + (p[2] - q[2]).abs() > 0.1
        };
        assert_eq!(contracted(&pinched(tube, around)), None);
    }
}
