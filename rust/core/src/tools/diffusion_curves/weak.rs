//! Borders that say nothing: without them the surface comes back as well.

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{SHADING, UNSEEN, WORSE};
use super::sorting::Paint;
use super::{diffusion_curves, DiffusionCurves, DiffusionCurvesOptions};
use crate::operators::voronoi_mass;
use crate::Result;

/// Regions, and how well each comes back.
struct Trial<'a> {
    paint: &'a Paint<'a>,
    mass: Vec<f64>,
}

/// Makes one region of two as long as the surface comes back as well without their border: faintest borders
/// first, as many at once as have no region in common. Finishing stops with what is reached.
pub(super) fn merge_weak(paint: &Paint<'_>, labels: &mut [i32]) -> Result<()> {
    if paint.progress.is_finishing() {
        return Ok(());
    }
    let mesh = paint.mesh;
    let trial = Trial { paint, mass: voronoi_mass(mesh.connectivity(), mesh.edge_lengths())? };
    let scale = paint.scale();
    let found = trial.run(labels)?;
    let mut errors = trial.errors(&found, labels);
    let mut jumps = trial.jumps(&found, labels);
    let mut kept = BTreeSet::new();
    while !paint.progress.is_finishing() {
        let mut order: Vec<([i32; 2], f64)> =
            jumps.iter().map(|(&pair, &[length, sum])| (pair, sum / length)).collect();
        order.retain(|(pair, jump)| *jump <= SHADING * scale && !kept.contains(pair));
        order.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let mut used = BTreeSet::new();
        order.retain(|([a, b], _)| {
            let free = !used.contains(a) && !used.contains(b);
            if free {
                used.extend([*a, *b]);
            }
            free
        });
        if order.is_empty() {
            break;
        }
        let merged: BTreeMap<i32, i32> = order.iter().map(|&([a, b], _)| (b, a)).collect();
        let tried: Vec<i32> = labels.iter().map(|label| *merged.get(label).unwrap_or(label)).collect();
        let found = trial.run(&tried)?;
        if paint.progress.is_finishing() {
            // Not improved to the end: it says nothing about the borders.
            break;
        }
        let after = trial.errors(&found, &tried);
        for (pair, _) in order {
            let [a, b] = pair.map(|label| errors.get(&label).copied().unwrap_or_default());
            let [area, error] = after.get(&pair[0]).copied().unwrap_or_default();
            let channels = paint.colors.n_columns as f64;
            if error <= (WORSE * (a[1] + b[1])).max((UNSEEN * scale).powi(2) * area * channels) {
                labels.iter_mut().filter(|label| **label == pair[1]).for_each(|label| *label = pair[0]);
                errors.remove(&pair[1]);
                errors.insert(pair[0], [area, error]);
                jumps = renamed(&jumps, pair);
                kept.retain(|other: &[i32; 2]| !other.contains(&pair[1]));
            } else {
                kept.insert(pair);
            }
        }
    }
    Ok(())
}

impl Trial<'_> {
    fn run(&self, labels: &[i32]) -> Result<DiffusionCurves> {
        let Paint { mesh, colors, fidelity, progress } = *self.paint;
        let options = DiffusionCurvesOptions { fidelity, ..DiffusionCurvesOptions::default() };
        diffusion_curves(mesh, colors, labels, &options, &progress.quiet())
    }

    /// The area of every region and the squared error of its colors over it.
    fn errors(&self, found: &DiffusionCurves, labels: &[i32]) -> BTreeMap<i32, [f64; 2]> {
        let faces = self.paint.mesh.connectivity().faces();
        let mut side = found.sides.clone();
        for (f, face) in (0..).zip(faces) {
            face.iter().for_each(|&v| side[v as usize] = side[v as usize].or(Some(f)));
        }
        let mut errors: BTreeMap<i32, [f64; 2]> = BTreeMap::new();
        for (v, mass) in self.mass.iter().enumerate() {
            let Some(face) = side[v] else { continue };
            let difference = |c: usize| found.redrawn.colors.column(c)[v] - self.paint.colors.column(c)[v];
            let sum = errors.entry(labels[face as usize]).or_default();
            sum[0] += mass;
            sum[1] += mass * (0..self.paint.colors.n_columns).map(|c| difference(c).powi(2)).sum::<f64>();
        }
        errors
    }

    /// For every two regions with a border its length, and the sum over it of how far colors jump.
    fn jumps(&self, found: &DiffusionCurves, labels: &[i32]) -> BTreeMap<[i32; 2], [f64; 2]> {
        let connectivity = self.paint.mesh.connectivity();
        let lengths = self.paint.mesh.edge_lengths();
        let curves = &found.curves;
        let width = 2 * curves.n_channels;
        let row: BTreeMap<[u32; 2], usize> =
            curves.edges.iter().enumerate().map(|(e, &[a, b])| ([a.min(b), a.max(b)], e)).collect();
        let mut jumps: BTreeMap<[i32; 2], [f64; 2]> = BTreeMap::new();
        for h in 0..connectivity.n_halfedges() {
            let Some(mate) = connectivity.mate(h).filter(|mate| h < *mate) else { continue };
            let (a, b) = (labels[h / 3], labels[mate / 3]);
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            let Some(&e) = row.get(&[tail.min(head), tail.max(head)]).filter(|_| a != b) else { continue };
            let colors = e * width..(e + 1) * width;
            let pairs = curves.left[colors.clone()].iter().zip(&curves.right[colors]);
            let jump = (pairs.map(|(x, y)| (x - y).powi(2)).sum::<f64>() / 2.0).sqrt();
            let sum = jumps.entry([a.min(b), a.max(b)]).or_default();
            let length = lengths[h / 3][h % 3];
            sum[0] += length;
            sum[1] += length * jump;
        }
        jumps
    }
}

/// The borders after the second of a pair of regions has become part of the first.
fn renamed(jumps: &BTreeMap<[i32; 2], [f64; 2]>, [kept, gone]: [i32; 2]) -> BTreeMap<[i32; 2], [f64; 2]> {
    let mut renamed: BTreeMap<[i32; 2], [f64; 2]> = BTreeMap::new();
    for (pair, sums) in jumps {
        let [a, b] = pair.map(|label| if label == gone { kept } else { label });
        if a != b {
            let sum = renamed.entry([a.min(b), a.max(b)]).or_default();
            sum[0] += sums[0];
            sum[1] += sums[1];
        }
    }
    renamed
}
