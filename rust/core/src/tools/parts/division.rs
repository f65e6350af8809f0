//! Dividing the part with the cheapest cut, over and over.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::constants::MOST_PARTS;
use super::cut::{cheapest, Cut};
use super::graph::{Graph, NONE};
use crate::ordered::Ordered;
use crate::progress::{Progress, Report};
use crate::{memory, Result};

/// A part that was divided: the nodes on one side of the cut are a part of their own from then on, with
/// the next number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Division {
    /// The part.
    pub part: u32,
    /// The nodes that go.
    pub gone: Vec<u32>,
}

/// A part that could be divided.
struct Candidate {
    part: u32,
    nodes: Vec<u32>,
    cut: Cut,
}

/// All divisions of a connected graph, the cheapest cut of all parts first; ends early where the caller
/// asked for it.
///
/// # Errors
/// Those of [`cheapest`].
pub(super) fn divisions(graph: &Graph, wanted: Option<usize>, progress: &Progress) -> Result<Vec<Division>> {
    let most = wanted.map_or(MOST_PARTS, |n| n.max(MOST_PARTS));
    let mut heap = BinaryHeap::new();
    let mut candidates: Vec<Option<Candidate>> = Vec::new();
    let mut divisions: Vec<Division> = Vec::new();
    let all = memory::sifted(0..graph.n_nodes() as u32)?;
    let mut fresh = vec![candidate(graph, 0, all, progress)?];
    loop {
        for found in fresh.drain(..).flatten() {
            heap.push(Reverse((Ordered(found.cut.cost), candidates.len())));
            candidates.push(Some(found));
        }
        if divisions.len() + 1 >= most || progress.is_finishing() {
            break;
        }
        let Some(Reverse((_, place))) = heap.pop() else { break };
        let Some(Candidate { part, nodes, cut }) = candidates[place].take() else { continue };
        let number = divisions.len() as u32 + 1;
        let (gone, stay): (Vec<u32>, Vec<u32>) = split(&nodes, &cut.side);
        divisions.push(Division { part, gone: gone.clone() });
        progress.report(Report {
            fraction: divisions.len() as f64 / most as f64,
            stage: "dividing".into(),
            iteration: divisions.len() + 1,
            ..Report::default()
        });
        let (a, b) = rayon::join(
            || candidate(graph, part, stay, progress),
            || candidate(graph, number, gone, progress),
        );
        fresh = vec![a?, b?];
    }
    Ok(divisions)
}

/// Those of `nodes` on the side, and the others.
fn split(nodes: &[u32], side: &[bool]) -> (Vec<u32>, Vec<u32>) {
    let (gone, stay): (Vec<_>, Vec<_>) = nodes.iter().zip(side).partition(|(_, side)| **side);
    let nodes = |pairs: Vec<(&u32, &bool)>| pairs.into_iter().map(|(node, _)| *node).collect();
    (nodes(gone), nodes(stay))
}

fn candidate(graph: &Graph, part: u32, nodes: Vec<u32>, progress: &Progress) -> Result<Option<Candidate>> {
    let own = graph.subgraph(&nodes, &mut memory::repeated(NONE, graph.n_nodes())?)?;
    Ok(cheapest(&own, progress)?.map(|cut| Candidate { part, nodes, cut }))
}
