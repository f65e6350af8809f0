//! Averages on both sides of a border edge: walking away from it over the faces of a segment,
//! unfolded into the plane.

use super::constants::{MOST_SLOPE_ERROR, STEP_DOUBT, STRAY_OF_NOISE};
use super::slopes::Slopes;
use super::surface::Surface;
use crate::mesh::vector::distance;
use crate::solve::MAX_JOINT_COLUMNS;
use crate::{memory, Result};

/// A rigid motion of the plane: rotation as a complex number, then a shift.
#[derive(Clone, Copy)]
struct Motion {
    rotation: [f64; 2],
    shift: [f64; 2],
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Motion {
    fn apply(self, p: [f64; 2]) -> [f64; 2] {
        let q = times(self.rotation, p);
        [q[0] + self.shift[0], q[1] + self.shift[1]]
    }
}

/// A border edge between two segments, given by a halfedge, and the bend across it.
pub(super) struct Bend {
    pub halfedge: usize,
    pub labels: [u32; 2],
    pub length: f64,
    pub cost: f64,
    pub bend: f64,
}

/// Which faces a walk has seen: those with its stamp.
pub(super) struct Marks {
    stamps: Vec<u32>,
    stamp: u32,
    queue: Vec<(usize, Motion)>,
}

impl Marks {
    /// None of `n` faces seen.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn new(n: usize) -> Result<Self> {
        Ok(Self { stamps: memory::repeated(0, n)?, stamp: 0, queue: Vec::new() })
    }
}

/// Averages over the faces of one side near a border edge, in the frame of the edge: x across it, y along it.
struct Side {
    area: f64,
    center: [f64; 2],
    gradient: [[f64; 2]; MAX_JOINT_COLUMNS],
    mean: [f64; MAX_JOINT_COLUMNS],
    /// Sums for the regression of the gradient on the distance from the edge.
    far_count: f64,
    far_area: f64,
    far_x: f64,
    far_xx: f64,
    far_gradient: [[f64; 2]; MAX_JOINT_COLUMNS],
    far_x_gradient: [[f64; 2]; MAX_JOINT_COLUMNS],
}

impl Side {
    const EMPTY: Self = Self {
        area: 0.0,
        center: [0.0; 2],
        gradient: [[0.0; 2]; MAX_JOINT_COLUMNS],
        mean: [0.0; MAX_JOINT_COLUMNS],
        far_count: 0.0,
        far_area: 0.0,
        far_x: 0.0,
        far_xx: 0.0,
        far_gradient: [[0.0; 2]; MAX_JOINT_COLUMNS],
        far_x_gradient: [[0.0; 2]; MAX_JOINT_COLUMNS],
    };
}

/// What a walk away from a border edge needs to know.
pub(super) struct Walk<'a> {
    pub slopes: &'a Slopes,
    pub surface: &'a Surface<'a>,
    pub labels: &'a [u32],
    /// Which faces have a neighbor of another label.
    pub at_border: &'a [bool],
}

