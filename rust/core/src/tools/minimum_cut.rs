//! The minimum cut of a small undirected graph between two sides, by augmenting shortest paths (Dinic 1970).

use std::collections::VecDeque;

/// A node that belongs to no side yet.
const UNSEEN: u32 = u32::MAX;

/// Flow below this part of the largest capacity is rounding.
const FLOW_ROUNDING: f64 = 1e-9;

/// An undirected graph with capacities.
pub(crate) struct Graph {
    /// For each node its arcs.
    arcs_of: Vec<Vec<u32>>,
    /// Where each arc leads; arc `i ^ 1` leads back.
    heads: Vec<u32>,
    /// What still fits through each arc.
    residual: Vec<f64>,
}

impl Graph {
    /// `n` nodes, and the edges with their capacities.
    pub(crate) fn new(n: usize, edges: &[([u32; 2], f64)]) -> Self {
        let mut arcs_of = vec![Vec::new(); n];
        let (mut heads, mut residual) =
            (Vec::with_capacity(2 * edges.len()), Vec::with_capacity(2 * edges.len()));
        for &([a, b], capacity) in edges {
            arcs_of[a as usize].push(heads.len() as u32);
            arcs_of[b as usize].push(heads.len() as u32 + 1);
            heads.extend([b, a]);
            residual.extend([capacity, capacity]);
        }
        Self { arcs_of, heads, residual }
    }

    /// Whether each node is on the side of node `source` of the least cut that parts it from node `sink`.
    pub(crate) fn cut(mut self, source: u32, sink: u32) -> Vec<bool> {
        let least = FLOW_ROUNDING * self.residual.iter().fold(0.0_f64, |most, x| most.max(*x));
        loop {
            let levels = self.levels(source, least);
            if levels[sink as usize] == UNSEEN {
                return levels.iter().map(|level| *level != UNSEEN).collect();
            }
            self.block(&levels, source, sink, least);
        }
    }

    /// Steps from the source to each node through arcs with room.
    fn levels(&self, source: u32, least: f64) -> Vec<u32> {
        let mut levels = vec![UNSEEN; self.arcs_of.len()];
        levels[source as usize] = 0;
        let mut queue = VecDeque::from([source]);
        while let Some(node) = queue.pop_front() {
            for &arc in &self.arcs_of[node as usize] {
                let head = self.heads[arc as usize] as usize;
                if self.residual[arc as usize] > least && levels[head] == UNSEEN {
                    levels[head] = levels[node as usize] + 1;
                    queue.push_back(head as u32);
                }
            }
        }
        levels
    }

    /// Fills all shortest paths.
    fn block(&mut self, levels: &[u32], source: u32, sink: u32, least: f64) {
        let mut next = vec![0; self.arcs_of.len()];
        let mut path: Vec<u32> = Vec::new();
        loop {
            let node = path.last().map_or(source, |arc| self.heads[*arc as usize]);
            if node == sink {
                let room =
                    path.iter().fold(f64::INFINITY, |least, arc| least.min(self.residual[*arc as usize]));
                for &arc in &path {
                    self.residual[arc as usize] -= room;
                    self.residual[arc as usize ^ 1] += room;
                }
                let full = path.iter().position(|arc| self.residual[*arc as usize] <= least);
                path.truncate(full.unwrap_or(0));
                continue;
            }
            let arcs = &self.arcs_of[node as usize];
            let onward = arcs[next[node as usize]..].iter().position(|&arc| {
                let head = self.heads[arc as usize] as usize;
                self.residual[arc as usize] > least && levels[head] == levels[node as usize] + 1
            });
            if let Some(skipped) = onward {
                next[node as usize] += skipped;
                path.push(arcs[next[node as usize]]);
            } else {
                next[node as usize] = arcs.len();
                let Some(back) = path.pop() else { return };
                next[self.heads[back as usize ^ 1] as usize] += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_at_the_bottleneck() {
        // 0 = 1 - 2 = 3, and a way around over 4.
        let edges = [([0, 1], 3.0), ([1, 2], 1.0), ([2, 3], 3.0), ([0, 4], 0.5), ([4, 3], 2.0)];
        assert_eq!(Graph::new(5, &edges).cut(0, 3), [true, true, false, false, false]);
    }

    #[test]
    fn sides_without_a_way_between_them_need_no_cut() {
        assert_eq!(Graph::new(3, &[([0, 1], 1.0)]).cut(0, 2), [true, true, false]);
    }
}
