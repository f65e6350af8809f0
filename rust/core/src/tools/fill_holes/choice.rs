//! Which holes to fill, and their first patches.

use std::collections::{HashMap, HashSet};

use super::options::{FillHolesOptions, LoopChoice};
use crate::error::{MeshError, Refusal};
use crate::hole_filling::{fill_loops, holes_of, FillOptions, Patch};
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::{Error, Result};

/// A loop, and why it cannot be filled, if so.
pub(super) type Chosen = (Vec<u32>, Option<Refusal>);

/// The loops that `options` ask for.
pub(super) fn choose(mesh: &Mesh, options: &FillHolesOptions) -> Result<Vec<Chosen>> {
    let Some(choices) = &options.loops else {
        let wanted = holes_of(mesh)?.into_iter().filter(|hole| {
            (options.outer || !hole.is_outer_border)
                && options.max_edges.is_none_or(|most| hole.vertices.len() <= most)
        });
        return Ok(wanted.map(|hole| (hole.vertices, hole.refusal)).collect());
    };
    let by_index = choices.iter().any(|choice| matches!(choice, LoopChoice::Index(_)));
    let holes = if by_index { holes_of(mesh)? } else { Vec::new() };
    let choose = |choice: &LoopChoice| match choice {
        LoopChoice::Vertices(vertices) => Ok((vertices.clone(), None)),
        LoopChoice::Index(index) => {
            let problem = || format!("names loop {index}, but the mesh has {} boundary loops", holes.len());
            let hole = holes.get(*index).ok_or_else(|| Error::argument("loops", problem()))?;
            Ok((hole.vertices.clone(), hole.refusal))
        }
    };
    let chosen = choices.iter().map(choose).collect::<Result<Vec<_>>>()?;
    refuse_repeats(&chosen)?;
    Ok(chosen)
}

/// Refuses loops that run along one boundary edge: it has room for one more face only.
fn refuse_repeats(chosen: &[Chosen]) -> Result<()> {
    let mut first = HashMap::new();
    for (entry, (vertices, _)) in chosen.iter().enumerate() {
        for (&a, &b) in vertices.iter().zip(vertices.iter().cycle().skip(1)) {
            let earlier = *first.entry([a.min(b), a.max(b)]).or_insert(entry);
            if earlier != entry {
                let problem = format!(
                    "entries {earlier} and {entry} are the same hole, or share an edge; give each hole once"
                );
                return Err(Error::argument("loops", problem));
            }
        }
    }
    Ok(())
}

/// The patch of every loop, given the faces `at` them; an empty one for those that cannot be filled, which is
/// noted. Vertices that are no loop at all are an error.
pub(super) fn triangulate(
    mesh: &Mesh,
    chosen: &mut [Chosen],
    at: &[u32],
    options: &FillOptions,
    progress: &Progress,
) -> Result<Vec<Patch>> {
    let loops: Vec<Vec<u32>> = chosen
        .iter()
        .filter(|(_, refusal)| refusal.is_none())
        .map(|(vertices, _)| vertices.clone())
        .collect();
    let mut patches = fill_loops(mesh, &loops, at, options, progress)?.into_iter();
    let mut next = |(_, refusal): &mut Chosen| {
        if refusal.is_some() {
            return Ok(Patch::default());
        }
        match patches.next() {
            Some(Err(MeshError::Unfillable { reason, .. })) if reason != Refusal::NotALoop => {
                *refusal = Some(reason);
                Ok(Patch::default())
            }
            Some(patch) => Ok(patch?),
            None => Ok(Patch::default()),
        }
    };
    chosen.iter_mut().map(&mut next).collect()
}

/// The vertices that lie on several of the loops: between two of them, two patches could make the same edge.
pub(super) fn on_several(chosen: &[Chosen]) -> HashSet<u32> {
    let mut seen = HashSet::new();
    chosen.iter().flat_map(|(vertices, _)| vertices).copied().filter(|&v| !seen.insert(v)).collect()
}
