//! Where two surfaces meet, seen from a point near by.

use super::constants::ALONG;
use crate::linear::small::symmetric_eigen;
use crate::mesh::vector::{add, cross, dot, norm, scale, sub, unit, Point};
use crate::surfaces::{perpendicular, Surface, TANGENT};

/// How far `p` is from where two surfaces meet, about: from their contact where they touch, which is where
/// their normals agree, or else from their intersection. `out` points outside, `step` is the length over
/// which normals are compared, `reach` how far off contacts are looked for, and what is apart by less than
/// `sigma` touches.
///
/// Beside a contact surfaces part by the square of the distance, which noise hides over some edges; their
/// normals part in proportion to it.
pub(super) fn offset(
    surfaces: [&Surface; 2],
    p: Point,
    out: Point,
    step: f64,
    reach: f64,
    sigma: f64,
) -> f64 {
    let gap = |q: Point| {
        let [a, b] = surfaces.map(|surface| {
            let (distance, normal) = surface.distance(q);
            let side = if dot(normal, out) < 0.0 { -1.0 } else { 1.0 };
            (side * distance, scale(normal, side))
        });
        (a.0 - b.0, sub(a.1, b.1))
    };
    let (apart, turn) = gap(p);
    let intersection = apart.abs() / norm(turn).max(f64::MIN_POSITIVE);
    let normal = unit(out);
    if norm(normal) == 0.0 {
        return intersection;
    }
    let first = perpendicular(normal);
    let across = [first, cross(normal, first)];
    // How the difference of the normals changes along the surfaces.
    let slopes = across.map(|along| {
        let [q, r] = [step, -step].map(|s| gap(add(p, scale(along, s))).1);
        scale(sub(q, r), 0.5 / step)
    });
    let matrix = slopes.map(|u| slopes.map(|v| dot(u, v)).to_vec()).to_vec();
    let (values, vectors) = symmetric_eigen(matrix);
    if values[1].sqrt() * reach <= norm(turn) {
        return intersection;
    }
    let right = slopes.map(|slope| -dot(slope, turn));
    let mut there = p;
    for (value, vector) in values.iter().zip(&vectors) {
        // Along the contact the difference stays.
        if *value >= ALONG * values[1] {
            let share = (vector[0] * right[0] + vector[1] * right[1]) / value;
            (0..2).for_each(|k| there = add(there, scale(across[k], share * vector[k])));
        }
    }
    let contact = norm(sub(there, p));
    let (apart, turn) = gap(there);
    let touches = contact < reach && apart.abs() < sigma && dot(turn, turn) < 4.0 * TANGENT;
    if touches {
        contact
    } else {
        intersection
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fillet_touches_its_plane_along_a_line_and_two_planes_meet_in_one() {
        let plane = Surface::Plane { normal: [0.0, 0.0, 1.0], offset: 1.0 };
        let fillet = Surface::Cylinder { point: [0.0; 3], axis: [0.0, 1.0, 0.0], radius: 1.0 };
        for x in [-0.1, 0.0, 0.05] {
            let found = offset([&plane, &fillet], [x, 0.3, 1.0], [0.0, 0.0, 1.0], 0.05, 0.4, 0.01);
            assert!((found - x.abs()).abs() < 0.01, "{x}: {found}");
        }
        let other = Surface::Plane { normal: [1.0, 0.0, 0.0], offset: 0.5 };
        let found = offset([&plane, &other], [0.3, 0.0, 1.0], unit([1.0, 0.0, 1.0]), 0.05, 0.4, 0.01);
        assert!((found - 0.2 / 2.0_f64.sqrt()).abs() < 1e-9, "{found}");
    }
}
