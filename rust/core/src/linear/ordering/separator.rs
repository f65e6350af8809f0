//! Small sets of vertices that cut a graph in two: found on a coarse version, refined on every finer one
//! (Karypis and Kumar 1998; moves with a look ahead as Fiduccia and Mattheyses 1982).

use std::collections::BinaryHeap;

use crate::linear::ordering::graph::Graph;
use crate::random::Random;
use crate::{Progress, Result};

/// The side that stands for the separator; the others are 0 and 1.
pub(super) const SEPARATOR: u8 = 2;

/// The heavier side may have this part of the weight.
const HEAVIER_SIDE: f64 = 0.6;

/// Moves that do not pay before a pass ends, and passes.
const PATIENCE: usize = 200;
const PASSES: usize = 8;

/// The side of each vertex: 0, 1 or [`SEPARATOR`]; no edge joins 0 and 1.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn separator(graph: &Graph, random: &mut Random, progress: &Progress) -> Result<Vec<u8>> {
    /// Graphs are coarsened to so many vertices.
    const COARSEST: usize = 40;
    /// A coarser graph with more than this part of the vertices is not worth its while.
    const WORTH_COARSENING: f64 = 0.95;
    let total: u64 = graph.weights.iter().map(|&w| u64::from(w)).sum();
    let heaviest = (1.5 * total as f64 / COARSEST as f64).max(2.0) as u32;
    let (mut levels, mut maps): (Vec<Graph>, Vec<Vec<u32>>) = (Vec::new(), Vec::new());
    loop {
        let fine = levels.last().unwrap_or(graph);
        if fine.n() <= COARSEST {
            break;
        }
        let (coarse, map) = fine.coarsened(heaviest, random, progress)?;
        if coarse.n() as f64 > WORTH_COARSENING * fine.n() as f64 {
            break;
        }
        levels.push(coarse);
        maps.push(map);
    }
    let mut side = first(levels.last().unwrap_or(graph), random, progress)?;
    while let Some(map) = maps.pop() {
        levels.pop();
        side = map.iter().map(|&c| side[c as usize]).collect();
        refine(levels.last().unwrap_or(graph), &mut side, progress)?;
    }
    Ok(side)
}

/// The best of a few separators grown from random vertices.
fn first(graph: &Graph, random: &mut Random, progress: &Progress) -> Result<Vec<u8>> {
    /// First separators that are tried on the coarsest graph.
    const TRIES: usize = 4;
    let mut best: Option<((bool, u64), Vec<u8>)> = None;
    for _ in 0..TRIES {
        let mut side = grown(graph, random);
        let score = refine(graph, &mut side, progress)?;
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, side));
        }
    }
    Ok(best.map_or_else(Vec::new, |(_, side)| side))
}

/// Side 0 grows around a random vertex to half of the weight; its outer vertices are the separator.
fn grown(graph: &Graph, random: &mut Random) -> Vec<u8> {
    let n = graph.n();
    let total: u64 = graph.weights.iter().map(|&w| u64::from(w)).sum();
    let mut side = vec![1; n];
    let (mut queue, mut next, mut weight) = (Vec::new(), 0, 0);
    let mut seen = vec![false; n];
    while 2 * weight < total && queue.len() <= n {
        if next == queue.len() {
            // Nothing yet, or a component is full: go on at another vertex.
            let start = random.below(n);
            let Some(v) = (start..n).chain(0..start).find(|&v| !seen[v]) else {
                break;
            };
            seen[v] = true;
            queue.push(v as u32);
        }
        let v = queue[next] as usize;
        next += 1;
        side[v] = 0;
        weight += u64::from(graph.weights[v]);
        for &u in graph.around(v) {
            if !std::mem::replace(&mut seen[u as usize], true) {
                queue.push(u);
            }
        }
    }
    for v in 0..n {
        if side[v] == 0 && graph.around(v).iter().any(|&u| side[u as usize] == 1) {
            side[v] = SEPARATOR;
        }
    }
    side
}

/// Makes the separator lighter by moving vertices off it; returns whether the sides are too unlike,
/// and its weight.
fn refine(graph: &Graph, side: &mut [u8], progress: &Progress) -> Result<(bool, u64)> {
    let mut refinement = Refinement::new(graph, side);
    for _ in 0..PASSES {
        progress.check()?;
        if !refinement.pass() {
            break;
        }
    }
    Ok(refinement.score())
}

struct Refinement<'g> {
    graph: &'g Graph,
    side: &'g mut [u8],
    /// The weights of both sides and of the separator.
    total: [u64; 3],
    /// The most that a side may weigh.
    limit: u64,
    /// By how much lighter the separator gets when a vertex moves to side 0 or 1.
    gains: [Vec<i64>; 2],
    queues: [BinaryHeap<(i64, u32)>; 2],
    moved: Vec<bool>,
    /// Vertex and side of each move, and the vertices that it pulled into the separator.
    log: Vec<(u32, u8, usize)>,
    pulled: Vec<u32>,
}

