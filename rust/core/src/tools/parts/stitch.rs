//! Joints across gaps: pieces that nothing joins belong to what lies nearest.
//!
//! A piece large enough to be a part is joined by less than any hollow, so that it comes off before all
//! limbs. Smaller ones, down to loose triangles, are joined along their open edges as if the surface went on.

use super::constants::{HOLLOW, LEAST_PART, LOOKOUTS};
use super::graph::{Edge, Graph};
use super::surface::Surface;
use crate::memory;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{between, distance, Point};
use crate::remesh::closest::ClosestPoint;
use crate::Result;

/// `graph` with edges that make one piece of it, and the piece of each node without those across gaps.
pub(super) fn stitched(surface: &Surface, graph: Graph) -> Result<(Graph, Vec<u32>)> {
    let (mut pieces, mut count) = graph.pieces(|_| true)?;
    if count == 1 {
        return Ok((graph, pieces));
    }
    let tree = ClosestPoint::new(memory::twin(&surface.triangles)?)?;
    let mut edges = memory::twin(&graph.edges)?;
    let areas = piece_areas(&graph, &pieces, count)?;
    for &h in &surface.open {
        let f = h / 3;
        if areas[pieces[f] as usize] >= LEAST_PART {
            continue;
        }
        let [p, q] = [1, 2].map(|i| surface.triangles[f][(h + i) % 3]);
        let elsewhere = |t: u32| pieces[t as usize] != pieces[f];
        if let Some(found) = tree.closest(between(p, q, 0.5), None, elsewhere) {
            let ends = [f as u32, found.triangle];
            let length = distance(p, q);
            let distance = distance_of(&graph, ends);
            memory::push(&mut edges, Edge { ends, length, cost: length, distance })?;
        }
    }
    let mut graph = graph.with_edges(memory::twin(&edges)?)?;
    (pieces, count) = graph.pieces(|_| true)?;
    let apart = memory::twin(&pieces)?;
    // Each round joins every piece to the one nearest to it (Borůvka 1926).
    while count > 1 {
        let areas = piece_areas(&graph, &pieces, count)?;
        for (ends, area) in nearest_pairs(surface, &graph, &pieces, &areas, &tree)? {
            let length = area.sqrt();
            let (cost, distance) = (HOLLOW * HOLLOW * length, distance_of(&graph, ends));
            memory::push(&mut edges, Edge { ends, length, cost, distance })?;
        }
        graph = graph.with_edges(memory::twin(&edges)?)?;
        (pieces, count) = graph.pieces(|_| true)?;
    }
    Ok((graph, apart))
}

fn distance_of(graph: &Graph, ends: [u32; 2]) -> f64 {
    let [p, q]: [Point; 2] = ends.map(|end| graph.centers[end as usize]);
    distance(p, q)
}

fn piece_areas(graph: &Graph, pieces: &[u32], count: usize) -> Result<Vec<f64>> {
    let mut areas = memory::repeated(0.0, count)?;
    pieces.iter().zip(&graph.areas).for_each(|(&piece, area)| areas[piece as usize] += area);
    Ok(areas)
}

/// For every piece the face pair that joins it to the nearest other one, and the area of the smaller of
/// both; no two of them close a cycle.
fn nearest_pairs(
    surface: &Surface,
    graph: &Graph,
    pieces: &[u32],
    areas: &[f64],
    tree: &ClosestPoint,
) -> Result<Vec<([u32; 2], f64)>> {
    let mut members: Vec<Vec<u32>> = memory::repeated(Vec::new(), areas.len())?;
    (0..).zip(pieces).try_for_each(|(f, &piece)| memory::push(&mut members[piece as usize], f))?;
    let mut united = Partition::new(areas.len())?;
    let mut pairs = Vec::new();
    for (piece, faces) in (0_u32..).zip(&members) {
        let mut best: Option<(f64, [u32; 2])> = None;
        for &f in faces.iter().step_by(faces.len().div_ceil(LOOKOUTS)) {
            let elsewhere = |t: u32| pieces[t as usize] != piece;
            if let Some(found) = tree.closest(surface.centers[f as usize], None, elsewhere) {
                if best.is_none_or(|(least, _)| found.squared < least) {
                    best = Some((found.squared, [f, found.triangle]));
                }
            }
        }
        let Some((_, ends)) = best else { continue };
        let other = pieces[ends[1] as usize];
        if united.root(piece) != united.root(other) {
            united.unite(piece, other);
            let area = areas[piece as usize].min(areas[other as usize]).min(graph.area());
            memory::push(&mut pairs, (ends, area))?;
        }
    }
    Ok(pairs)
}
