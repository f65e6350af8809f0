//! Large meshes as a few thousand clusters of faces: what is short and hollow shows at that size, and the
//! time to find it stays.

use super::constants::{AS_IT_IS, CENTERINGS, CLUSTERS, LEAST_OPENNESS};
use super::graph::{Edge, Graph};
use crate::mesh::vector::{add, distance, scale};
use crate::progress::Progress;
use crate::{memory, Result};

/// The cluster of every node of `graph`, and how many there are: none is empty, and none is in two pieces.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn clusters(graph: &Graph, progress: &Progress) -> Result<(Vec<u32>, usize)> {
    let n = graph.n_nodes();
    if n as f64 <= AS_IT_IS * CLUSTERS as f64 {
        return Ok((memory::sifted(0..n as u32)?, n));
    }
    let mut seeds = spread(graph);
    let (pieces, n_pieces) = graph.pieces(|_| true)?;
    let mut seeded = memory::repeated(false, n_pieces)?;
    seeds.iter().for_each(|&seed| seeded[pieces[seed as usize] as usize] = true);
    for (i, &piece) in (0..).zip(&pieces) {
        if !std::mem::replace(&mut seeded[piece as usize], true) {
            memory::push(&mut seeds, i)?;
        }
    }
    let step = |edge: &Edge| {
        let openness = edge.cost / edge.length.max(f64::MIN_POSITIVE);
        edge.distance / openness.clamp(LEAST_OPENNESS, 1.0).sqrt()
    };
    let mut labels = Vec::new();
    for round in 0..=CENTERINGS {
        progress.check()?;
        labels = graph.nearest(&seeds, f64::INFINITY, step)?.1;
        if round < CENTERINGS {
            centered(graph, &labels, &mut seeds)?;
        }
    }
    Ok((labels, seeds.len()))
}

/// Nodes at equal steps of area, in their order.
fn spread(graph: &Graph) -> Vec<u32> {
    let step = graph.area() / CLUSTERS as f64;
    let (mut area, mut next) = (0.0, 0.5 * step);
    let mut seeds = Vec::with_capacity(CLUSTERS);
    for (i, a) in (0_u32..).zip(&graph.areas) {
        area += a;
        if area > next {
            seeds.push(i);
            next += step * ((area - next) / step).ceil();
        }
    }
    seeds
}

/// Moves every seed to the node of its cluster that is nearest to the middle.
fn centered(graph: &Graph, labels: &[u32], seeds: &mut [u32]) -> Result<()> {
    let mut middles = memory::repeated(([0.0; 3], 0.0), seeds.len())?;
    for (i, &label) in labels.iter().enumerate() {
        let (sum, area) = &mut middles[label as usize];
        *sum = add(*sum, scale(graph.centers[i], graph.areas[i]));
        *area += graph.areas[i];
    }
    let mut nearest = memory::repeated(f64::INFINITY, seeds.len())?;
    for (i, &label) in (0_u32..).zip(labels) {
        let (sum, area) = middles[label as usize];
        let far = distance(graph.centers[i as usize], scale(sum, 1.0 / area));
        if far < nearest[label as usize] {
            (nearest[label as usize], seeds[label as usize]) = (far, i);
        }
    }
    Ok(())
}
