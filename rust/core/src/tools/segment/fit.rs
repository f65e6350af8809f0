//! What a segment would look like at a face if it went on there: a plane, or a quadratic function fitted to its faces nearby.

use super::surface::Surface;
use crate::mesh::vector::{cross, dot, norm, scale, sub, unit};
use crate::solve::eigen::symmetric_eigen;
use crate::solve::Columns;

/// Faces of a segment that a local fit looks at.
const NEARBY: usize = 60;

/// Coefficients of `1, s, t, s², st, t²`.
const TERMS: usize = 6;

/// Weight of the pull of the quadratic terms to zero, in squared lengths of the fitted patch: it decides where few faces do not.
const STIFFNESS: f64 = 1e-3;

/// The plane of a whole segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    normal: [f64; 3],
    center: [f64; 3],
    /// Root mean square distance of the faces' corners from it.
    pub spread: f64,
}

impl Plane {
    /// The plane of least squared distance, weighted by area, of `faces`; nothing where they have no area.
    pub fn through(surface: &Surface<'_>, faces: &[u32]) -> Option<Self> {
        let mut area = 0.0;
        let mut center = [0.0; 3];
        for &f in faces {
            let a = surface.areas[f as usize];
            area += a;
            (0..3).for_each(|c| center[c] += a * surface.centroids[f as usize][c]);
        }
        if area <= 0.0 {
            return None;
        }
        let center = center.map(|c| c / area);
        let mut moments = vec![vec![0.0; 3]; 3];
        for &f in faces {
            let weight = surface.areas[f as usize] / (3.0 * area);
            for v in surface.connectivity.faces()[f as usize] {
                let d = sub(surface.positions[v as usize], center);
                (0..3).for_each(|i| (0..3).for_each(|j| moments[i][j] += weight * d[i] * d[j]));
            }
        }
        let (values, vectors) = symmetric_eigen(moments);
        Some(Self { normal: std::array::from_fn(|c| vectors[0][c]), center, spread: values[0].max(0.0).sqrt() })
    }

    /// The distance of `p`.
    pub fn distance(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, sub(p, self.center)).abs()
    }
}

/// A function `1, s, t, s², st, t²` over the tangent plane of a patch: its height, or the columns of a signal.
pub(super) struct Patch {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
    scale: f64,
    /// For each column of the signal the coefficients; for the height one.
    coefficients: Vec<[f64; TERMS]>,
}

