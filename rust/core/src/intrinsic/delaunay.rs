//! The intrinsic Delaunay triangulation (Bobenko and Springborn 2007), by flips on edge lengths.

use crate::mesh::triangle::{apex, area, is_degenerate, twice_dot};
use crate::mesh::{Connectivity, Flip};
use crate::{memory, Result};

/// An edge is flipped where its opposite angles exceed π by more than this, in radians: above rounding (some
/// 1e-15 in good triangles, 1e-8 in the worst), so that four points on a circle do not flip forever.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Flips are finite, but no useful bound is known; meshes of scans take less than one a face. This many a
/// face only stop a cycle that rounding might cause among slivers.
const FLIPS_PER_FACE: usize = 100;

/// Flips edges until every interior edge is Delaunay (its two opposite angles sum to at most π), and returns
/// the new connectivity, its edge lengths and the number of flips.
///
/// Edges without a twin stay. An edge stays too, Delaunay or not, if its flip would make a degenerate
/// triangle ([`is_degenerate`]); mollified lengths make that rare. Faces may come out with a repeated vertex
/// or glued to a neighbor along two edges; the connectivity carries its twins, so that is no harm.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn delaunay_flips(
    connectivity: &Connectivity,
    lengths: &[[f64; 3]],
) -> Result<(Connectivity, Vec<[f64; 3]>, usize)> {
    delaunay_flips_carrying(connectivity, lengths, &mut [])
}

/// [`delaunay_flips`], with values of the faces carried along: a flip gives both new faces the mean of the
/// two old ones by area, so that the integral over the surface stays and faces that no flip touches keep
/// their value.
///
/// `face_values` has an entry a face, or none at all.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn delaunay_flips_carrying(
    connectivity: &Connectivity,
    lengths: &[[f64; 3]],
    face_values: &mut [f64],
) -> Result<(Connectivity, Vec<[f64; 3]>, usize)> {
    let mut surface = Surface { connectivity: connectivity.copied()?, lengths: memory::twin(lengths)? };
    let inner = connectivity.edges().filter(|&h| connectivity.twin(h).is_some());
    let mut stack: Vec<usize> = memory::sifted(inner)?;
    let limit = FLIPS_PER_FACE * connectivity.n_faces();
    let mut n_flips = 0;
    while let Some(h) = stack.pop() {
        if n_flips < limit && surface.excess(h) > ANGLE_TOLERANCE {
            let pair = surface.connectivity.twin(h).map(|twin| [h / 3, twin / 3]);
            let areas = pair.map(|faces| faces.map(|f| area(surface.lengths[f])));
            if let Some(flip) = surface.flip(h) {
                n_flips += 1;
                if let (Some(faces), Some(areas), false) = (pair, areas, face_values.is_empty()) {
                    average(face_values, faces, areas);
                }
                memory::extend(&mut stack, 4)?;
                stack.extend(flip.outer.map(|(_, new)| new));
            }
        }
    }
    Ok((surface.connectivity, surface.lengths, n_flips))
}

/// Gives two faces the mean of their values by area; equal values stay to the last bit.
fn average(values: &mut [f64], [f, g]: [usize; 2], areas: [f64; 2]) {
    if values[f] != values[g] {
        let mean = (areas[0] * values[f] + areas[1] * values[g]) / (areas[0] + areas[1]);
        (values[f], values[g]) = (mean, mean);
    }
}

/// A triangulation that changes.
struct Surface {
    connectivity: Connectivity,
    lengths: Vec<[f64; 3]>,
}

impl Surface {
    /// By how much the two angles opposite the edge of `h` exceed π; negative for an edge without a twin.
    fn excess(&self, h: usize) -> f64 {
        let angle = |h: usize| (4.0 * area(self.lengths[h / 3])).atan2(twice_dot(self.lengths[h / 3], h % 3));
        self.connectivity.twin(h).map_or(-1.0, |twin| angle(h) + angle(twin) - std::f64::consts::PI)
    }

    /// Flips the edge of `h`, unless a new triangle would be degenerate.
    fn flip(&mut self, h: usize) -> Option<Flip> {
        let twin = self.connectivity.twin(h).filter(|twin| twin / 3 != h / 3)?;
        let (l, m) = (self.lengths[h / 3], self.lengths[twin / 3]);
        let (i, j) = (h % 3, twin % 3);
        let ([s, height], [t, depth]) = (apex(l, i, area(l)), apex(m, j, area(m)));
        let diagonal = (l[i] - t - s).hypot(height + depth);
        // The faces left and right of the new edge, in the order of `Connectivity::flip`.
        let first = [m[(j + 1) % 3], diagonal, l[(i + 2) % 3]];
        let second = [l[(i + 1) % 3], diagonal, m[(j + 2) % 3]];
        if is_degenerate(first) || is_degenerate(second) {
            return None;
        }
        let flip = self.connectivity.flip(h)?;
        self.lengths[h / 3] = first;
        self.lengths[twin / 3] = second;
        Some(flip)
    }
}
