//! From clusters back to faces: the borders between parts, drawn along edges of the mesh and pulled tight
//! there.

use super::constants::CLUSTERS_WIDE;
use super::cut::{are_parts, area_of, cost};
use super::division::Division;
use super::graph::{Graph, NONE};
use super::tighten::moved;
use crate::progress::Progress;
use crate::{memory, Result};

/// What the divisions are on the faces.
pub(super) struct Drawn {
    /// The part of every face, from 0.
    pub labels: Vec<u32>,
    /// For each division the part that was divided, the part that came of it, and what the cut costs, or the
    /// one before if that is more. Borders between clusters are longer than those between faces, by their
    /// corners: with the costs of the faces every density has the same.
    pub divisions: Vec<([u32; 2], f64)>,
}

/// Draws each border where it is shortest in its band. A division that leaves less than a part is none.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn drawn(
    graph: &Graph,
    clusters: &[u32],
    n_clusters: usize,
    divisions: &[Division],
    progress: &Progress,
) -> Result<Drawn> {
    let mut labels = memory::repeated(0_u32, graph.n_nodes())?;
    let mut kept: Vec<([u32; 2], f64)> = Vec::with_capacity(divisions.len());
    let width = CLUSTERS_WIDE * (graph.area() / n_clusters as f64).sqrt();
    // The part of each cluster as divisions go on, and what that part is called on the faces.
    let mut owners = memory::repeated(0_u32, n_clusters)?;
    let mut names = vec![0_u32];
    let mut place = memory::repeated(NONE, graph.n_nodes())?;
    for (number, division) in (1..).zip(divisions) {
        progress.check()?;
        division.gone.iter().for_each(|&cluster| owners[cluster as usize] = number);
        names.push(names[division.part as usize]);
        let name = names[division.part as usize];
        let faces = memory::sifted((0..graph.n_nodes() as u32).filter(|&f| labels[f as usize] == name))?;
        let part = graph.subgraph(&faces, &mut place)?;
        let owner = |f: u32| owners[clusters[f as usize] as usize];
        let rough = spread_out(&part, faces.iter().map(|&f| owner(f)), [division.part, number])?;
        let fine = if n_clusters < graph.n_nodes() { moved(&part, &rough, width)? } else { None };
        let fine = fine.map(|side| whole_parts(&part, side)).transpose()?.flatten();
        let side = if fine.is_some() { fine } else { whole_parts(&part, rough)? };
        let Some(side) = side else { continue };
        let fresh = kept.len() as u32 + 1;
        names[number as usize] = fresh;
        let before = kept.last().map_or(0.0, |(_, cost)| *cost);
        kept.push(([name, fresh], cost(&part, &side).max(before)));
        faces.iter().zip(&side).filter(|(_, side)| **side).for_each(|(&f, _)| labels[f as usize] = fresh);
    }
    Ok(Drawn { labels, divisions: kept })
}

/// The cut with both sides in one piece, unless one is less than a part then.
fn whole_parts(part: &Graph, mut side: Vec<bool>) -> Result<Option<Vec<bool>>> {
    keep_whole(part, &mut side)?;
    Ok(are_parts(part, &side).then_some(side))
}

/// Which faces are on the second side, by the parts of their clusters; faces of clusters that are in
/// neither, since an earlier border was moved over them, go with the nearest.
fn spread_out(part: &Graph, owners: impl Iterator<Item = u32>, sides: [u32; 2]) -> Result<Vec<bool>> {
    let owners = memory::sifted(owners)?;
    let known = memory::sifted((0..owners.len() as u32).filter(|&f| sides.contains(&owners[f as usize])))?;
    let (_, nearest) = part.nearest(&known, f64::INFINITY, |edge| edge.distance)?;
    let second = |&seed: &u32| known.get(seed as usize).is_some_and(|&f| owners[f as usize] == sides[1]);
    Ok(memory::gathered(nearest.iter().map(second))?)
}

/// Gives all pieces of a side but its largest to the other one.
fn keep_whole(part: &Graph, side: &mut [bool]) -> Result<()> {
    let (pieces, count) = part.pieces(|e| side[e.ends[0] as usize] == side[e.ends[1] as usize])?;
    if count <= 2 {
        return Ok(());
    }
    let mut largest = [(0.0, NONE); 2];
    for piece in 0..count as u32 {
        let members = memory::gathered(pieces.iter().map(|p| *p == piece))?;
        let area = area_of(part, &members);
        let Some(first) = members.iter().position(|m| *m) else { continue };
        let held = &mut largest[usize::from(side[first])];
        if area > held.0 {
            *held = (area, piece);
        }
    }
    for (side, piece) in side.iter_mut().zip(&pieces) {
        if largest[usize::from(*side)].1 != *piece {
            *side = !*side;
        }
    }
    Ok(())
}
