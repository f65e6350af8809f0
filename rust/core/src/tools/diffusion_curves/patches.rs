//! Painted patches that segmentation has left in a region of another color.

use super::constants::{PAINT_NOISE, SHADING};
use super::groups::Groups;
use super::sorting::{Paint, Sorted};
use crate::mesh::partition::Partition;
use crate::{memory, Result};

/// Vertices joined by edges over which colors hardly change.
pub(super) struct PaintedParts {
    /// A vertex of the part of each vertex, the same one for all of the part.
    pub root: Vec<usize>,
    /// Colors change by less than this over the edges that join.
    pub tolerance: f64,
}

impl PaintedParts {
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(paint: &Paint<'_>) -> Result<Self> {
        let connectivity = paint.mesh.connectivity();
        let jump = |h: usize| paint.distance(connectivity.tail(h) as usize, connectivity.head(h) as usize);
        let jumps: Vec<f64> = memory::gathered((0..connectivity.n_halfedges()).map(jump))?;
        let tolerance = (SHADING * paint.scale()).max(PAINT_NOISE * median(&mut memory::twin(&jumps)?));
        let mut parts = Partition::new(connectivity.n_vertices())?;
        for (h, _) in jumps.iter().enumerate().filter(|(_, jump)| **jump < tolerance) {
            parts.unite(connectivity.tail(h), connectivity.head(h));
        }
        let roots = (0..connectivity.n_vertices() as u32).map(|v| parts.root(v) as usize);
        Ok(Self { root: memory::gathered(roots)?, tolerance })
    }
}

/// Gives each patch a region of its own: a part of the vertices, none of which has the color of its region,
/// and that `least` faces or more touch.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn add_patches(
    paint: &Paint<'_>,
    sorted: &Sorted,
    groups: &Groups,
    least: usize,
    labels: &mut [i32],
) -> Result<()> {
    let connectivity = paint.mesh.connectivity();
    let PaintedParts { root, tolerance } = PaintedParts::new(paint)?;
    let mut strange = memory::repeated(true, root.len())?;
    root.iter().zip(&sorted.off).for_each(|(&r, off)| strange[r] &= *off > tolerance);
    let mut touching = memory::repeated(0, root.len())?;
    for face in connectivity.faces() {
        let mut found = face.map(|v| root[v as usize]);
        found.sort_unstable();
        found
            .iter()
            .enumerate()
            .filter(|&(i, r)| i == 0 || found[i - 1] != *r)
            .for_each(|(_, &r)| touching[r] += 1);
    }
    let first = labels.iter().max().map_or(0, |most| most + 1);
    let patches = (0..root.len()).filter(|&r| root[r] == r && strange[r] && touching[r] >= least.max(1));
    let mut region = memory::repeated(None, root.len())?;
    patches.zip(first..).for_each(|(r, label)| region[r] = Some(label));
    for (f, face) in connectivity.faces().iter().enumerate() {
        let [a, b, c] = face.map(|v| region[root[v as usize]]);
        if let Some(label) = a.filter(|_| a == b || a == c).or(b.filter(|_| b == c)) {
            groups.set(labels, f, label);
        }
    }
    Ok(())
}

/// The median of numbers, 0 of none.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
