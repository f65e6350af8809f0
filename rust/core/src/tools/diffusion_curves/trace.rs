//! Curves drawn freely over a surface, as paths along its edges.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::buckets::Buckets;
use crate::error::MeshError;
use crate::memory::{self, Tool};
use crate::mesh::vector::{add, distance, scale, Point};
use crate::mesh::{Connectivity, EdgeTable, Mesh};
use crate::ordered::Ordered;
use crate::remesh::closest::{closest_on_segment, ClosestPoint};
use crate::unit::Unit;
use crate::{Error, Result};

/// A path along the edges of a mesh that follows a line of points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TracedCurve {
    /// The vertices along the path; of a closed one the first does not come last again.
    pub vertices: Vec<u32>,
    /// Where each vertex lies along the line: `i + t` between point `i` and the next, ascending.
    pub places: Vec<f64>,
}

/// Paths along edges that follow lines of points on or near the surface.
///
/// Every point goes to the nearest corner of the nearest face, and between them the path of least
/// `Σ length (1 + (d/h)²)` is taken, `d` the distance of an edge's middle from the straight line between the
/// points and `h` the mean edge: a shortest path that keeps to the line (Dijkstra 1959). `closed` lines
/// return from their last point to the first. Steps forth and back over the same edge are left out.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`]; [`Error::Argument`] for points that are not finite and
/// two points in a row on parts that no edges join.
pub fn trace_curves(mesh: &Mesh, curves: &[(Vec<Point>, bool)]) -> Result<Vec<TracedCurve>> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    if connectivity.n_faces() == 0 {
        return Err(MeshError::NoFaces.into());
    }
    mesh.demand(Tool::Curves).admit(None)?;
    let unit =
        Unit::of(positions.iter().chain(curves.iter().flat_map(|(points, _)| points)).flatten().copied());
    if !unit.is_one() {
        let measured = |(points, closed): &(Vec<Point>, bool)| {
            (points.iter().map(|p| p.map(|x| unit.measure(x))).collect(), *closed)
        };
        return trace_curves(mesh.measured(unit)?.as_ref(), &curves.iter().map(measured).collect::<Vec<_>>());
    }
    let faces = connectivity.faces();
    let places = faces.iter().map(|face| face.map(|v| positions[v as usize]));
    let tree = ClosestPoint::new(memory::gathered(places)?)?;
    let snapped = |p: Point| {
        let face = faces[tree.closest(p, None, |_| true)?.triangle as usize];
        let away = |v: u32| distance(positions[v as usize], p);
        face.into_iter().min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)))
    };
    let mut search = Search::new(connectivity, positions)?;
    let mut row = 0;
    curves
        .iter()
        .map(|(points, closed)| {
            let first = row;
            row += points.len();
            if let Some(i) = points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
                return Err(Error::argument(
                    "points",
                    format!("row {} is not finite; every number must be", first + i),
                ));
            }
            let vertices = memory::sifted(points.iter().filter_map(|&p| snapped(p)))?;
            search.curve(points, &vertices, *closed, first)
        })
        .collect()
}

/// The edges around every vertex, and what a search marks.
struct Search<'a> {
    positions: &'a [Point],
    neighbors: Buckets<u32>,
    mean_edge: f64,
    /// For each vertex the search that reached it, its cost, and the vertex before it.
    seen: Vec<(u32, f64, u32)>,
    stamp: u32,
}

impl<'a> Search<'a> {
    fn new(connectivity: &Connectivity, positions: &'a [Point]) -> Result<Self> {
        let table = EdgeTable::new(connectivity)?;
        let ends = |h: usize| [connectivity.tail(h), connectivity.head(h)];
        let edges = memory::sifted(table.edges().filter_map(|mut edge| edge.next()).map(ends))?;
        let neighbors = Buckets::new(positions.len(), |visit| {
            for &[a, b] in &edges {
                visit(a as usize, b);
                visit(b as usize, a);
            }
        })?;
        let total: f64 =
            edges.iter().map(|&[a, b]| distance(positions[a as usize], positions[b as usize])).sum();
        let mean_edge = (total / edges.len().max(1) as f64).max(f64::MIN_POSITIVE);
        let seen = memory::repeated((0, 0.0, 0), positions.len())?;
        Ok(Self { positions, neighbors, mean_edge, seen, stamp: 0 })
    }

