//! Patches of the mesh that was computed on, for the mesh as it was given.

use super::{FillHolesOptions, Filled, LoopChoice};
use crate::mesh::cycle;
use crate::mesh::Working;
use crate::{memory, Result};

/// The options with loops in vertices of the mesh that is computed on.
pub(super) fn options_on(working: &Working<'_>, options: &FillHolesOptions) -> FillHolesOptions {
    let n = working.n_original() as u32;
    let on = |choice: &LoopChoice| match choice {
        // Vertices that do not exist are refused later, by their numbers.
        LoopChoice::Vertices(vertices) => LoopChoice::Vertices(
            vertices.iter().map(|&v| if v < n { working.vertex(v) } else { v }).collect(),
        ),
        LoopChoice::Index(index) => LoopChoice::Index(*index),
    };
    FillHolesOptions {
        loops: options.loops.as_ref().map(|loops| loops.iter().map(on).collect()),
        ..options.clone()
    }
}

/// Patches in vertices and coordinates of the mesh as it was:
/// beside an edge of it in the vertices that this edge has.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn given_back(mut filled: Filled, working: &Working<'_>) -> Result<Filled> {
    if working.is_plain() {
        return Ok(filled);
    }
    let seams = working.seam_edges()?;
    let (n_here, n_there) = (working.mesh().connectivity().n_vertices() as u32, working.n_original() as u32);
    let number = |v: u32| if v < n_here { working.original(v) } else { v - n_here + n_there };
    filled.vertices.iter_mut().for_each(|p| *p = working.place(*p));
    for face in &mut filled.faces {
        let here = *face;
        *face = here.map(number);
        for i in 0..3 {
            let j = (i + 1) % 3;
            if let Some(&[tail, head]) = seams.get(&[here[j], here[i]]) {
                (face[j], face[i]) = (tail, head);
            }
        }
    }
    for hole in &mut filled.holes {
        let own = |edge: [u32; 2]| seams.get(&edge).map_or_else(|| number(edge[0]), |own| own[0]);
        hole.boundary = memory::sifted(cycle(&hole.boundary).map(own))?;
    }
    for edge in &mut filled.ridges {
        *edge = edge.map(number);
        edge.sort_unstable();
    }
    filled.ridges.sort_unstable();
    Ok(filled)
}
