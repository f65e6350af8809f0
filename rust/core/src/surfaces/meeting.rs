//! Where surfaces meet: the point on a curve of two or in a corner of three and more that is nearest to a
//! start.

use super::constants::{MEETING, TANGENT};
use super::Surface;
use crate::linear::small::Quadric;
use crate::mesh::vector::{add, distance, dot, norm, scale, sub, Point};

/// A point on all `surfaces` near `start`, by Newton's method: each step is the shortest to the tangent
/// planes' common points (pseudo-inverse; what nearly tangent surfaces leave open stays as it is). Where no
/// point is on all of them, one that is as near to them as can be. `None` if it would be farther than `reach`
/// from the start.
#[must_use]
pub fn meeting(surfaces: &[&Surface], start: Point, reach: f64) -> Option<Point> {
    if let [surface] = surfaces {
        return Some(surface.project(start)).filter(|&p| distance(p, start) <= reach);
    }
    let mut point = start;
    for _ in 0..MEETING.steps {
        let mut quadric = Quadric::default();
        for surface in surfaces {
            let (distance, normal) = surface.distance(point);
            quadric.add(1.0, normal, -distance);
        }
        let step = quadric.nearest(TANGENT);
        point = add(point, step);
        let moved = distance(point, start);
        if moved.is_nan() || moved > reach {
            return None;
        }
        if norm(step) <= MEETING.rest * (norm(point) + reach) {
            break;
        }
    }
    // Newton drifts along the curve of curved surfaces; the way back along it keeps the nearest point.
    Some(nearest_along(surfaces, start, point)).filter(|&p| distance(p, start) <= reach)
}

/// One correction along the curve of two surfaces toward the start, taken back onto both.
fn nearest_along(surfaces: &[&Surface], start: Point, point: Point) -> Point {
    let [first, second] = surfaces else { return point };
    let ((_, n), (_, m)) = (first.distance(point), second.distance(point));
    let tangent = crate::mesh::vector::unit(crate::mesh::vector::cross(n, m));
    let along = scale(tangent, dot(sub(start, point), tangent));
    let moved = add(point, along);
    let mut quadric = Quadric::default();
    for surface in surfaces {
        let (distance, normal) = surface.distance(moved);
        quadric.add(1.0, normal, -distance);
    }
    let moved = add(moved, quadric.nearest(TANGENT));
    let off = |p: Point| surfaces.iter().map(|s| s.distance(p).0.abs()).fold(0.0, f64::max);
    let is_better = off(moved) <= off(point).max(1e-12 * norm(sub(start, point)));
    if is_better {
        moved
    } else {
        point
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::vector::unit;

    const X: Surface = Surface::Plane { normal: [1.0, 0.0, 0.0], offset: 1.0 };
    const Y: Surface = Surface::Plane { normal: [0.0, 1.0, 0.0], offset: 2.0 };
    const Z: Surface = Surface::Plane { normal: [0.0, 0.0, 1.0], offset: 3.0 };

    #[test]
    fn planes_meet_in_lines_and_corners() {
        let start = [0.8, 2.1, 2.9];
        assert_eq!(meeting(&[&X], start, 1.0).unwrap(), [1.0, 2.1, 2.9]);
        let line = meeting(&[&X, &Y], start, 1.0).unwrap();
        assert!(distance(line, [1.0, 2.0, 2.9]) < 1e-12);
        assert!(distance(meeting(&[&X, &Y, &Z], start, 1.0).unwrap(), [1.0, 2.0, 3.0]) < 1e-12);
        assert!(meeting(&[&X, &Y, &Z], start, 0.1).is_none());
    }

    #[test]
    fn nearly_parallel_planes_do_not_send_points_away() {
        let tilted = Surface::Plane { normal: unit([1.0, 0.01, 0.0]), offset: 1.0 };
        let start = [1.1, 50.0, 0.0];
        let met = meeting(&[&X, &tilted], start, 10.0).unwrap();
        assert!(distance(met, start) < 1.0);
    }

    #[test]
    fn curved_surfaces_meet_in_circles_and_points() {
        let cylinder = Surface::Cylinder { point: [0.0; 3], axis: [0.0, 0.0, 1.0], radius: 2.0 };
        let circle = meeting(&[&cylinder, &Z], [2.2, 0.1, 2.9], 1.0).unwrap();
        assert!(cylinder.distance(circle).0.abs() < 1e-12 && Z.distance(circle).0.abs() < 1e-12);
        let sphere = Surface::Sphere { center: [0.0; 3], radius: 3.5 };
        let corner = meeting(&[&cylinder, &sphere, &X], [1.05, 1.7, 2.8], 1.0).unwrap();
        for surface in [cylinder, sphere, X] {
            assert!(surface.distance(corner).0.abs() < 1e-12);
        }
    }
}
