//! Planes that fit their faces while every corner lies on the planes of all its facets.
//!
//! Minimizes `Σ_P ∫_P (n_P · x − o_P)² + stay Σ_c a_c ‖x_c − x̄_c‖²` subject to `n_P · x_c = o_P` wherever
//! `c` is a corner of `P`, over planes and corners together, by Newton's method on the conditions of
//! optimality (sequential quadratic programming, Gauss and Newton's Hessian: Nocedal and Wright 2006, chapter
//! 18). The Hessian is one block for each plane and each corner, so a step is one sparse system over the
//! pairs of facet and corner.

use super::constants::{DAMPING, FARTHEST, FLAT, FLATTEST, REGULAR, SLACK, SLOW, STEPS};
use super::hubs::Hubs;
use super::moments::{quadratic, Plane};
use super::shape::Shape;
use super::stage::Stage;
use super::triangulation::axes;
use crate::error::SolveError;
use crate::linear::cholesky::Cholesky;
use crate::linear::pattern::LowerPattern;
use crate::memory;
use crate::mesh::vector::{add, area_vector, distance, dot, norm, scale, sub, unit, Point};
use crate::{Error, Result};

/// A facet at a corner.
#[derive(Clone, Copy)]
struct Incidence {
    facet: usize,
    corner: usize,
}

/// One plane in a step: turned by the first two unknowns, pushed by the third.
struct Turning {
    axes: [Point; 2],
    center: Point,
    /// The height of the center.
    height: f64,
    inverse: [Point; 3],
    gradient: Point,
}

