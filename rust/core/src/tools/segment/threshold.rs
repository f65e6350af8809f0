//! Segments as the paper makes them: cuts where the indicator is low, and small pieces merged by majority.

use std::collections::BTreeMap;

use super::surface::{contiguous, Surface};

/// Cuts the mesh along the edges where the mean of the indicator over both faces is below `threshold`, and merges the pieces of
/// fewer than `min_faces` faces into the neighbour with which they share most edges, smallest first. Returns contiguous labels
/// and how many there are.
///
/// Source: Rowe et al. 2024, supplement E.
pub(super) fn cut_and_merge(
    surface: &Surface<'_>,
    indicator: &[f64],
    threshold: f64,
    min_faces: usize,
) -> (Vec<u32>, usize) {
    let mut labels = components(surface, |f, g| 0.5 * (indicator[f] + indicator[g]) >= threshold);
    loop {
        let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
        for label in &labels {
            *sizes.entry(*label).or_default() += 1;
        }
        let mut shared: BTreeMap<u32, BTreeMap<u32, usize>> = BTreeMap::new();
        for f in 0..labels.len() {
            if sizes[&labels[f]] < min_faces {
                for (_, g) in surface.around(f).filter(|&(_, g)| labels[g] != labels[f]) {
                    *shared.entry(labels[f]).or_default().entry(labels[g]).or_default() += 1;
                }
            }
        }
        let Some((&gone, neighbours)) = shared.iter().min_by_key(|(label, _)| (sizes[label], **label)) else {
            return contiguous(&labels);
        };
        let majority = neighbours.iter().max_by_key(|(label, edges)| (**edges, std::cmp::Reverse(**label)));
        let kept = majority.map_or(gone, |(label, _)| *label);
        labels.iter_mut().filter(|label| **label == gone).for_each(|label| *label = kept);
    }
}

/// The pieces of the dual graph with only the edges that `joins`.
fn components(surface: &Surface<'_>, joins: impl Fn(usize, usize) -> bool) -> Vec<u32> {
    let mut labels = vec![u32::MAX; surface.n_faces()];
    let (mut count, mut stack) = (0, Vec::new());
    for start in 0..labels.len() {
        if labels[start] != u32::MAX {
            continue;
        }
        labels[start] = count;
        stack.push(start);
        while let Some(f) = stack.pop() {
            for (_, g) in surface.around(f) {
                if labels[g] == u32::MAX && joins(f, g) {
                    labels[g] = count;
                    stack.push(g);
                }
            }
        }
        count += 1;
    }
    labels
}
