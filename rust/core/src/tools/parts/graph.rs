//! A weighted graph of patches of a surface: faces, or clusters of faces, and what a border between two of
//! them costs.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::constants::ROUNDING;
use crate::buckets::Buckets;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, distance, scale, Point};
use crate::ordered::Ordered;
use crate::{memory, Result};

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// Two patches that touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    /// The length of the border between them.
    pub length: f64,
    /// What that border costs: its length, or less where it runs through a hollow.
    pub cost: f64,
    /// The distance between their centers.
    pub distance: f64,
}

/// Patches with areas, and the edges between those that touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Graph {
    pub areas: Vec<f64>,
    pub centers: Vec<Point>,
    /// The logarithm of the thickness under each, or nothing where it does not count.
    thickness: Vec<f64>,
    /// How many faces each is made of, or nothing where each is one.
    faces: Vec<u32>,
    pub edges: Vec<Edge>,
    /// The edges of each node: the other node, and the edge.
    arcs: Buckets<[u32; 2]>,
}

impl Graph {
    /// The graph of these nodes and edges.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`], as of all that makes arrays here.
    pub(super) fn new(areas: Vec<f64>, centers: Vec<Point>, mut edges: Vec<Edge>) -> Result<Self> {
        for edge in &mut edges {
            edge.cost = edge.cost.max(ROUNDING);
            edge.distance = edge.distance.max(ROUNDING);
        }
        let arcs = Buckets::new(areas.len(), |visit| {
            for (i, edge) in (0_u32..).zip(&edges) {
                let [a, b] = edge.ends;
                visit(a as usize, [b, i]);
                visit(b as usize, [a, i]);
            }
        })?;
        Ok(Self { areas, centers, thickness: Vec::new(), faces: Vec::new(), edges, arcs })
    }

    /// The same with the logarithm of the thickness under each node.
    pub(super) fn with_thickness(self, thickness: Vec<f64>) -> Self {
        Self { thickness, ..self }
    }

    /// The logarithm of the thickness under node `i`.
    pub(super) fn thickness(&self, i: usize) -> f64 {
        self.thickness.get(i).copied().unwrap_or(0.0)
    }

    /// How many faces node `i` is made of.
    pub(super) fn faces(&self, i: usize) -> u32 {
        self.faces.get(i).copied().unwrap_or(1)
    }

    /// The same nodes with other edges.
    pub(super) fn with_edges(&self, edges: Vec<Edge>) -> Result<Self> {
        let (thickness, faces) = (memory::twin(&self.thickness)?, memory::twin(&self.faces)?);
        let same = Self::new(memory::twin(&self.areas)?, memory::twin(&self.centers)?, edges)?;
        Ok(Self { thickness, faces, ..same })
    }

    pub(super) fn n_nodes(&self) -> usize {
        self.areas.len()
    }

    pub(super) fn area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// The nodes next to `i`, each with the edge that leads there.
    pub(super) fn around(&self, i: u32) -> &[[u32; 2]] {
        self.arcs.of(i as usize)
    }

    /// The graph of some nodes, renumbered in their order; `place` has a row for every node, all [`NONE`],
    /// and is left so.
    pub(super) fn subgraph(&self, nodes: &[u32], place: &mut [u32]) -> Result<Self> {
        (0..).zip(nodes).for_each(|(i, &node)| place[node as usize] = i);
        let mut edges = Vec::new();
        for (i, &node) in (0_u32..).zip(nodes) {
            for &[other, e] in self.around(node) {
                let other = place[other as usize];
                // Each edge is met from both ends; from its first one it is kept.
                if other != NONE && self.edges[e as usize].ends[0] == node {
                    memory::push(&mut edges, Edge { ends: [i, other], ..self.edges[e as usize] })?;
                }
            }
        }
        nodes.iter().for_each(|&node| place[node as usize] = NONE);
        let centers = memory::gathered(nodes.iter().map(|&i| self.centers[i as usize]))?;
        let areas = of_nodes(&self.areas, nodes)?;
        let (thickness, faces) = (of_nodes(&self.thickness, nodes)?, of_nodes(&self.faces, nodes)?);
        Ok(Self { thickness, faces, ..Self::new(areas, centers, edges)? })
    }

