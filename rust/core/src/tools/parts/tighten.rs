//! The minimum cut in a band around a cut.

use super::graph::{Graph, NONE};
use crate::tools::minimum_cut;
use crate::{memory, Result};

/// The minimum cut between what lies farther than `width` from the border on one side, and on the other;
/// nothing where one of them is empty.
pub(super) fn moved(graph: &Graph, side: &[bool], width: f64) -> Result<Option<Vec<bool>>> {
    let parted = |ends: [u32; 2]| side[ends[0] as usize] != side[ends[1] as usize];
    let front = memory::sifted(graph.edges.iter().filter(|e| parted(e.ends)).flat_map(|e| e.ends))?;
    let (distances, _) = graph.nearest(&front, width, |edge| edge.distance)?;
    // The far sides are nodes 0 and 1; those of the band follow.
    let mut names = memory::repeated(NONE, side.len())?;
    let (mut count, mut far) = (2, [false; 2]);
    for (name, (&side, distance)) in names.iter_mut().zip(side.iter().zip(&distances)) {
        if distance.is_finite() {
            *name = count;
            count += 1;
        } else {
            *name = u32::from(side);
            far[usize::from(side)] = true;
        }
    }
    if far != [true; 2] {
        return Ok(None);
    }
    let named = graph.edges.iter().map(|e| (e.ends.map(|end| names[end as usize]), e.cost));
    let edges = memory::sifted(named.filter(|(ends, _)| ends[0] != ends[1]))?;
    let cut = minimum_cut::Graph::new(count as usize, &edges).cut(1, 0);
    Ok(Some(memory::gathered(names.iter().map(|&name| cut[name as usize]))?))
}
