//! Segments as the paper makes them: cuts where the indicator is low, and small pieces merged by majority.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::surface::Surface;
use crate::mesh::partition::contiguous;
use crate::{memory, Result};

/// Cuts the mesh along the edges where the mean of the indicator over both faces is below `threshold`, and
/// merges the pieces of fewer than `min_faces` faces into the neighbor with which they share most edges,
/// smallest first. Returns contiguous labels and how many there are.
///
/// Source: Rowe et al. 2024, supplement E.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn cut_and_merge(
    surface: &Surface<'_>,
    indicator: &[f64],
    threshold: f64,
    min_faces: usize,
) -> Result<(Vec<u32>, usize)> {
    let mut labels = components(surface, |f, g| 0.5 * (indicator[f] + indicator[g]) >= threshold)?;
    let count = labels.iter().map(|l| *l as usize + 1).max().unwrap_or(0);
    let mut sizes = memory::repeated(0, count)?;
    labels.iter().for_each(|l| sizes[*l as usize] += 1);
    let mut shared: Vec<BTreeMap<u32, usize>> = memory::repeated(BTreeMap::new(), count)?;
    for f in 0..labels.len() {
        for (_, g) in surface.around(f).filter(|&(_, g)| labels[g] != labels[f]) {
            *shared[labels[f] as usize].entry(labels[g]).or_default() += 1;
        }
    }
    let mut home = memory::numbers(count)?;
    let mut small: BTreeSet<(usize, u32)> =
        (0..count as u32).map(|l| (sizes[l as usize], l)).filter(|(size, _)| *size < min_faces).collect();
    while let Some((size, gone)) = small.pop_first() {
        let neighbors = std::mem::take(&mut shared[gone as usize]);
        // The smallest name where several have most edges.
        let majority = neighbors.iter().max_by_key(|(label, edges)| (**edges, Reverse(**label)));
        let Some((&kept, _)) = majority else { continue };
        home[gone as usize] = kept;
        small.remove(&(sizes[kept as usize], kept));
        sizes[kept as usize] += size;
        if sizes[kept as usize] < min_faces {
            small.insert((sizes[kept as usize], kept));
        }
        for (third, edges) in neighbors {
            shared[third as usize].remove(&gone);
            if third != kept {
                *shared[third as usize].entry(kept).or_default() += edges;
                *shared[kept as usize].entry(third).or_default() += edges;
            }
        }
    }
    for label in &mut labels {
        while home[*label as usize] != *label {
            *label = home[*label as usize];
        }
    }
    Ok(contiguous(&labels)?)
}

/// The pieces of the dual graph with only the edges that `joins`.
fn components(surface: &Surface<'_>, joins: impl Fn(usize, usize) -> bool) -> Result<Vec<u32>> {
    let mut labels = memory::repeated(u32::MAX, surface.n_faces())?;
    let (mut count, mut stack) = (0, Vec::new());
    for start in 0..labels.len() {
        if labels[start] != u32::MAX {
            continue;
        }
        labels[start] = count;
        memory::push(&mut stack, start)?;
        while let Some(f) = stack.pop() {
            for (_, g) in surface.around(f) {
                if labels[g] == u32::MAX && joins(f, g) {
                    labels[g] = count;
                    memory::push(&mut stack, g)?;
                }
            }
        }
        count += 1;
    }
    Ok(labels)
}
