//! Paint without its soft edges: what a soft brush or a smoothed image leaves between two colors is no color
//! of its own.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::constants::{HUB, MIXING_STEPS};
use super::patches::PaintedParts;
use super::sorting::{neighbors, Paint};
use crate::linear::Columns;
use crate::ordered::Ordered;
use crate::{memory, Result};

/// The colors, with every blend replaced by the one of the colors that it is a blend of to which it is
/// nearest.
///
/// Of a part of the surface that edges join over which colors hardly change, all vertices may be blends but
/// those that are no end of another edge. Where there is none such, the part is a blend if most of its
/// vertices have a mixture of the colors around it. Blends are filled from what is around them, the most
/// similar vertex first (seeded region growing, Adams and Bischof 1994). Borders then are where one color
/// outweighs the other, and flat paint stays as it is.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing, here and below.
pub(super) fn sharpened(paint: &Paint<'_>) -> Result<Columns> {
    let colors = paint.colors;
    let connectivity = paint.mesh.connectivity();
    let around = neighbors(connectivity.faces(), colors.n_rows, |_| true)?;
    let blended = blends(paint, &around)?;
    let own = (0..colors.n_rows).map(|v| (!blended[v]).then_some(v));
    let mut source: Vec<Option<usize>> = memory::gathered(own)?;
    // How far off the color of a vertex is for another one, that one, and it.
    type Offer = Reverse<(Ordered, usize, usize)>;
    let mut waiting = BinaryHeap::new();
    let offer = |waiting: &mut BinaryHeap<Offer>, source: &[Option<usize>], from: usize, color: usize| {
        for v in around[from].iter().map(|&v| v as usize).filter(|&v| source[v].is_none()) {
            memory::extend_heap(waiting, 1)?;
            waiting.push(Reverse((Ordered(paint.distance(v, color)), v, color)));
        }
        Result::Ok(())
    };
    (0..colors.n_rows).filter(|&v| !blended[v]).try_for_each(|v| offer(&mut waiting, &source, v, v))?;
    while let Some(Reverse((_, vertex, color))) = waiting.pop() {
        if source[vertex].is_none() {
            source[vertex] = Some(color);
            offer(&mut waiting, &source, vertex, color)?;
        }
    }
    let mut sharp = colors.copied()?;
    for c in 0..colors.n_columns {
        let taken = source.iter().enumerate().map(|(v, from)| colors.column(c)[from.unwrap_or(v)]);
        sharp.column_mut(c).iter_mut().zip(taken).for_each(|(x, new)| *x = new);
    }
    Ok(sharp)
}

/// Whether each vertex may be part of a blend.
fn blends(paint: &Paint<'_>, around: &[Vec<u32>]) -> Result<Vec<bool>> {
    let colors = paint.colors;
    let PaintedParts { root, tolerance } = PaintedParts::new(paint)?;
    let flat = |v: usize| around[v].iter().all(|&u| paint.distance(v, u as usize) < tolerance);
    let flat: Vec<bool> = memory::gathered((0..root.len()).map(flat))?;
    let mut wide = memory::repeated(false, root.len())?;
    root.iter().zip(&flat).for_each(|(&r, flat)| wide[r] |= flat);
    // How many more vertices of each part are mixtures than are not.
    let mut mixed = memory::repeated(0_i64, root.len())?;
    for v in (0..root.len()).filter(|&v| !wide[root[v]]) {
        let rings = around[v].iter().map(|&u| &around[u as usize]).filter(|ring| ring.len() <= HUB);
        let near = rings.flatten().chain(&around[v]);
        let mut others: Vec<u32> = near.copied().filter(|&u| root[u as usize] != root[v]).collect();
        others.sort_unstable();
        others.dedup();
        mixed[root[v]] += if is_mixture(colors, v, &others, tolerance) { 1 } else { -1 };
    }
    let blended = |(&r, flat): (&usize, &bool)| if wide[r] { !flat } else { mixed[r] > 0 };
    Ok(memory::gathered(root.iter().zip(&flat).map(blended))?)
}

/// Whether a mixture of the colors of `others` comes as near to the color of `v` as `tolerance`: steps toward
/// the nearest point of their convex hull (Frank and Wolfe 1956).
fn is_mixture(colors: &Columns, v: usize, others: &[u32], tolerance: f64) -> bool {
    let color = |v: usize| (0..colors.n_columns).map(|c| colors.column(c)[v]).collect::<Vec<f64>>();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<f64>>();
    let target = color(v);
    let others: Vec<Vec<f64>> = others.iter().map(|&u| color(u as usize)).collect();
    let Some(mut mixture) = others.first().cloned() else { return false };
    for _ in 0..MIXING_STEPS {
        let off = difference(&mixture, &target);
        if dot(&off, &off) <= tolerance * tolerance {
            return true;
        }
        let Some(best) = others.iter().min_by(|a, b| dot(a, &off).total_cmp(&dot(b, &off))) else {
            return false;
        };
        let step = difference(best, &mixture);
        let gain = -dot(&step, &off);
        if gain <= 0.0 {
            return false;
        }
        let length = (gain / dot(&step, &step)).min(1.0);
        mixture.iter_mut().zip(&step).for_each(|(x, d)| *x += length * d);
    }
    false
}