    /// The path over `vertices`, which stand for `points`; `first` is the row of the first point.
    fn curve(
        &mut self,
        points: &[Point],
        vertices: &[u32],
        closed: bool,
        first: usize,
    ) -> Result<TracedCurve> {
        let mut traced = TracedCurve::default();
        let Some(&start) = vertices.first() else { return Ok(traced) };
        traced.push(start, 0.0)?;
        let n = vertices.len();
        let spans = if closed && n > 1 { n } else { n - 1 };
        for i in 0..spans {
            let j = (i + 1) % n;
            let Some(path) = self.path(vertices[i], vertices[j], [points[i], points[j]])? else {
                let problem = format!("rows {} and {} lie on parts that no edges join", first + i, first + j);
                return Err(Error::argument("points", problem));
            };
            let lengths = memory::gathered(path.windows(2).map(|pair| self.length(pair[0], pair[1])))?;
            let total = lengths.iter().sum::<f64>().max(f64::MIN_POSITIVE);
            let mut done = 0.0;
            for (&v, length) in path[1..].iter().zip(lengths) {
                done += length;
                traced.push(v, i as f64 + (done / total).min(1.0))?;
            }
        }
        if closed {
            traced.close();
        }
        Ok(traced)
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        distance(self.positions[a as usize], self.positions[b as usize])
    }

    /// The cheapest path from `from` to `to`, both included; nothing if there is none.
    fn path(&mut self, from: u32, to: u32, line: [Point; 2]) -> Result<Option<Vec<u32>>> {
        self.stamp += 1;
        let stamp = self.stamp;
        let mut heap = BinaryHeap::from([Reverse((Ordered(0.0), from))]);
        self.seen[from as usize] = (stamp, 0.0, from);
        while let Some(Reverse((Ordered(cost), vertex))) = heap.pop() {
            if vertex == to {
                let mut path = vec![to];
                let mut v = to;
                while v != from {
                    v = self.seen[v as usize].2;
                    memory::push(&mut path, v)?;
                }
                path.reverse();
                return Ok(Some(path));
            }
            if cost > self.seen[vertex as usize].1 {
                continue;
            }
            for k in 0..self.neighbors.of(vertex as usize).len() {
                let next = self.neighbors.of(vertex as usize)[k];
                let there = cost + self.cost(vertex, next, line);
                let held = &mut self.seen[next as usize];
                if held.0 != stamp || there < held.1 {
                    *held = (stamp, there, vertex);
                    memory::extend_heap(&mut heap, 1)?;
                    heap.push(Reverse((Ordered(there), next)));
                }
            }
        }
        Ok(None)
    }

    fn cost(&self, a: u32, b: u32, line: [Point; 2]) -> f64 {
        let middle = scale(add(self.positions[a as usize], self.positions[b as usize]), 0.5);
        let away = distance(middle, closest_on_segment(middle, line[0], line[1])) / self.mean_edge;
        self.length(a, b) * (1.0 + away * away)
    }
}

impl TracedCurve {
    /// Goes on to vertex `v`, or back to it.
    fn push(&mut self, v: u32, place: f64) -> Result<()> {
        let n = self.vertices.len();
        if self.vertices.last() == Some(&v) {
            return Ok(());
        }
        if n >= 2 && self.vertices[n - 2] == v {
            self.vertices.pop();
            self.places.pop();
            return Ok(());
        }
        memory::push(&mut self.vertices, v)?;
        Ok(memory::push(&mut self.places, place)?)
    }

