//! Patches of the mesh that was computed on, for the mesh as it was given.

use std::collections::HashMap;

use super::{FillHolesOptions, Filled, LoopChoice};
use crate::mesh::cycle;
use crate::mesh::Working;
use crate::remesh::editable::key;
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
/// A vertex here may be several of the mesh, and a corner of a patch between two seams is that of one of
/// them: its other edges may then be such as the mesh or another patch has. There the patch gets vertices of
/// its own, on a seam like those around. Where faces of the mesh disagree about what is outside only across
/// seams, a patch agrees with most of those that it touches.
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
    let mut here = memory::twin(&filled.faces)?;
    for (face, here) in filled.faces.iter_mut().zip(&here) {
        *face = here.map(number);
        for i in 0..3 {
            let j = (i + 1) % 3;
            if let Some(&[tail, head]) = seams.get(&[here[j], here[i]]) {
                (face[j], face[i]) = (tail, head);
            }
        }
    }
    let turned = working.turned_across_seams()?;
    if let Some(turned) = &turned {
        agree(&mut filled, &mut here, working, turned)?;
    }
    if !seams.is_empty() {
        keep_apart(&mut filled, &here, working, turned.as_deref())?;
    }
    for hole in &mut filled.holes {
        let own = |edge: [u32; 2]| seams.get(&edge).map_or_else(|| number(edge[0]), |own| own[0]);
        hole.boundary = memory::sifted(cycle(&hole.boundary).map(own))?;
    }
    let of_faces =
        here.iter().zip(&filled.faces).flat_map(|(&here, &face)| edges(here).into_iter().zip(edges(face)));
    let named = memory::mapped(of_faces.map(|([a, b], [c, d])| (key(a, b), key(c, d))))?;
    for edge in &mut filled.ridges {
        *edge = named.get(edge).copied().unwrap_or_else(|| edge.map(number));
        edge.sort_unstable();
    }
    filled.ridges.sort_unstable();
    Ok(filled)
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Turns patches over most of whose neighbors were `turned` because of faces across seams.
fn agree(filled: &mut Filled, here: &mut [[u32; 3]], working: &Working<'_>, turned: &[bool]) -> Result<()> {
    let connectivity = working.mesh().connectivity();
    let side = |h: usize| ([connectivity.head(h), connectivity.tail(h)], turned[h / 3]);
    let is_turned = memory::mapped(connectivity.boundary().map(side))?;
    let mut votes = memory::repeated(0_i64, filled.holes.len())?;
    for (face, &patch) in here.iter().zip(&filled.patch) {
        let beside = edges(*face).into_iter().filter_map(|edge| is_turned.get(&edge));
        votes[patch as usize] += beside.map(|&turned| if turned { 1 } else { -1 }).sum::<i64>();
    }
    let all = filled.faces.iter_mut().chain(here);
    for (face, &patch) in all.zip(filled.patch.iter().cycle()) {
        if votes[patch as usize] > 0 {
            face.swap(1, 2);
        }
    }
    Ok(())
}

/// Gives patches vertices of their own, in place of corners that are several vertices of the mesh, where an
/// edge there would have more faces than an edge can have. `here` are the faces of the patches in vertices of
/// the mesh that was computed on.
fn keep_apart(
    filled: &mut Filled,
    here: &[[u32; 3]],
    working: &Working<'_>,
    turned: Option<&[bool]>,
) -> Result<()> {
    let n = working.n_original() as u32;
    let mut n_own = memory::repeated(0_u32, working.mesh().connectivity().n_vertices())?;
    (0..n).for_each(|v| n_own[working.vertex(v) as usize] += 1);
    let is_several = |v: u32| n_own.get(v as usize).is_some_and(|n_own| *n_own > 1);
    let mut fresh: HashMap<(u32, u32), u32> = HashMap::new();
    loop {
        let of_patches = filled.faces.iter().flat_map(|&face| edges(face));
        let of_mesh = of_patches.filter(|edge| edge.iter().all(|v| *v < n));
        let mut along = memory::mapped(of_mesh.flat_map(|[a, b]| [([a, b], 0_usize), ([b, a], 0)]))?;
        for edge in working.faces_as_given(turned).chain(filled.faces.iter().copied()).flat_map(edges) {
            along.entry(edge).and_modify(|count| *count += 1);
        }
        let count = |edge: [u32; 2]| along.get(&edge).copied().unwrap_or(0);
        let is_crowded = |[a, b]: [u32; 2]| count([a, b]) > 1 || count([a, b]) + count([b, a]) > 2;
        let mut crowded = Vec::new();
        for (i, (&here, &face)) in here.iter().zip(&filled.faces).enumerate() {
            let ends = edges(here).into_iter().zip(edges(face)).filter(|(_, edge)| is_crowded(*edge));
            for (ends, _) in ends {
                // Where the edge itself is one of the mesh, its face runs the wrong way: both ends part.
                let is_any = !ends.iter().any(|&v| is_several(v));
                memory::extend(&mut crowded, 2)?;
                crowded.extend(
                    ends.into_iter().filter(|&v| is_any || is_several(v)).map(|v| (filled.patch[i], v)),
                );
            }
        }
        crowded.retain(|corner| !fresh.contains_key(corner));
        if crowded.is_empty() {
            return Ok(());
        }
        for corner in crowded {
            if !fresh.contains_key(&corner) {
                let place = working.mesh().positions().map_or([0.0; 3], |all| all[corner.1 as usize]);
                memory::extend_map(&mut fresh, 1)?;
                fresh.insert(corner, n + filled.vertices.len() as u32);
                memory::push(&mut filled.vertices, working.place(place))?;
            }
        }
        for ((face, here), &patch) in filled.faces.iter_mut().zip(here).zip(&filled.patch) {
            for (corner, v) in face.iter_mut().zip(here) {
                *corner = fresh.get(&(patch, *v)).copied().unwrap_or(*corner);
            }
        }
    }
}
