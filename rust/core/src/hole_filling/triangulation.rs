//! The triangulation of minimum weight of a polygon in space [Barequet and Sharir 1995; Liepa 2003].

use rayon::prelude::*;

use super::polygon::Polygon;
use super::rims::Rims;
use crate::mesh::vector::{area_vector, distance, dot, norm, scale, Point};
use crate::{memory, Progress, Result};

/// Polygons of up to this many vertices are triangulated by the full table, whose time grows with the cube:
/// some 0.5 s here. Longer ones go through [`super::long_loops`].
pub(super) const TABLE_LIMIT: usize = 400;

/// Folds are compared in steps of this part of `1 - cos(dihedral angle)`, 2.5 degrees where the surface is
/// flat: finer would let rounding decide between triangulations of a flat polygon, and not the shape of their
/// triangles.
const FOLD_STEPS: f64 = 1024.0;

/// The fold of a triangle without area: beyond that of any dihedral angle.
const DEGENERATE: u32 = 1 << 16;

/// A triangle counts as degenerate below this part of its longest edge squared,
/// a height of 2e-7 of that edge.
const DEGENERATE_AREA: f64 = 1e-7;

/// By how much the sum of squared edge lengths counts beside the area: little, so that it decides between
/// triangulations of equal area, as all of a flat polygon are, for the compact triangles.
const COMPACTNESS: f64 = 0.01;

/// The weight of a triangulation: first its worst fold, then its size.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Weight {
    /// The largest `1 - cos(dihedral angle)`, in steps.
    fold: u32,
    /// The area and a little of the squared edge lengths.
    size: f64,
}

/// No triangulation.
const IMPOSSIBLE: Weight = Weight { fold: u32::MAX, size: f64::INFINITY };

/// The best triangulation of the polygon from one place to another.
#[derive(Clone, Copy)]
struct Cell {
    weight: Weight,
    /// The tip of its triangle at the chord, and that triangle's unit normal.
    tip: u32,
    normal: Point,
}

#[cfg(test)]
thread_local! {
    /// How many triangles the tables of this thread have compared.
    pub(super) static TRIED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// The triangulation with the least weight, as places in the polygon, counterclockwise; nothing if every
/// triangulation has an edge that is taken already, or after a cancellation.
///
/// The weight of a triangulation is its largest dihedral angle, those across the polygon's own edges
/// included, then its area (Liepa 2003, section 3), with a small share of squared edge lengths. A degenerate
/// triangle is worse than any fold.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn minimum_weight(
    polygon: &Polygon,
    rims: &Rims,
    progress: &Progress,
) -> Result<Option<Vec<[u32; 3]>>> {
    let n = polygon.len();
    #[cfg(test)]
    TRIED.set(TRIED.get() + n * n * n / 6);
    let empty = Cell { weight: IMPOSSIBLE, tip: 0, normal: [0.0; 3] };
    let mut table = memory::repeated(empty, n * n)?;
    for i in 0..n {
        table[i * n + (i + 1) % n] =
            Cell { weight: Weight { fold: 0, size: 0.0 }, tip: 0, normal: polygon.outside[i] };
    }
    for span in 2..n {
        if progress.is_cancelled() {
            return Ok(None);
        }
        let best = |i: usize| {
            let j = i + span;
            if span < n - 1 && rims.is_taken(polygon.vertices[i], polygon.vertices[j]) {
                empty
            } else {
                best_cell(polygon, &table, i, j)
            }
        };
        let row: Vec<Cell> = memory::joined((0..n - span).into_par_iter().with_min_len(32).map(best))?;
        for (i, cell) in row.into_iter().enumerate() {
            table[i * n + i + span] = cell;
        }
    }
    Ok(triangles(&table, n))
}

/// The best triangulation from place `i` to place `j`, all shorter ones being known.
fn best_cell(polygon: &Polygon, table: &[Cell], i: usize, j: usize) -> Cell {
    let n = polygon.len();
    let mut best = Cell { weight: IMPOSSIBLE, tip: 0, normal: [0.0; 3] };
    for k in i + 1..j {
        let (left, right) = (&table[i * n + k], &table[k * n + j]);
        let fold = left.weight.fold.max(right.weight.fold);
        let size = left.weight.size + right.weight.size;
        // The triangle can only add to both.
        if (Weight { fold, size }) >= best.weight {
            continue;
        }
        let corners = [i, k, j].map(|place| polygon.points[place]);
        let squares = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| distance(corners[a], corners[b]).powi(2));
        let vector = area_vector(corners);
        let area = norm(vector);
        let longest = squares.iter().copied().fold(0.0, f64::max);
        let is_degenerate = area <= DEGENERATE_AREA * longest || polygon.vertices[i] == polygon.vertices[j];
        let normal = if is_degenerate { [0.0; 3] } else { scale(vector, 1.0 / area) };
        let own = if is_degenerate {
            DEGENERATE
        } else {
            let closing = (i == 0 && j == n - 1).then(|| polygon.outside[n - 1]);
            [Some(left.normal), Some(right.normal), closing]
                .into_iter()
                .flatten()
                .map(|m| folded(normal, m))
                .fold(0, u32::max)
        };
        let size = size + area + COMPACTNESS * squares.iter().sum::<f64>();
        let weight = Weight { fold: fold.max(own), size };
        if weight < best.weight {
            best = Cell { weight, tip: k as u32, normal };
        }
    }
    best
}

/// `1 - cos` of the angle between two unit normals, in steps; 0 if one is not known (zero).
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn folded(a: Point, b: Point) -> u32 {
    if a == [0.0; 3] || b == [0.0; 3] {
        0
    } else {
        (FOLD_STEPS * (1.0 - dot(a, b))).round().max(0.0) as u32
    }
}

/// Reads the triangles out of the table.
fn triangles(table: &[Cell], n: usize) -> Option<Vec<[u32; 3]>> {
    if table[n - 1].weight == IMPOSSIBLE {
        return None;
    }
    let mut found = Vec::with_capacity(n - 2);
    let mut stack = vec![(0, n - 1)];
    while let Some((i, j)) = stack.pop() {
        if j > i + 1 {
            let k = table[i * n + j].tip as usize;
            found.push([i, k, j].map(|place| place as u32));
            stack.extend([(k, j), (i, k)]);
        }
    }
    Some(found)
}