    /// The graph of `n` clusters, given the one of each node: costs add up.
    pub(super) fn quotient(&self, labels: &[u32], n: usize) -> Result<Self> {
        let mut areas = memory::repeated(0.0, n)?;
        let mut centers = memory::repeated([0.0; 3], n)?;
        let mut thickness = memory::repeated(0.0, n)?;
        let mut faces = memory::repeated(0_u32, n)?;
        for (i, &label) in labels.iter().enumerate() {
            areas[label as usize] += self.areas[i];
            centers[label as usize] = add(centers[label as usize], scale(self.centers[i], self.areas[i]));
            thickness[label as usize] += self.areas[i] * self.thickness(i);
            faces[label as usize] += self.faces(i);
        }
        thickness.iter_mut().zip(&areas).for_each(|(thickness, area)| *thickness /= area);
        centers.iter_mut().zip(&areas).for_each(|(center, area)| *center = scale(*center, 1.0 / area));
        let mut borders: BTreeMap<[u32; 2], [f64; 2]> = BTreeMap::new();
        for edge in &self.edges {
            let [a, b] = edge.ends.map(|end| labels[end as usize]);
            if a != b {
                let [length, cost] = borders.entry([a.min(b), a.max(b)]).or_default();
                *length += edge.length;
                *cost += edge.cost;
            }
        }
        let apart = |[a, b]: [u32; 2]| distance(centers[a as usize], centers[b as usize]);
        let edges = borders.into_iter().map(|(ends, [length, cost])| Edge {
            ends,
            length,
            cost,
            distance: apart(ends),
        });
        let edges = memory::gathered(edges)?;
        Ok(Self { thickness, faces, ..Self::new(areas, centers, edges)? })
    }

    /// The connected pieces over the edges that `keep` takes, numbered in the order of their first nodes,
    /// and how many there are.
    pub(super) fn pieces(&self, keep: impl Fn(&Edge) -> bool) -> Result<(Vec<u32>, usize)> {
        let mut partition = Partition::new(self.n_nodes())?;
        self.edges.iter().filter(|e| keep(e)).for_each(|e| partition.unite(e.ends[0], e.ends[1]));
        let mut names = memory::repeated(NONE, self.n_nodes())?;
        let mut count = 0;
        // The root of a set is its least element, so it is met first.
        let piece = memory::sifted((0..self.n_nodes() as u32).map(|i| {
            let name = &mut names[partition.root(i) as usize];
            if *name == NONE {
                *name = count;
                count += 1;
            }
            *name
        }))?;
        Ok((piece, count as usize))
    }

    /// For each node the distance to the nearest of `seeds` along edges as long as `length` says, and
    /// which seed that is: up to `limit`, beyond it infinity and [`NONE`] (Dijkstra 1959).
    pub(super) fn nearest(
        &self,
        seeds: &[u32],
        limit: f64,
        length: impl Fn(&Edge) -> f64,
    ) -> Result<(Vec<f64>, Vec<u32>)> {
        let mut distances = memory::repeated(f64::INFINITY, self.n_nodes())?;
        let mut nearest = memory::repeated(NONE, self.n_nodes())?;
        let mut heap = BinaryHeap::new();
        memory::extend_heap(&mut heap, seeds.len())?;
        for (i, &seed) in (0_u32..).zip(seeds) {
            (distances[seed as usize], nearest[seed as usize]) = (0.0, i);
            heap.push(Reverse((Ordered(0.0), seed)));
        }
        while let Some(Reverse((Ordered(far), node))) = heap.pop() {
            if far > distances[node as usize] {
                continue;
            }
            for &[other, e] in self.around(node) {
                let next = far + length(&self.edges[e as usize]);
                if next <= limit && next < distances[other as usize] {
                    distances[other as usize] = next;
                    nearest[other as usize] = nearest[node as usize];
                    memory::extend_heap(&mut heap, 1)?;
                    heap.push(Reverse((Ordered(next), other)));
                }
            }
        }
        Ok((distances, nearest))
    }
}

/// The values of these nodes; nothing where there are none.
fn of_nodes<T: Copy>(values: &[T], nodes: &[u32]) -> Result<Vec<T>> {
    Ok(memory::sifted(nodes.iter().filter_map(|&i| values.get(i as usize).copied()))?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn path() -> Graph {
        let edge = |a: u32, cost| Edge { ends: [a, a + 1], length: 3.0, cost, distance: 1.0 };
        let edges = vec![edge(0, 3.0), edge(1, 1.0), edge(2, 3.0)];
        Graph::new(vec![1.0; 4], (0..4).map(|i| [f64::from(i), 0.0, 0.0]).collect(), edges).unwrap()
    }

    #[test]
    fn parts_and_clusters_keep_areas_and_costs() {
        let graph = path();
        let mut place = vec![NONE; 4];
        let part = graph.subgraph(&[1, 2, 3], &mut place).unwrap();
        assert_eq!((part.n_nodes(), part.edges.len(), part.edges[1].cost), (3, 2, 3.0));
        assert!(place.iter().all(|p| *p == NONE));
        let halves = graph.quotient(&[0, 0, 1, 1], 2).unwrap();
        assert_eq!(halves.areas, [2.0, 2.0]);
        assert_eq!(halves.edges, [Edge { ends: [0, 1], length: 3.0, cost: 1.0, distance: 2.0 }]);
    }

    #[test]
    fn pieces_and_distances_follow_the_edges() {
        let graph = path();
        assert_eq!(graph.pieces(|edge| edge.cost > 2.0).unwrap(), (vec![0, 0, 1, 1], 2));
        let (distances, nearest) = graph.nearest(&[0], 2.5, |edge| edge.distance).unwrap();
        assert_eq!(distances, [0.0, 1.0, 2.0, f64::INFINITY]);
        assert_eq!(nearest, [0, 0, 0, NONE]);
    }
}
