//! What a segment would look like at a face if it went on there: a plane,
//! or a quadratic function fitted to its faces nearby.

use super::constants::{MOST_NEARBY, NEARBY, NEARBY_OF_NOISE, PATCH_STIFFNESS};
use super::surface::Surface;
use crate::linear::small::{least_eigen3, scatter, symmetric_eigen};
use crate::linear::Columns;
use crate::mesh::vector::{add, dot, norm, scale, sub, unit, Point};
use crate::tools::heights::{value, Frame, LeastSquares, TERMS};

/// How many faces a local fit looks at where the noise is this part of a mean edge.
pub(super) fn patch_size(noise: f64) -> usize {
    (NEARBY + NEARBY_OF_NOISE * noise).min(MOST_NEARBY) as usize
}

/// The plane of a whole segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentPlane {
    normal: [f64; 3],
    center: [f64; 3],
    /// Root mean square distance of the faces' corners from it.
    pub spread: f64,
}

impl SegmentPlane {
    /// The plane of least squared distance, weighted by area, of `faces`; nothing where they have no area.
    pub(super) fn through(surface: &Surface<'_>, faces: &[u32]) -> Option<Self> {
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
        let corners = |&f: &u32| {
            let weight = surface.areas[f as usize] / (3.0 * area);
            let corners = surface.connectivity.faces()[f as usize];
            corners.map(|v| (sub(surface.positions[v as usize], center), weight))
        };
        let (least, normal) = least_eigen3(scatter(faces.iter().flat_map(corners)));
        // The side that the faces show.
        let outward: f64 = faces.iter().map(|&f| dot(surface.vector_area(f as usize), normal)).sum();
        let normal = scale(normal, outward.signum());
        Some(Self { normal, center, spread: least.max(0.0).sqrt() })
    }

    /// The unit normal, to the side that the faces show.
    pub(super) fn normal(&self) -> Point {
        self.normal
    }

    /// The distance of `p`.
    pub(super) fn distance(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, sub(p, self.center)).abs()
    }
}

/// A function `1, s, t, s², st, t²` over the tangent plane of a patch: its height,
/// or the columns of a signal.
pub(super) struct Patch {
    frame: Frame,
    /// For each column of the signal the coefficients; for the height one.
    coefficients: Vec<[f64; TERMS]>,
}

impl Patch {
    /// The fit to the corners of `faces`; without `signal` of their height, else of the signal.
    /// `None` where there is no area.
    pub(super) fn fit(surface: &Surface<'_>, faces: &[u32], signal: Option<&Columns>) -> Option<Self> {
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
        let frame = Frame::new(origin.map(|c| c / area), unit(normal), area.sqrt());
        let mut squares = LeastSquares::new(signal.map_or(1, |s| s.n_columns));
        for &f in faces {
            let weight = surface.areas[f as usize] / area;
            for v in surface.connectivity.faces()[f as usize] {
                let (terms, height) = frame.terms(surface.positions[v as usize]);
                squares.add(weight, &terms, |c| signal.map_or(height, |s| s.column(c)[v as usize]));
            }
        }
        Some(Self { frame, coefficients: squares.solve(1e-9, PATCH_STIFFNESS) })
    }

    /// How far vertex `v` lies off the continued patch: a distance,
    /// or the norm over the columns of the signal.
    pub(super) fn misfit(&self, surface: &Surface<'_>, v: usize, signal: Option<&Columns>) -> f64 {
        match signal {
            None => self.frame.distance(&self.coefficients[0], surface.positions[v]).abs(),
            Some(signal) => {
                let terms = self.frame.terms(surface.positions[v]).0;
                let off = |(k, c): (usize, &[f64; TERMS])| (signal.column(k)[v] - value(c, &terms)).powi(2);
                self.coefficients.iter().enumerate().map(off).sum::<f64>().sqrt()
            }
        }
    }

    /// The sum of the squared distances of all corners of `faces` from a patch of a shape.
    pub(super) fn squares(&self, surface: &Surface<'_>, faces: &[u32]) -> f64 {
        let corners = faces.iter().flat_map(|&f| surface.connectivity.faces()[f as usize]);
        corners.map(|v| self.misfit(surface, v as usize, None).powi(2)).sum()
    }

    /// The unit directions in which a patch of a shape curves, that in which it curves most first.
    pub(super) fn curvature_directions(&self) -> [Point; 2] {
        let c = &self.coefficients[0];
        let (values, vectors) = symmetric_eigen(vec![vec![2.0 * c[3], c[4]], vec![c[4], 2.0 * c[5]]]);
        let most = usize::from(values[1].abs() > values[0].abs());
        let [first, second, _] = self.frame.axes;
        [most, 1 - most].map(|i| add(scale(first, vectors[i][0]), scale(second, vectors[i][1])))
    }

    /// The unit normal of the continued patch of a shape at `p`.
    pub(super) fn normal(&self, p: Point) -> Point {
        self.frame.normal(&self.coefficients[0], p)
    }
}

/// The `count` faces of the segment of `start` that are nearest to it in steps over edges. Those at the
/// border may be in the wrong segment and are left out, unless they are most of those nearby. `seen` marks
/// faces by `stamp`.
pub(super) fn nearby(
    surface: &Surface<'_>,
    labels: &[u32],
    start: usize,
    count: usize,
    (seen, stamp): (&mut [u32], u32),
) -> Vec<u32> {
    let label = labels[start];
    let mut queue = vec![start as u32];
    let mut inside = Vec::with_capacity(count);
    seen[start] = stamp;
    let mut next = 0;
    while next < queue.len().min(2 * count) && inside.len() < count {
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
    if 3 * inside.len() < next.min(count) {
        queue.truncate(next.min(count));
        queue
    } else {
        inside
    }
}