impl Patch {
    /// The fit to the corners of `faces`; without `signal` of their height, else of the signal. `None` where there is no area.
    pub fn fit(surface: &Surface<'_>, faces: &[u32], signal: Option<&Columns>) -> Option<Self> {
        let mut normal = [0.0; 3];
        let mut origin = [0.0; 3];
        let mut area = 0.0;
        for &f in faces {
            let (a, n) = (surface.areas[f as usize], surface.vector_area(f as usize));
            area += a;
            (0..3).for_each(|c| {
                normal[c] += n[c];
                origin[c] += a * surface.centroids[f as usize][c];
            });
        }
        if area <= 0.0 || norm(normal) <= 0.0 {
            return None;
        }
        let axes = frame(unit(normal));
        let origin = origin.map(|c| c / area);
        let mut patch = Self { origin, axes, scale: area.sqrt(), coefficients: Vec::new() };
        let columns = signal.map_or(1, |s| s.n_columns);
        let mut matrix = [[0.0; TERMS]; TERMS];
        let mut right = vec![[0.0; TERMS]; columns];
        for &f in faces {
            let weight = surface.areas[f as usize] / area;
            for v in surface.connectivity.faces()[f as usize] {
                let (terms, height) = patch.terms(surface.positions[v as usize]);
                for i in 0..TERMS {
                    (0..TERMS).for_each(|j| matrix[i][j] += weight * terms[i] * terms[j]);
                    for (c, row) in right.iter_mut().enumerate() {
                        let value = signal.map_or(height, |s| s.column(c)[v as usize]);
                        row[i] += weight * terms[i] * value;
                    }
                }
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            // The constant and the slopes need it only where the corners lie on a line.
            row[i] += if i < 3 { 1e-9 } else { STIFFNESS };
        }
        patch.coefficients = right.iter().map(|row| solve(matrix, *row)).collect();
        Some(patch)
    }

    /// The terms at `p`, and its height, in units of the patch's size.
    fn terms(&self, p: [f64; 3]) -> ([f64; TERMS], f64) {
        let d = sub(p, self.origin);
        let [s, t, height] = self.axes.map(|axis| dot(axis, d) / self.scale);
        ([1.0, s, t, s * s, s * t, t * t], height)
    }

    /// How far vertex `v` lies off the continued patch: a distance, or the norm over the columns of the signal.
    pub fn misfit(&self, surface: &Surface<'_>, v: usize, signal: Option<&Columns>) -> f64 {
        let (terms, height) = self.terms(surface.positions[v]);
        let at = |c: &[f64; TERMS]| terms.iter().zip(c).map(|(t, c)| t * c).sum::<f64>();
        match signal {
            None => {
                let c = &self.coefficients[0];
                let slope =
                    [c[1] + 2.0 * c[3] * terms[1] + c[4] * terms[2], c[2] + c[4] * terms[1] + 2.0 * c[5] * terms[2]];
                let steepness = (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
                self.scale * (height - at(c)).abs() / steepness
            }
            Some(signal) => {
                let squares = self.coefficients.iter().enumerate().map(|(k, c)| (signal.column(k)[v] - at(c)).powi(2));
                squares.sum::<f64>().sqrt()
            }
        }
    }
}

/// Two unit vectors in the plane of the unit `normal`, and the normal.
fn frame(normal: [f64; 3]) -> [[f64; 3]; 3] {
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = dot(axis, normal);
    let s = unit(sub(axis, scale(normal, across)));
    [s, cross(normal, s), normal]
}

/// Solves a small positive definite system by Cholesky's factorisation.
fn solve(mut a: [[f64; TERMS]; TERMS], mut b: [f64; TERMS]) -> [f64; TERMS] {
    for j in 0..TERMS {
        for k in 0..j {
            let factor = a[j][k];
            (j..TERMS).for_each(|i| a[i][j] -= factor * a[i][k]);
        }
        let pivot = a[j][j].max(f64::MIN_POSITIVE).sqrt();
        (j..TERMS).for_each(|i| a[i][j] /= pivot);
    }
    for i in 0..TERMS {
        (0..i).for_each(|k| b[i] -= a[i][k] * b[k]);
        b[i] /= a[i][i];
    }
    for i in (0..TERMS).rev() {
        (i + 1..TERMS).for_each(|k| b[i] -= a[k][i] * b[k]);
        b[i] /= a[i][i];
    }
    b
}

/// The faces of the segment of `start` that are nearest to it in steps over edges, those at the border left out if there are
/// others; `seen` marks faces by `stamp`.
pub(super) fn nearby(surface: &Surface<'_>, labels: &[u32], start: usize, seen: &mut [u32], stamp: u32) -> Vec<u32> {
    let label = labels[start];
    let mut queue = vec![start as u32];
    let mut inside = Vec::with_capacity(NEARBY);
    seen[start] = stamp;
    let mut next = 0;
    while next < queue.len() && inside.len() < NEARBY {
        let f = queue[next] as usize;
        next += 1;
        if !surface.is_at_border(labels, f) {
            inside.push(f as u32);
        }
        for (_, g) in surface.around(f) {
            if labels[g] == label && seen[g] != stamp {
                seen[g] = stamp;
                queue.push(g as u32);
            }
        }
    }
    if inside.is_empty() {
        queue
    } else {
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved() {
        let a: [[f64; TERMS]; TERMS] = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 8.0 } else { 1.0 / (1.0 + i as f64 + j as f64) })
        });
        let x: [f64; TERMS] = std::array::from_fn(|i| i as f64 - 2.5);
        let b = std::array::from_fn(|i| (0..TERMS).map(|j| a[i][j] * x[j]).sum());
        let found = solve(a, b);
        assert!(found.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
    }
}
