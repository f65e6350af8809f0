//! The edges between regions, chained into curves.

use crate::mesh::{Connectivity, EdgeKind, EdgeTable};
use crate::{memory, Result};

/// An edge of a curve with the regions on its sides: nothing beyond the rim of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CurveEdge {
    /// Start and end.
    pub ends: [u32; 2],
    /// Labels on the left and on the right.
    pub regions: [Option<i32>; 2],
}

/// The halfedges of the edge that starts at vertex `start`, each with whether its face lies left of it.
///
/// Faces run counterclockwise, so the face whose halfedge starts at `start` is on the left and its neighbor
/// on the right. Where faces disagree on their orientation, or more than two meet, the first one decides and
/// all others are on its other side.
pub(super) fn sided<'a>(
    connectivity: &'a Connectivity,
    table: &'a EdgeTable,
    [start, end]: [u32; 2],
) -> impl Iterator<Item = (usize, bool)> + Clone + 'a {
    let edge = table.between(start, end);
    let first = edge.clone().next();
    edge.map(move |h| (h, (first == Some(h)) == first.is_some_and(|first| connectivity.tail(first) == start)))
}

/// The edges whose faces have different labels, each with the smaller label on its left; with `rims` also the
/// edges with one face, which lies on the left.
pub(super) fn border_edges(
    connectivity: &Connectivity,
    table: &EdgeTable,
    labels: &[i32],
    rims: bool,
) -> Result<Vec<CurveEdge>> {
    let mut edges = Vec::new();
    for edge in table.edges() {
        let label = |h: usize| labels[h / 3];
        let Some(first) = edge.clone().next() else { continue };
        let Some(other) = edge.clone().find(|&h| label(h) != label(first)) else {
            if rims && connectivity.kind(first) == EdgeKind::Boundary {
                let ends = [connectivity.tail(first), connectivity.head(first)];
                memory::push(&mut edges, CurveEdge { ends, regions: [Some(label(first)), None] })?;
            }
            continue;
        };
        let (tail, head) = (connectivity.tail(first), connectivity.head(first));
        let ends = if label(first) < label(other) { [tail, head] } else { [head, tail] };
        let regions = [Some(label(first).min(label(other))), Some(label(first).max(label(other)))];
        memory::push(&mut edges, CurveEdge { ends, regions })?;
    }
    Ok(edges)
}

/// The edges in the order of their curves, and where each curve starts in them, with their number last.
///
/// A curve runs between two regions, the same on each side all along, and ends where another curve meets it
/// or at the rim of the mesh. Closed curves come last.
pub(super) fn chain(
    connectivity: &Connectivity,
    edges: &[CurveEdge],
) -> Result<(Vec<CurveEdge>, Vec<usize>)> {
    let stops = stops(connectivity, edges)?;
    let mut leaving = memory::repeated(None, connectivity.n_vertices())?;
    for (e, edge) in edges.iter().enumerate().filter(|(_, edge)| !stops[edge.ends[0] as usize]) {
        leaving[edge.ends[0] as usize] = Some(e);
    }
    let mut used = memory::repeated(false, edges.len())?;
    let (mut chained, mut starts) = (memory::room(edges.len())?, vec![0]);
    let opens = (0..edges.len()).filter(|&e| stops[edges[e].ends[0] as usize]);
    for first in opens.chain(0..edges.len()) {
        let mut at = Some(first);
        while let Some(e) = at.filter(|&e| !used[e]) {
            used[e] = true;
            chained.push(edges[e]);
            at = leaving[edges[e].ends[1] as usize];
        }
        if starts.last() != Some(&chained.len()) {
            memory::push(&mut starts, chained.len())?;
        }
    }
    Ok((chained, starts))
}

/// The vertices where curves end.
fn stops(connectivity: &Connectivity, edges: &[CurveEdge]) -> Result<Vec<bool>> {
    let n = connectivity.n_vertices();
    let mut rim = memory::repeated(false, n)?;
    for h in (0..connectivity.n_halfedges()).filter(|&h| connectivity.kind(h) == EdgeKind::Boundary) {
        rim[connectivity.tail(h) as usize] = true;
        rim[connectivity.head(h) as usize] = true;
    }
    let mut passing: Vec<[Option<CurveEdge>; 2]> = memory::repeated([None; 2], n)?;
    let mut stops = memory::repeated(false, n)?;
    for edge in edges {
        for (v, slot) in edge.ends.into_iter().zip([1, 0]) {
            let place = &mut passing[v as usize][slot];
            stops[v as usize] |= place.is_some() || (rim[v as usize] && edge.regions[1].is_some());
            *place = Some(*edge);
        }
    }
    for (stop, passing) in stops.iter_mut().zip(passing) {
        *stop |= passing[0].map(|edge| edge.regions) != passing[1].map(|edge| edge.regions);
    }
    Ok(stops)
}