/// Flattens the facets of `shape`, with corners near `targets`;
/// returns the largest distance of a corner from a plane.
///
/// # Errors
/// [`crate::Error::Cancelled`], [`crate::Error::Memory`].
pub(super) fn flatten(shape: &mut Shape, stay: f64, targets: &[Point], stage: &Stage<'_>) -> Result<f64> {
    set_triangles(shape);
    let of_facet = |(facet, f): (usize, _)| {
        super::shape::Facet::corners(f).map(move |c| Incidence { facet, corner: c as usize })
    };
    // Faces that stay are triangles: they are flat wherever their corners are.
    let made = shape.facets.iter().enumerate().filter(|(_, facet)| !facet.is_held);
    let incidences: Vec<Incidence> = memory::sifted(made.flat_map(of_facet))?;
    let (n, m) = (targets.len(), shape.facets.len());
    let n_corners: Vec<usize> = memory::gathered(shape.facets.iter().map(|facet| facet.corners().count()))?;
    let mut share = memory::repeated(0.0, n)?;
    let mut at = (memory::repeated(Vec::new(), n)?, memory::repeated(Vec::new(), m)?);
    for (k, i) in incidences.iter().enumerate() {
        share[i.corner] += shape.facets[i.facet].moments.area / n_corners[i.facet] as f64;
        memory::push(&mut at.0[i.corner], k)?;
        memory::push(&mut at.1[i.facet], k)?;
    }
    let mobility: Vec<f64> = memory::gathered(shape.corners.iter().zip(&share).map(|(corner, share)| {
        let weight = corner.firmness * stay * share;
        if corner.is_fixed || weight <= 0.0 {
            0.0
        } else {
            1.0 / weight
        }
    }))?;
    let hubs = Hubs::new(&at.0, &at.1)?;
    let is_hub = [hubs.mask(true, n)?, hubs.mask(false, m)?];
    let pattern = pattern(&incidences, &at.0, &at.1, &is_hub)?;
    let (starts, rows) = (&pattern.starts, &pattern.rows);
    let mut cholesky = Cholesky::analyze(&pattern, None, stage.progress())?;
    let (mut last, mut slack) = (f64::INFINITY, SLACK[usize::from(shape.off_planes() < FLAT)]);
    for step in 0..2 * STEPS {
        stage.step()?;
        // The last ones make the least changes that flatten.
        let only_flattens = step >= STEPS;
        if only_flattens {
            slack = REGULAR;
        }
        let turning: Vec<Turning> = memory::gathered(shape.facets.iter().map(Turning::new))?;
        let of_plane = |i: &Incidence| turning[i.facet].derivative(shape.corners[i.corner].point);
        let of_planes: Vec<Point> = memory::gathered(incidences.iter().map(of_plane))?;
        let of_corners: Vec<Point> = memory::gathered(
            incidences.iter().map(|i| shape.free(i.corner, shape.facets[i.facet].plane.normal)),
        )?;
        let mut values = memory::repeated(0.0, rows.len())?;
        for k in 0..incidences.len() {
            for e in starts[k]..starts[k + 1] {
                let (i, j) = (incidences[k], incidences[rows[e]]);
                if i.facet == j.facet && !is_hub[1][i.facet] {
                    values[e] += quadratic(&turning[i.facet].inverse, of_planes[rows[e]], of_planes[k]);
                }
                if i.corner == j.corner && !is_hub[0][i.corner] {
                    values[e] += mobility[i.corner] * dot(of_corners[rows[e]], of_corners[k]);
                }
            }
            values[starts[k]] *= 1.0 + slack;
            let Incidence { facet, corner } = incidences[k];
            if is_hub[1][facet] {
                values[starts[k]] += slack * quadratic(&turning[facet].inverse, of_planes[k], of_planes[k]);
            }
            if is_hub[0][corner] {
                values[starts[k]] += slack * mobility[corner] * dot(of_corners[k], of_corners[k]);
            }
        }
        let pull = |c: usize| {
            let is_pulled = !only_flattens && mobility[c] > 0.0;
            if is_pulled {
                shape.free(c, sub(targets[c], shape.corners[c].point))
            } else {
                [0.0; 3]
            }
        };
        let fall = |f: &Turning| f.inverse.map(|row| if only_flattens { 0.0 } else { -dot(row, f.gradient) });
        let off = |(k, i): (usize, &Incidence)| {
            let height = shape.facets[i.facet].plane.height(shape.corners[i.corner].point);
            [height + dot(of_planes[k], fall(&turning[i.facet])) + dot(of_corners[k], pull(i.corner))]
        };
        let mut multipliers: Vec<[f64; 1]> = memory::gathered(incidences.iter().enumerate().map(off))?;
        match cholesky.factorize(&values, stage.progress()) {
            // Sizes are so far apart that rounding leaves no step: what is there is judged as it is.
            Err(Error::Solve(SolveError::Factorization { .. })) => break,
            done => done?,
        }
        let part = |is_corner: bool, k: usize| {
            let Incidence { facet, corner } = incidences[k];
            if is_corner {
                scale(of_corners[k], mobility[corner].sqrt())
            } else {
                turning[facet].root(of_planes[k])
            }
        };
        if !hubs.solve(&mut cholesky, (&pattern, &values), &mut multipliers, part)? {
            break;
        }
        let mut moves: Vec<Point> = memory::gathered((0..targets.len()).map(pull))?;
        let mut turns: Vec<Point> = memory::gathered(turning.iter().map(fall))?;
        for (k, (i, [multiplier])) in incidences.iter().zip(&multipliers).enumerate() {
            moves[i.corner] = sub(moves[i.corner], scale(of_corners[k], multiplier * mobility[i.corner]));
            let turned = turning[i.facet].inverse.map(|row| dot(row, of_planes[k]));
            turns[i.facet] = sub(turns[i.facet], scale(turned, *multiplier));
        }
        let off = shape.off_planes();
        slack = if off > SLOW * last { (4.0 * slack).min(1.0) } else { (0.1 * slack).max(REGULAR) };
        last = off;
        let farthest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
        let turn = turns.iter().map(|t| t[0].hypot(t[1])).fold(0.0, f64::max);
        let taken = 1.0_f64.min(FARTHEST[0] / farthest).min(FARTHEST[1] / turn);
        if !taken.is_finite() {
            break;
        }
        shape.corners.iter_mut().zip(&moves).for_each(|(c, m)| c.point = add(c.point, scale(*m, taken)));
        for ((facet, plane), turn) in shape.facets.iter_mut().zip(&turning).zip(&turns) {
            facet.plane = plane.turned(facet.plane.normal, scale(*turn, taken));
        }
        if only_flattens && shape.off_planes() < FLATTEST * FLAT {
            break;
        }
    }
    // What is where it was, as exactly as facets are flat, keeps its bits: what touches there still does.
    for corner in shape.corners.iter_mut().filter(|corner| !corner.is_fixed) {
        if distance(corner.point, corner.home) <= FLATTEST * FLAT {
            corner.point = corner.home;
        }
    }
    set_triangles(shape);
    Ok(shape.off_planes())
}