    /// Takes away what comes twice where a closed path meets its start.
    fn close(&mut self) {
        while self.vertices.len() > 1 && self.vertices.first() == self.vertices.last() {
            self.vertices.pop();
            self.places.pop();
            // Forth from the start and back to it again.
            if self.vertices.len() > 2 && self.vertices.get(1) == self.vertices.last() {
                self.vertices.remove(0);
                self.places.remove(0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes;

    fn traced(points: &[Point], closed: bool) -> TracedCurve {
        let mesh = shapes::grid(8, 8).mesh().unwrap();
        trace_curves(&mesh, &[(points.to_vec(), closed)]).unwrap().remove(0)
    }

    fn places(curve: &TracedCurve) -> Vec<Point> {
        let mesh = shapes::grid(8, 8).mesh().unwrap();
        curve.vertices.iter().map(|&v| mesh.positions().unwrap()[v as usize]).collect()
    }

    #[test]
    fn a_straight_line_near_a_row_of_edges_is_that_row() {
        let positions = shapes::grid(8, 8).vertices;
        let [a, b] = [positions[0], positions[8]];
        let shift = |p: Point, z: f64| [p[0], p[1], p[2] + z];
        let curve = traced(&[shift(a, 0.01), shift(b, -0.02)], false);
        assert_eq!(curve.vertices, (0..9).collect::<Vec<u32>>());
        let expected: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0).collect();
        assert!(curve.places.iter().zip(expected).all(|(p, q)| (p - q).abs() < 1e-12));
    }

    #[test]
    fn paths_keep_to_the_line_and_run_along_edges() {
        let positions = shapes::grid(8, 8).vertices;
        let line = [positions[0], positions[4 * 9 + 8]];
        let curve = traced(&line, false);
        let size = distance(positions[0], positions[1]);
        assert_eq!((curve.vertices.first(), curve.vertices.last()), (Some(&0), Some(&44)));
        assert!(places(&curve)
            .iter()
            .all(|&p| distance(p, closest_on_segment(p, line[0], line[1])) < 0.75 * size));
        let mesh = shapes::grid(8, 8).mesh().unwrap();
        let table = EdgeTable::new(mesh.connectivity()).unwrap();
        assert!(curve.vertices.windows(2).all(|pair| table.between(pair[0], pair[1]).next().is_some()));
        assert!(curve.places.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn closed_lines_return_and_ways_back_are_left_out() {
        let positions = shapes::grid(8, 8).vertices;
        let corners = [0, 8, 80, 72].map(|v: usize| positions[v]);
        let curve = traced(&corners, true);
        assert_eq!(curve.vertices.len(), 32);
        assert!(curve.vertices[1..].iter().all(|v| *v != curve.vertices[0]));
        let spike = traced(&[positions[0], positions[3], positions[1]], false);
        assert_eq!(spike.vertices, [0, 1]);
        let forth_and_back = traced(&[positions[0], positions[3]], true);
        assert_eq!(forth_and_back.vertices.len(), 1);
        assert_eq!(traced(&[positions[5]], false).vertices, [5]);
        assert_eq!(traced(&[], true), TracedCurve::default());
    }

    #[test]
    fn points_apart_are_refused_by_their_rows() {
        let grid = shapes::grid(2, 2);
        let far = shapes::grid(2, 2).map(|[x, y, z]| [x, y, z + 5.0]);
        let mesh = grid.and(&far).mesh().unwrap();
        let ends = [0, 9].map(|v: usize| mesh.positions().unwrap()[v]);
        let error = trace_curves(&mesh, &[(vec![ends[0]], false), (ends.to_vec(), false)]).unwrap_err();
        assert!(error.to_string().contains("rows 1 and 2"), "{error}");
        let error = trace_curves(&mesh, &[(vec![[f64::NAN, 0.0, 0.0]], false)]).unwrap_err();
        assert!(error.to_string().contains("row 0 is not finite"), "{error}");
    }
}
