//! Watershed by persistence on the dual graph (Edelsbrunner, Letscher and Zomorodian 2002; Couprie and
//! Bertrand 1997).

use super::surface::Surface;
use crate::mesh::partition::contiguous;
use crate::mesh::partition::Partition;
use crate::{memory, Result};

/// Floods the faces from the maxima of `indicator` downwards; two basins stay apart only if the pass between
/// them lies deeper than `persistence` under the lower of their maxima. Returns a label for every face, from
/// 0, and how many there are.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn watershed(
    surface: &Surface<'_>,
    indicator: &[f64],
    persistence: f64,
) -> Result<(Vec<u32>, usize)> {
    let m = surface.n_faces();
    let mut order = memory::numbers(m)?;
    // Faces are all different, so that the order of equal ones does not matter.
    order.sort_unstable_by(|&a, &b| indicator[b as usize].total_cmp(&indicator[a as usize]).then(a.cmp(&b)));
    // A basin is named by its highest face, which is the root of its tree.
    let mut flooded = memory::repeated(false, m)?;
    let mut sets = Partition::new(m)?;
    let mut basins: Vec<u32> = Vec::with_capacity(3);
    for &face in &order {
        let f = face as usize;
        basins.clear();
        // The neighbor that lies highest decides where the face goes when basins stay apart.
        let mut best: Option<(f64, u32)> = None;
        for (_, g) in surface.around(f) {
            if !flooded[g] {
                continue;
            }
            let root = sets.root(g as u32);
            if best.is_none_or(|(height, _)| indicator[g] > height) {
                best = Some((indicator[g], root));
            }
            if !basins.contains(&root) {
                basins.push(root);
            }
        }
        flooded[f] = true;
        let Some((_, home)) = best else { continue };
        basins.sort_by(|&a, &b| indicator[b as usize].total_cmp(&indicator[a as usize]).then(a.cmp(&b)));
        let highest = basins[0];
        for &basin in &basins[1..] {
            if indicator[basin as usize] - indicator[f] < persistence {
                sets.attach(basin, highest);
            }
        }
        let home = sets.root(home);
        sets.attach(face, home);
    }
    let roots: Vec<u32> = memory::gathered((0..m as u32).map(|f| sets.root(f)))?;
    Ok(contiguous(&roots)?)
}