/// Triangles are flat as they are: their planes follow their corners.
fn set_triangles(shape: &mut Shape) {
    let corners = &shape.corners;
    for facet in shape.facets.iter_mut().filter(|facet| facet.is_triangle()) {
        let [a, b, c] = [0, 1, 2].map(|i| corners[facet.loops[0][i] as usize].point);
        let area = area_vector([a, b, c]);
        if norm(area) > 0.0 {
            facet.plane = Plane::through(a, unit(area));
        }
    }
}

/// Pairs have an entry where they share the facet or the corner, unless that is a hub.
fn pattern(
    incidences: &[Incidence],
    at_corners: &[Vec<usize>],
    at_facets: &[Vec<usize>],
    is_hub: &[Vec<bool>; 2],
) -> Result<LowerPattern> {
    let (mut starts, mut rows) = (memory::room(incidences.len() + 1)?, Vec::new());
    starts.push(0);
    for (k, i) in incidences.iter().enumerate() {
        let at_corner: &[usize] = if is_hub[0][i.corner] { &[] } else { &at_corners[i.corner] };
        let of_facet: &[usize] = if is_hub[1][i.facet] { &[] } else { &at_facets[i.facet] };
        let column = at_corner.iter().chain(of_facet).copied().filter(|&row| row > k).chain([k]);
        let mut column: Vec<usize> = memory::sifted(column)?;
        column.sort_unstable();
        column.dedup();
        memory::extend(&mut rows, column.len())?;
        rows.extend(column);
        starts.push(rows.len());
    }
    Ok(LowerPattern { n: incidences.len(), starts, rows })
}

impl Turning {
    fn new(facet: &super::shape::Facet) -> Self {
        let Plane { normal, .. } = facet.plane;
        let [x, y] = axes(normal);
        let (center, spread, area) = (facet.moments.center(), facet.moments.spread(), facet.moments.area);
        let height = facet.plane.height(center);
        let trace = spread[0][0] + spread[1][1] + spread[2][2];
        // On the unit sphere the energy bends by what it is along the normal less.
        let least = quadratic(&spread, normal, normal);
        let damping = DAMPING * trace + f64::MIN_POSITIVE;
        let along = |u: Point| (quadratic(&spread, u, u) - least).max(0.0) + damping;
        let (xx, yy, xy) = (along(x), along(y), quadratic(&spread, x, y));
        let determinant = xx * yy - xy * xy;
        let (ixx, iyy, ixy) = if determinant > damping * damping {
            (yy / determinant, xx / determinant, -xy / determinant)
        } else {
            (1.0 / xx, 1.0 / yy, 0.0)
        };
        let inverse = [[ixx, ixy, 0.0], [ixy, iyy, 0.0], [0.0, 0.0, 1.0 / area.max(f64::MIN_POSITIVE)]];
        let gradient = [quadratic(&spread, normal, x), quadratic(&spread, normal, y), area * height];
        Self { axes: [x, y], center, height, inverse, gradient }
    }

    /// How the height of a point over the plane changes with the unknowns.
    fn derivative(&self, point: Point) -> Point {
        let d = sub(point, self.center);
        [dot(self.axes[0], d), dot(self.axes[1], d), 1.0]
    }

    /// The product with the root of the inverse: the square of its length is `vᵀ M v`.
    fn root(&self, v: Point) -> Point {
        let [[xx, xy, _], [_, yy, _], [_, _, zz]] = self.inverse;
        let first = xx.sqrt();
        let below = xy / first;
        [first * v[0] + below * v[1], (yy - below * below).max(0.0).sqrt() * v[1], zz.sqrt() * v[2]]
    }

    /// The plane after a change of the unknowns.
    fn turned(&self, normal: Point, change: Point) -> Plane {
        let tilt = add(scale(self.axes[0], change[0]), scale(self.axes[1], change[1]));
        let normal = unit(add(normal, tilt));
        Plane { normal, offset: dot(normal, self.center) - self.height - change[2] }
    }
}
