//! Coarser meshes of one surface, made by collapsing edges, and what is carried between them.
//!
//! Each [`Level`] has about a quarter of the vertices of the one before. A vertex of it stands for the
//! vertices that collapsed into it, and is where their faces, weighted by area, have it (Garland and Heckbert
//! 1997): under noise nearer to the surface than they are, at a corner the corner. So what a coarse level
//! says of the surface is what remains of it without the finest detail, and not a sample of its noise.

mod carry;
mod collapse;

pub use carry::Carry;
use collapse::Collapser;

use crate::error::MeshError;
use crate::mesh::vector::Point;
use crate::mesh::Mesh;
use crate::{memory, Progress, Result};

/// A level has this part of the vertices of the finer one: edges twice as long.
const PART: f64 = 0.25;

/// A mesh with more than this part of the finer one's vertices is no level: most of them cannot collapse.
const WORTHWHILE: f64 = 0.6;

/// A coarser mesh of a surface.
#[derive(Debug)]
pub struct Level {
    /// The mesh; its faces lie on the finer one's surface and look the same way.
    pub mesh: Mesh,
    /// From it to the finer one.
    pub carry: Carry,
    /// For every vertex of the finer mesh the one that stands for it, or `u32::MAX` for a vertex without
    /// faces.
    pub parents: Vec<u32>,
}

impl Level {
    /// The mean of what the vertices have that a vertex stands for.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub fn mean_of(&self, fine: &[f64]) -> Result<Vec<f64>> {
        let values = self.parents.iter().copied().zip(fine.iter().copied());
        means(self.mesh.connectivity().n_vertices(), values.filter(|(parent, _)| *parent != u32::MAX))
    }
}

/// What faces have, as each level has it: the mean at a vertex of what it stands for, at a face of its
/// corners.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(crate) fn face_values(mesh: &Mesh, levels: &[Level], values: &[f64]) -> Result<Vec<Vec<f64>>> {
    let faces = mesh.connectivity().faces().iter().zip(values);
    let at_corners = faces.flat_map(|(face, &value)| face.map(|v| (v, value)));
    let mut at_vertices = means(mesh.connectivity().n_vertices(), at_corners)?;
    let on_level = |level: &Level| {
        at_vertices = level.mean_of(&at_vertices)?;
        let mean = |face: &[u32; 3]| face.iter().map(|&v| at_vertices[v as usize]).sum::<f64>() / 3.0;
        Ok(memory::gathered(level.mesh.connectivity().faces().iter().map(mean))?)
    };
    levels.iter().map(on_level).collect()
}

/// The mean of the values of each of `n` vertices; 0 where one has none.
fn means(n: usize, values: impl Iterator<Item = (u32, f64)>) -> Result<Vec<f64>> {
    let (mut sums, mut counts) = (memory::repeated(0.0, n)?, memory::repeated(0_u32, n)?);
    for (v, value) in values {
        sums[v as usize] += value;
        counts[v as usize] += 1;
    }
    Ok(memory::gathered(sums.iter().zip(counts).map(|(sum, count)| sum / f64::from(count.max(1))))?)
}

/// The levels of `mesh` above it, each coarser than the one before, down to the first with no more than
/// `enough` vertices, or to where edges no longer collapse. A vertex that is `held` never becomes one with
/// another that is not, and nothing is carried to it.
///
/// # Errors
/// [`MeshError::NoPositions`] and cancellation.
pub fn levels(mesh: &Mesh, held: Option<&[bool]>, enough: usize, progress: &Progress) -> Result<Vec<Level>> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let mut collapser = Collapser::new(mesh.connectivity(), positions, [held, None], progress)?;
    let mut found: Vec<Level> = Vec::new();
    loop {
        let finer = found.last().map_or(mesh, |level| &level.mesh);
        let n = collapser.n_left();
        if n <= enough {
            return Ok(found);
        }
        // All levels of one ratio, so that the last is not needlessly small.
        let steps = ((n as f64 / enough as f64).ln() / (1.0 / PART).ln()).ceil().max(1.0);
        let wanted = (n as f64 * (enough as f64 / n as f64).powf(1.0 / steps)).ceil();
        collapser.reduce_to(wanted as usize, progress)?;
        if collapser.n_left() as f64 > WORTHWHILE * n as f64 {
            return Ok(found);
        }
        let level = made(&mut collapser, finer, progress)?;
        found.push(level);
    }
}

/// The level of `mesh`, of any size, with about `n_vertices` of its vertices, or as near to that as edges
/// collapse; those that are `held` are as in [`levels`], and those that are `kept` stay as they are, each on
/// its own. So the levels of adjoining parts of a surface adjoin if what they share is kept.
///
/// # Errors
/// [`MeshError::NoPositions`] and cancellation.
pub fn level(
    mesh: &Mesh,
    held: Option<&[bool]>,
    kept: Option<&[bool]>,
    n_vertices: usize,
    progress: &Progress,
) -> Result<Level> {
    let unit = mesh.unit();
    let measured = mesh.measured(unit)?;
    let positions = measured.positions().ok_or(MeshError::NoPositions)?;
    let mut collapser = Collapser::new(mesh.connectivity(), positions, [held, kept], progress)?;
    collapser.reduce_to(n_vertices, progress)?;
    let mut level = made(&mut collapser, &measured, progress)?;
    if let (false, Some(original)) = (unit.is_one(), mesh.positions()) {
        let points = level.mesh.positions().ok_or(MeshError::NoPositions)?;
        let mut restored = memory::gathered(points.iter().map(|p| p.map(|x| unit.restore(x))))?;
        let is_kept = |v: usize| kept.is_some_and(|kept| kept[v]) && level.parents[v] != u32::MAX;
        for v in (0..original.len()).filter(|&v| is_kept(v)) {
            restored[level.parents[v] as usize] = original[v];
        }
        level.mesh = Mesh::new(restored, memory::twin(level.mesh.connectivity().faces())?)?;
    }
    Ok(level)
}

/// The level that has been reached above the `finer` mesh.
fn made(collapser: &mut Collapser, finer: &Mesh, progress: &Progress) -> Result<Level> {
    let is_held = collapser.held()?;
    let (points, faces, parents) = collapser.level()?;
    let fine: &[Point] = finer.positions().ok_or(MeshError::NoPositions)?;
    progress.check()?;
    let coarse = Mesh::new(points, faces)?;
    let carry = Carry::new(fine, &parents, &is_held, &coarse, progress)?;
    Ok(Level { mesh: coarse, carry, parents })
}

#[cfg(test)]
mod tests;