impl<'g> Refinement<'g> {
    fn new(graph: &'g Graph, side: &'g mut [u8]) -> Self {
        let mut total = [0; 3];
        for (&side, &weight) in side.iter().zip(&graph.weights) {
            total[side as usize] += u64::from(weight);
        }
        let limit = (HEAVIER_SIDE * total.iter().sum::<u64>() as f64) as u64;
        let n = graph.n();
        Self {
            graph,
            side,
            total,
            limit,
            gains: [vec![0; n], vec![0; n]],
            queues: [BinaryHeap::new(), BinaryHeap::new()],
            moved: vec![false; n],
            log: Vec::new(),
            pulled: Vec::new(),
        }
    }

    fn score(&self) -> (bool, u64) {
        (self.total[0].max(self.total[1]) > self.limit, self.total[2])
    }

    fn weight(&self, v: u32) -> u64 {
        u64::from(self.graph.weights[v as usize])
    }

    fn shift(&mut self, v: u32, from: u8, to: u8) {
        let weight = self.weight(v);
        self.side[v as usize] = to;
        self.total[from as usize] -= weight;
        self.total[to as usize] += weight;
    }

    /// One sequence of best moves, each vertex at most once, taken back to where the separator was lightest.
    fn pass(&mut self) -> bool {
        self.start();
        let before = self.score();
        let (mut best, mut kept) = (before, 0);
        while self.log.len() < kept + PATIENCE {
            let Some((v, to)) = self.best_move() else {
                break;
            };
            self.apply(v, to);
            if self.score() < best {
                (best, kept) = (self.score(), self.log.len());
            }
        }
        while self.log.len() > kept {
            self.take_back();
        }
        best < before
    }

    fn start(&mut self) {
        self.queues.iter_mut().for_each(BinaryHeap::clear);
        self.log.clear();
        self.pulled.clear();
        self.moved.fill(false);
        for v in 0..self.graph.n() as u32 {
            if self.side[v as usize] == SEPARATOR {
                self.enter(v);
            }
        }
    }

    /// Finds the gains of a vertex of the separator.
    fn enter(&mut self, v: u32) {
        let weight = self.weight(v) as i64;
        let mut gains = [weight; 2];
        for &u in self.graph.around(v as usize) {
            if self.side[u as usize] != SEPARATOR {
                gains[1 - self.side[u as usize] as usize] -= self.weight(u) as i64;
            }
        }
        for (to, gain) in gains.into_iter().enumerate() {
            self.gains[to][v as usize] = gain;
            if !self.moved[v as usize] {
                self.queues[to].push((gain, v));
            }
        }
    }

    fn change_gain(&mut self, v: u32, to: u8, by: i64) {
        let gain = &mut self.gains[to as usize][v as usize];
        *gain += by;
        if !self.moved[v as usize] {
            self.queues[to as usize].push((*gain, v));
        }
    }

    /// The most profitable move that keeps the sides alike, to the lighter side among equals.
    fn best_move(&mut self) -> Option<(u32, u8)> {
        let lighter = u8::from(self.total[1] < self.total[0]);
        let mut best: Option<(i64, u32, u8)> = None;
        for to in [lighter, 1 - lighter] {
            let t = to as usize;
            while let Some(&(gain, v)) = self.queues[t].peek() {
                let stale = self.side[v as usize] != SEPARATOR
                    || self.moved[v as usize]
                    || self.gains[t][v as usize] != gain;
                if !stale {
                    let fits = to == lighter || self.total[t] + self.weight(v) <= self.limit;
                    if fits && best.is_none_or(|(most, _, _)| gain > most) {
                        best = Some((gain, v, to));
                    }
                    break;
                }
                self.queues[t].pop();
            }
        }
        best.map(|(_, v, to)| (v, to))
    }

    fn apply(&mut self, v: u32, to: u8) {
        let graph = self.graph;
        self.log.push((v, to, self.pulled.len()));
        self.moved[v as usize] = true;
        self.shift(v, SEPARATOR, to);
        let weight = self.weight(v) as i64;
        for &u in graph.around(v as usize) {
            if self.side[u as usize] == SEPARATOR {
                self.change_gain(u, 1 - to, -weight);
            }
        }
        for &u in graph.around(v as usize) {
            if self.side[u as usize] == 1 - to {
                self.pulled.push(u);
                self.shift(u, 1 - to, SEPARATOR);
                let weight = self.weight(u) as i64;
                for &s in graph.around(u as usize) {
                    if self.side[s as usize] == SEPARATOR {
                        self.change_gain(s, to, weight);
                    }
                }
                self.enter(u);
            }
        }
    }

    fn take_back(&mut self) {
        if let Some((v, to, first)) = self.log.pop() {
            while self.pulled.len() > first {
                if let Some(u) = self.pulled.pop() {
                    self.shift(u, SEPARATOR, 1 - to);
                }
            }
            self.shift(v, to, SEPARATOR);
        }
    }
}