impl Walk<'_> {
    /// The bend across the edge of halfedge `h`.
    pub(super) fn bend(&self, h: usize, marks: &mut Marks) -> Result<Bend> {
        let (f, surface) = (h / 3, self.surface);
        let g = surface.neighbors[f][h % 3] as usize;
        let p = self.slopes.layouts[f];
        let (tail, head) = (p[(h + 1) % 3], p[(h + 2) % 3]);
        let length = surface.lengths[f][h % 3].max(f64::MIN_POSITIVE);
        // The frame of the edge: its middle at the origin, y along it, x out of the face f,
        // to the right of the halfedge.
        let along = [(head[0] - tail[0]) / length, (head[1] - tail[1]) / length];
        let rotation = times([0.0, 1.0], [along[0], -along[1]]);
        let middle = times(rotation, [0.5 * (tail[0] + head[0]), 0.5 * (tail[1] + head[1])]);
        let home = Motion { rotation, shift: [-middle[0], -middle[1]] };
        let [from, to] = [surface.connectivity.tail(h), surface.connectivity.head(h)]
            .map(|v| surface.positions[v as usize]);
        let place = [0, 1, 2].map(|c| 0.5 * (from[c] + to[c]));
        let inner = self.side(f, home, place, marks)?;
        let outer = self.side(g, self.across(h, home), place, marks)?;
        let (a, b) = (self.labels[f], self.labels[g]);
        let cost = surface.costs[f][h % 3].max(1e-3);
        let bend = self.jump(&inner, &outer);
        Ok(Bend { halfedge: h, labels: [a.min(b), a.max(b)], length, cost, bend })
    }

    /// The motion of the face across halfedge `h`, unfolded into the plane of the face that has `motion`.
    /// Shapes need none.
    fn across(&self, h: usize, motion: Motion) -> Motion {
        if self.slopes.is_shape {
            return motion;
        }
        let (f, i) = (h / 3, h % 3);
        let Some(twin) = self.surface.connectivity.twin(h) else { return motion };
        let (g, j) = (twin / 3, twin % 3);
        let (p, q) = (&self.slopes.layouts[f], &self.slopes.layouts[g]);
        let (tail, head) = (p[(i + 1) % 3], p[(i + 2) % 3]);
        let (twin_tail, twin_head) = (q[(j + 1) % 3], q[(j + 2) % 3]);
        let length = self.surface.lengths[f][i].max(f64::MIN_POSITIVE).powi(2);
        let along = [(tail[0] - head[0]) / length, (tail[1] - head[1]) / length];
        let turn = times(along, [twin_head[0] - twin_tail[0], twin_tail[1] - twin_head[1]]);
        let rotation = times(motion.rotation, turn);
        let (to, from) = (motion.apply(head), times(rotation, twin_tail));
        Motion { rotation, shift: [to[0] - from[0], to[1] - from[1]] }
    }

    /// Averages over the faces with the label of `start` near the origin. The faces at the border itself may
    /// lie on the wrong side of it: they count only where there is nothing else.
    fn side(&self, start: usize, motion: Motion, place: [f64; 3], marks: &mut Marks) -> Result<Side> {
        let mut side = Side::EMPTY;
        let reach = self.slopes.reach[start];
        let label = self.labels[start];
        let mut skip_border = true;
        loop {
            marks.stamp += 1;
            marks.stamps[start] = marks.stamp;
            marks.queue.clear();
            memory::push(&mut marks.queue, (start, motion))?;
            let mut next = 0;
            while next < marks.queue.len() {
                let (f, motion) = marks.queue[next];
                next += 1;
                let center = self.center(f, motion, place);
                let away = if self.slopes.is_shape { center[0] } else { center[0].hypot(center[1]) };
                if f != start && away > 2.0 * reach {
                    continue;
                }
                if !(skip_border && self.at_border[f]) {
                    self.add(&mut side, f, motion, center, f == start || away <= reach);
                }
                for (h, g) in self.surface.around(f) {
                    if self.labels[g] == label && marks.stamps[g] != marks.stamp {
                        marks.stamps[g] = marks.stamp;
                        let there = self.across(h, motion);
                        memory::push(&mut marks.queue, (g, there))?;
                    }
                }
            }
            if side.area > 0.0 || !skip_border {
                return Ok(side);
            }
            skip_border = false;
            side = Side::EMPTY;
        }
    }

    /// What makes a mean of the sum over a side: its area, or for shapes the length of the vector area, so
    /// that rough sides, where normals cancel, have unit normals too.
    fn weight(&self, side: &Side) -> f64 {
        if !self.slopes.is_shape {
            return side.area;
        }
        let squared: f64 = side.gradient[..self.slopes.n_columns].iter().flatten().map(|x| x * x).sum();
        squared.sqrt().max(0.1 * side.area)
    }

    /// How large a step noise may feign: the means of the sides are those of as many values as they have
    /// faces.
    fn doubt(&self, inner: &Side, outer: &Side) -> f64 {
        let face = self.surface.mean_edge * self.surface.mean_edge;
        let columns = (self.slopes.n_columns as f64).sqrt();
        STEP_DOUBT * columns * self.slopes.noise * (face / inner.area + face / outer.area).sqrt()
    }

    /// Where the centroid of face `f` is in the frame of the edge; for shapes its distance in space from the
    /// middle of the edge, `place`, since unfolded noise makes ways longer.
    fn center(&self, f: usize, motion: Motion, place: [f64; 3]) -> [f64; 2] {
        if self.slopes.is_shape {
            return [distance(self.surface.centroids[f], place), 0.0];
        }
        let q = self.slopes.layouts[f];
        motion.apply([0, 1].map(|c| (q[0][c] + q[1][c] + q[2][c]) / 3.0))
    }

    fn add(&self, side: &mut Side, f: usize, motion: Motion, center: [f64; 2], near: bool) {
        let (area, k) = (self.surface.areas[f], self.slopes.n_columns);
        side.far_count += 1.0;
        side.far_area += area;
        side.far_x += area * center[0];
        side.far_xx += area * center[0] * center[0];
        if near {
            side.area += area;
            side.center[0] += area * center[0];
            side.center[1] += area * center[1];
        }
        for c in 0..k {
            let gradient = self.slopes.gradients[k * f + c];
            let gradient = if self.slopes.is_shape { gradient } else { times(motion.rotation, gradient) };
            for (d, slope) in gradient.into_iter().enumerate() {
                side.far_gradient[c][d] += area * slope;
                side.far_x_gradient[c][d] += area * center[0] * slope;
                if near {
                    side.gradient[c][d] += area * slope;
                }
            }
            if near {
                side.mean[c] += area * self.slopes.means[k * f + c];
            }
        }
    }

    /// The jump of the gradient from one side to the other, less what the curvature of the sides explains,
    /// and the step of the values where they may have one.
    fn jump(&self, inner: &Side, outer: &Side) -> f64 {
        if inner.area <= 0.0 || outer.area <= 0.0 {
            return 0.0;
        }
        let (mut jump, mut explained, mut step) = (0.0, 0.0, 0.0);
        let stray = STRAY_OF_NOISE * self.slopes.noise / self.surface.mean_edge;
        let [inner_weight, outer_weight] = [inner, outer].map(|side| self.weight(side));
        for c in 0..self.slopes.n_columns {
            let (a, b) = (inner.at_border(c, inner_weight, stray), outer.at_border(c, outer_weight, stray));
            for d in 0..2 {
                let difference = outer.gradient[c][d] / outer_weight - inner.gradient[c][d] / inner_weight;
                jump += difference * difference;
                explained += difference * (b.bent[d] - a.bent[d]);
            }
            step += (b.value - a.value) * (b.value - a.value);
        }
        let length = jump.sqrt();
        let explained = if length > 0.0 { (explained / length).clamp(0.0, length) } else { 0.0 };
        length - explained + self.slopes.step * (step.sqrt() - self.doubt(inner, outer)).max(0.0)
    }
}

