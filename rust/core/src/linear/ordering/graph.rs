//! A weighted graph, its coarser versions and its parts.

use crate::buckets::Buckets;
use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::memory;
use crate::random::Random;
use crate::{Progress, Result};

/// An undirected graph with weights on vertices and edges; every edge stands at both of its ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Graph {
    /// Vertex `v` owns the neighbors `starts[v]..starts[v + 1]`.
    pub starts: Vec<u32>,
    /// The other end of each edge.
    pub neighbors: Vec<u32>,
    /// How many edges of the finest graph each edge stands for.
    pub edges: Vec<u32>,
    /// How many vertices of the finest graph each vertex stands for.
    pub weights: Vec<u32>,
}

/// No vertex.
const NONE: u32 = u32::MAX;

/// Vertices between two looks at whether to go on: some milliseconds.
const CHECK_EVERY: usize = 1 << 16;

impl Graph {
    /// The graph of a symmetric matrix; all weights are one.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub(super) fn new(pattern: &LowerPattern) -> std::result::Result<Self, SolveError> {
        let (starts, neighbors) = Buckets::new(pattern.n, |visit| {
            for j in 0..pattern.n {
                for &i in pattern.rows[pattern.starts[j]..pattern.starts[j + 1]].iter().filter(|&&i| i != j) {
                    visit(i, j as u32);
                    visit(j, i as u32);
                }
            }
        })?
        .into_parts();
        Ok(Self {
            starts: memory::gathered(starts.into_iter().map(|start| start as u32))?,
            edges: memory::repeated(1, neighbors.len())?,
            neighbors,
            weights: memory::repeated(1, pattern.n)?,
        })
    }

    /// Number of vertices.
    #[must_use]
    pub(super) fn n(&self) -> usize {
        self.weights.len()
    }

    /// The neighbors of `v`.
    #[must_use]
    pub(super) fn around(&self, v: usize) -> &[u32] {
        &self.neighbors[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// Merges vertices with the neighbor that most edges lead to, as long as the two weigh at most
    /// `heaviest`; also says which coarse vertex each vertex went into (heavy edge matching, Karypis and
    /// Kumar 1998).
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn coarsened(
        &self,
        heaviest: u32,
        random: &mut Random,
        progress: &Progress,
    ) -> Result<(Self, Vec<u32>)> {
        let n = self.n();
        let mut mate = vec![NONE; n];
        for (i, v) in random.permutation(n).into_iter().map(|v| v as u32).enumerate() {
            if i.is_multiple_of(CHECK_EVERY) {
                progress.check()?;
            }
            if mate[v as usize] != NONE {
                continue;
            }
            let range = self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize;
            let mut best = (0, v);
            for (&u, &edge) in self.neighbors[range.clone()].iter().zip(&self.edges[range]) {
                let fits = self.weights[u as usize] + self.weights[v as usize] <= heaviest;
                if edge > best.0 && mate[u as usize] == NONE && fits {
                    best = (edge, u);
                }
            }
            mate[v as usize] = best.1;
            mate[best.1 as usize] = v;
        }
        let mut map = vec![NONE; n];
        let mut firsts = Vec::with_capacity(n);
        for v in 0..n {
            if map[v] == NONE {
                map[v] = firsts.len() as u32;
                map[mate[v] as usize] = firsts.len() as u32;
                firsts.push(v as u32);
            }
        }
        Ok((self.contracted(&map, &firsts, &mate, progress)?, map))
    }

    fn contracted(&self, map: &[u32], firsts: &[u32], mate: &[u32], progress: &Progress) -> Result<Self> {
        let mut coarse =
            Self { starts: vec![0], neighbors: Vec::new(), edges: Vec::new(), weights: Vec::new() };
        coarse.neighbors.reserve(self.neighbors.len());
        coarse.edges.reserve(self.neighbors.len());
        let mut place = vec![NONE; firsts.len()];
        for (c, &v) in firsts.iter().enumerate() {
            if c.is_multiple_of(CHECK_EVERY) {
                progress.check()?;
            }
            let begin = coarse.neighbors.len() as u32;
            let pair = [v, mate[v as usize]];
            let members = if pair[0] == pair[1] { &pair[..1] } else { &pair[..] };
            for &v in members {
                for k in self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize {
                    let other = map[self.neighbors[k] as usize];
                    if other as usize == c {
                        continue;
                    }
                    let at = &mut place[other as usize];
                    if *at != NONE && *at >= begin {
                        coarse.edges[*at as usize] += self.edges[k];
                    } else {
                        *at = coarse.neighbors.len() as u32;
                        coarse.neighbors.push(other);
                        coarse.edges.push(self.edges[k]);
                    }
                }
            }
            coarse.starts.push(coarse.neighbors.len() as u32);
            coarse.weights.push(members.iter().map(|&v| self.weights[v as usize]).sum());
        }
        Ok(coarse)
    }

    /// The graph on the vertices `v` with `side[v] == which`, and which they are.
    #[must_use]
    pub(super) fn part(&self, side: &[u8], which: u8) -> (Self, Vec<u32>) {
        let members: Vec<u32> = (0..self.n() as u32).filter(|&v| side[v as usize] == which).collect();
        let mut place = vec![NONE; self.n()];
        for (k, &v) in members.iter().enumerate() {
            place[v as usize] = k as u32;
        }
        let mut part =
            Self { starts: vec![0], neighbors: Vec::new(), edges: Vec::new(), weights: Vec::new() };
        for &v in &members {
            for k in self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize {
                let u = place[self.neighbors[k] as usize];
                if u != NONE {
                    part.neighbors.push(u);
                    part.edges.push(self.edges[k]);
                }
            }
            part.starts.push(part.neighbors.len() as u32);
            part.weights.push(self.weights[v as usize]);
        }
        (part, members)
    }
}
