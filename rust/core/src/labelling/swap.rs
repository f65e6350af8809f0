//! Borders between two pieces move to where the energy is least: minimum cuts (Boykov et al. 2001).

use std::collections::BTreeMap;

use super::constants::{BAND, BORDER, FARTHEST};
use super::contact::offset;
use super::labels::{Labelling, NONE};
use super::Domain;
use crate::mesh::vector::{add, between};
use crate::progress::Progress;
use crate::tools::minimum_cut::Graph;
use crate::{memory, Result};

/// Moves all borders between two pieces within bands around them.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn swap(domain: &Domain<'_>, state: &mut Labelling, progress: &Progress) -> Result<()> {
    let mut borders: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for h in domain.connectivity.edges() {
        let Some(mate) = domain.connectivity.mate(h) else { continue };
        let [a, b] = [h, mate].map(|h| state.labels[h / 3]);
        if a != b && a != NONE && b != NONE {
            let faces = borders.entry([a.min(b), a.max(b)]).or_default();
            memory::push(faces, (h / 3) as u32)?;
            memory::push(faces, (mate / 3) as u32)?;
        }
    }
    for (pair, faces) in borders {
        progress.check()?;
        if progress.is_finishing() {
            break;
        }
        cut(domain, state, pair, &faces)?;
    }
    Ok(())
}

/// Moves the border between the pieces of a `pair`, which touches `faces`.
fn cut(domain: &Domain<'_>, state: &mut Labelling, pair: [u32; 2], faces: &[u32]) -> Result<()> {
    // Nodes 0 and 1 are the two pieces, each face of the band is one of its own.
    let (mut nodes, mut band): (BTreeMap<u32, u32>, Vec<(u32, usize)>) = (BTreeMap::new(), Vec::new());
    let mut meet = |band: &mut Vec<(u32, usize)>, f: u32, row: usize| {
        if pair.contains(&state.labels[f as usize]) && !nodes.contains_key(&f) {
            nodes.insert(f, band.len() as u32 + 2);
            memory::push(band, (f, row))?;
        }
        Ok::<(), crate::Error>(())
    };
    faces.iter().try_for_each(|&f| meet(&mut band, f, 0))?;
    let mut next = 0;
    while let Some(&(f, row)) = band.get(next) {
        next += 1;
        if row < BAND {
            domain.around(f as usize).try_for_each(|(_, g)| meet(&mut band, g as u32, row + 1))?;
        }
    }
    let mut edges = Vec::new();
    for (&f, &node) in &nodes {
        let mut costs = pair.map(|label| domain.face_cost(f as usize, state.pieces.get(label as usize)));
        for (h, g) in domain.around(f as usize) {
            let own = state.labels[g];
            match nodes.get(&(g as u32)) {
                Some(&other) if f < g as u32 => {
                    memory::push(&mut edges, ([node, other], border_cost(domain, state, pair, h)))?;
                }
                None if own != NONE => {
                    for (label, cost) in pair.into_iter().zip(&mut costs).filter(|(label, _)| *label != own) {
                        *cost += border_cost(domain, state, [label, own], h);
                    }
                }
                _ => {}
            }
        }
        // A face of the first piece costs what the edge to the second carries.
        let least = costs[0].min(costs[1]);
        memory::extend(&mut edges, 2)?;
        edges.push(([1, node], costs[0] - least));
        edges.push(([0, node], costs[1] - least));
    }
    let first = Graph::new(nodes.len() + 2, &edges).cut(0, 1);
    for (f, node) in nodes {
        state.labels[f as usize] = pair[usize::from(!first[node as usize])];
    }
    Ok(())
}

/// What a border along halfedge `h` costs between two pieces: its length, and more the farther it runs from
/// where their surfaces meet.
fn border_cost(domain: &Domain<'_>, state: &Labelling, pair: [u32; 2], h: usize) -> f64 {
    let length = BORDER * domain.lengths[h / 3][h % 3] / domain.mean_edge;
    let [Some(a), Some(b)] = pair.map(|label| state.pieces[label as usize].surface.as_ref()) else {
        return length;
    };
    let connectivity = domain.connectivity;
    let [p, q] = [connectivity.tail(h), connectivity.head(h)].map(|v| domain.positions[v as usize]);
    let own = domain.areas[h / 3];
    let out = connectivity.mate(h).map_or(own, |mate| add(own, domain.areas[mate / 3]));
    let (edge, sigma) = (domain.mean_edge, domain.sigma);
    let off = offset([a, b], between(p, q, 0.5), out, 0.5 * edge, FARTHEST * edge, sigma);
    length * (1.0 + (off / edge).min(FARTHEST).powi(2))
}