/// Column `c` of a side, carried to the border edge.
struct AtBorder {
    /// By how much the gradient changes from the border to the middle of the side, as its curvature has it.
    bent: [f64; 2],
    /// The value at the middle of the edge.
    value: f64,
}

impl Side {
    /// Whether the regression of the gradient on the distance says anything, where gradients of single faces
    /// stray by `stray`: a side of one row of faces does not, and the slope of a few noisy faces explains any
    /// jump.
    fn knows_slope(&self, stray: f64) -> bool {
        let mean_x = self.far_x / self.far_area;
        let variance = self.far_xx / self.far_area - mean_x * mean_x;
        let error = stray * (self.center[0] / self.area).abs() / (self.far_count * variance.max(0.0)).sqrt();
        variance > 1e-3 * mean_x * mean_x && error < MOST_SLOPE_ERROR
    }

    fn at_border(&self, c: usize, weight: f64, stray: f64) -> AtBorder {
        let center = [self.center[0] / self.area, self.center[1] / self.area];
        let gradient = [self.gradient[c][0] / self.area, self.gradient[c][1] / self.area];
        let mean_x = self.far_x / self.far_area;
        let variance = self.far_xx / self.far_area - mean_x * mean_x;
        let knows_slope = self.knows_slope(stray);
        let bent = [0, 1].map(|d| {
            let covariance =
                self.far_x_gradient[c][d] / self.far_area - mean_x * self.far_gradient[c][d] / self.far_area;
            if knows_slope {
                covariance / variance * center[0] * self.area / weight
            } else {
                0.0
            }
        });
        AtBorder { bent, value: self.mean[c] / self.area - gradient[0] * center[0] - gradient[1] * center[1] }
    }
}
