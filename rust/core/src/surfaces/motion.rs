//! How a surface moves and changes its radii: the parameters of the fit,
//! and the derivatives of the distance by them.

use super::{beside, Surface};
use crate::mesh::vector::{add, cross, dot, norm, scale, unit, Point};

/// Three of shifting, three of turning about the origin of the samples, two of shape.
pub(super) const COUNT: usize = 8;

impl Surface {
    /// The signed distance of `p`, and its derivatives by shift, turn, and the radii and angles of the
    /// surface in the order in which they are declared; zero for those that it does not have.
    pub(super) fn derivatives(&self, p: Point) -> (f64, [f64; COUNT]) {
        let (distance, normal) = self.distance(p);
        let turn = cross(normal, p);
        let shape = match *self {
            Self::Plane { .. } => [0.0; 2],
            Self::Sphere { .. } | Self::Cylinder { .. } => [-1.0, 0.0],
            Self::Cone { point, axis, radius, slope } => {
                let (height, rho, _) = beside(p, point, axis);
                let (sine, cosine) = slope.sin_cos();
                [-cosine, -(rho - radius) * sine - height * cosine]
            }
            Self::Torus { center, axis, major, .. } => {
                let (height, rho, _) = beside(p, center, axis);
                let length = (rho - major).hypot(height);
                [if length > 0.0 { -(rho - major) / length } else { -1.0 }, -1.0]
            }
        };
        let [x, y, z] = normal;
        (distance, [-x, -y, -z, turn[0], turn[1], turn[2], shape[0], shape[1]])
    }

    /// The surface after that `step`.
    pub(super) fn moved(&self, step: &[f64; COUNT]) -> Self {
        let (shift, turn) = ([step[0], step[1], step[2]], [step[3], step[4], step[5]]);
        let turned = |p: Point| rotated(p, turn);
        let placed = |p: Point| add(turned(p), shift);
        match *self {
            Self::Plane { normal, offset } => {
                let normal = unit(turned(normal));
                Self::Plane { normal, offset: offset + dot(normal, shift) }
            }
            Self::Sphere { center, radius } => {
                Self::Sphere { center: placed(center), radius: (radius + step[6]).abs() }
            }
            Self::Cylinder { point, axis, radius } => {
                let (axis, point) = (unit(turned(axis)), placed(point));
                // The point of the axis next to the samples.
                let point = add(point, scale(axis, -dot(point, axis)));
                Self::Cylinder { point, axis, radius: (radius + step[6]).abs() }
            }
            Self::Cone { point, axis, radius, slope } => Self::Cone {
                point: placed(point),
                axis: unit(turned(axis)),
                radius: radius + step[6],
                slope: slope + step[7],
            },
            Self::Torus { center, axis, major, minor } => Self::Torus {
                center: placed(center),
                axis: unit(turned(axis)),
                major: (major + step[6]).abs(),
                minor: (minor + step[7]).abs(),
            },
        }
    }
}

/// `p` turned about the origin by a vector along the axis, as long as the angle (Rodrigues).
fn rotated(p: Point, turn: Point) -> Point {
    let angle = norm(turn);
    if angle == 0.0 {
        return p;
    }
    let axis = scale(turn, 1.0 / angle);
    let (sine, cosine) = angle.sin_cos();
    add(add(scale(p, cosine), scale(cross(axis, p), sine)), scale(axis, (1.0 - cosine) * dot(axis, p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_moving() {
        let axis = unit([0.2, -0.5, 1.0]);
        let surfaces = [
            Surface::Plane { normal: axis, offset: 0.3 },
            Surface::Sphere { center: [0.1, 0.2, 0.3], radius: 1.5 },
            Surface::Cylinder { point: [0.1, 0.2, 0.3], axis, radius: 0.5 },
            Surface::Cone { point: [0.1, 0.2, 0.3], axis, radius: 0.5, slope: 0.4 },
            Surface::Torus { center: [0.1, 0.2, 0.3], axis, major: 2.0, minor: 0.4 },
        ];
        let p = [0.7, -0.4, 1.1];
        for surface in surfaces {
            let (distance, derivatives) = surface.derivatives(p);
            for (k, expected) in derivatives.into_iter().enumerate() {
                let mut step = [0.0; COUNT];
                step[k] = 1e-6;
                let found = (surface.moved(&step).distance(p).0 - distance) / 1e-6;
                assert!((found - expected).abs() < 1e-5, "{surface:?} {k}: {found} {expected}");
            }
        }
    }
}
