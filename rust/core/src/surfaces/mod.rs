//! Surfaces by name: plane, sphere, cylinder, cone, torus. Their distances, normals and projections
//! ([`Surface`]), their fits to points with noise ([`fit`]), and the curves and corners where several of them
//! meet ([`meeting`]).

mod constants;
mod fit;
mod meeting;
mod motion;
mod samples;
mod starts;
mod through;

pub use constants::{MOST_MISFIT, TANGENT};
pub use fit::{fit, refit, FittedSurface};
pub use meeting::meeting;
pub use samples::{misfit, Samples};
pub use through::through;

use crate::mesh::vector::{add, cross, dot, norm, scale, sub, unit, Point};

/// The kinds of surfaces, simplest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// A plane.
    Plane,
    /// A sphere.
    Sphere,
    /// A circular cylinder.
    Cylinder,
    /// A circular cone.
    Cone,
    /// A torus.
    Torus,
}

impl Kind {
    /// All of them, simplest first.
    pub const ALL: [Self; 5] = [Self::Plane, Self::Sphere, Self::Cylinder, Self::Cone, Self::Torus];

    /// How many numbers such a surface is known by.
    #[must_use]
    pub fn n_parameters(self) -> usize {
        match self {
            Self::Plane => 3,
            Self::Sphere => 4,
            Self::Cylinder => 5,
            Self::Cone => 6,
            Self::Torus => 7,
        }
    }

    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Sphere => "sphere",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Torus => "torus",
        }
    }
}

/// A surface that goes on without end. All vectors have length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// The points `p` with `p · normal = offset`.
    Plane {
        /// Its normal.
        normal: Point,
        /// How far it is from the origin along that.
        offset: f64,
    },
    /// A sphere.
    Sphere {
        /// Its center.
        center: Point,
        /// Its radius.
        radius: f64,
    },
    /// A cylinder.
    Cylinder {
        /// A point on its axis.
        point: Point,
        /// The direction of its axis.
        axis: Point,
        /// Its radius.
        radius: f64,
    },
    /// A cone, of which a cylinder is the case without slope.
    Cone {
        /// A point on its axis.
        point: Point,
        /// The direction of its axis, in which it widens where the slope is positive.
        axis: Point,
        /// Its radius at that point.
        radius: f64,
        /// The angle between axis and surface, radians: half of the opening.
        slope: f64,
    },
    /// A torus.
    Torus {
        /// Its center.
        center: Point,
        /// The direction of its axis.
        axis: Point,
        /// The radius of the circle in its tube.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
}

/// A point beside an axis: the height along it, the distance from it, and the direction away from it.
fn beside(p: Point, point: Point, axis: Point) -> (f64, f64, Point) {
    let d = sub(p, point);
    let height = dot(d, axis);
    let across = sub(d, scale(axis, height));
    let radius = norm(across);
    // On the axis all directions are as good.
    let away = if radius > 0.0 { scale(across, 1.0 / radius) } else { perpendicular(axis) };
    (height, radius, away)
}

/// A unit vector perpendicular to a unit vector.
pub(crate) fn perpendicular(axis: Point) -> Point {
    let least = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    unit(cross(axis, other))
}

impl Surface {
    /// What kind it is.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Plane { .. } => Kind::Plane,
            Self::Sphere { .. } => Kind::Sphere,
            Self::Cylinder { .. } => Kind::Cylinder,
            Self::Cone { .. } => Kind::Cone,
            Self::Torus { .. } => Kind::Torus,
        }
    }

    /// The smallest radius that it is bent by anywhere: infinite for planes, 0 for cones.
    #[must_use]
    pub fn least_radius(&self) -> f64 {
        match *self {
            Self::Plane { .. } => f64::INFINITY,
            Self::Sphere { radius, .. } | Self::Cylinder { radius, .. } => radius,
            Self::Cone { .. } => 0.0,
            Self::Torus { major, minor, .. } => minor.min((major - minor).max(0.0)),
        }
    }

    /// The signed distance of `p`, and the direction in which it grows, of length 1: the normal of the
    /// surface in the nearest point. Positive outside, for planes on the side of the normal.
    #[must_use]
    pub fn distance(&self, p: Point) -> (f64, Point) {
        match *self {
            Self::Plane { normal, offset } => (dot(p, normal) - offset, normal),
            Self::Sphere { center, radius } => {
                let d = sub(p, center);
                let length = norm(d);
                let away = if length > 0.0 { scale(d, 1.0 / length) } else { [0.0, 0.0, 1.0] };
                (length - radius, away)
            }
            Self::Cylinder { point, axis, radius } => {
                let (_, rho, away) = beside(p, point, axis);
                (rho - radius, away)
            }
            Self::Cone { point, axis, radius, slope } => {
                let (height, rho, away) = beside(p, point, axis);
                let (sine, cosine) = slope.sin_cos();
                ((rho - radius) * cosine - height * sine, sub(scale(away, cosine), scale(axis, sine)))
            }
            Self::Torus { center, axis, major, minor } => {
                let (height, rho, away) = beside(p, center, axis);
                let in_tube = [rho - major, height];
                let length = in_tube[0].hypot(in_tube[1]);
                if length > 0.0 {
                    let normal = add(scale(away, in_tube[0] / length), scale(axis, in_tube[1] / length));
                    (length - minor, normal)
                } else {
                    (-minor, away)
                }
            }
        }
    }

    /// The nearest point on the surface.
    #[must_use]
    pub fn project(&self, p: Point) -> Point {
        let (distance, normal) = self.distance(p);
        sub(p, scale(normal, distance))
    }

    /// The direction of its normal or its axis; none of a sphere.
    #[must_use]
    pub fn direction(&self) -> Option<Point> {
        match *self {
            Self::Plane { normal, .. } => Some(normal),
            Self::Sphere { .. } => None,
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } | Self::Torus { axis, .. } => Some(axis),
        }
    }

    /// The tip of a cone; `None` of other kinds, and of a cone with parallel sides.
    #[must_use]
    pub fn apex(&self) -> Option<Point> {
        match *self {
            Self::Cone { point, axis, radius, slope } if slope != 0.0 => {
                Some(sub(point, scale(axis, radius / slope.tan())))
            }
            _ => None,
        }
    }

    /// The surface with all points mapped by `p ↦ size · p + shift`.
    #[must_use]
    pub fn placed(&self, size: f64, shift: Point) -> Self {
        let place = |p: Point| add(scale(p, size), shift);
        match *self {
            Self::Plane { normal, offset } => {
                Self::Plane { normal, offset: size * offset + dot(normal, shift) }
            }
            Self::Sphere { center, radius } => Self::Sphere { center: place(center), radius: size * radius },
            Self::Cylinder { point, axis, radius } => {
                Self::Cylinder { point: place(point), axis, radius: size * radius }
            }
            Self::Cone { point, axis, radius, slope } => {
                Self::Cone { point: place(point), axis, radius: size * radius, slope }
            }
            Self::Torus { center, axis, major, minor } => {
                Self::Torus { center: place(center), axis, major: size * major, minor: size * minor }
            }
        }
    }

    /// Whether all its numbers are numbers.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let (distance, normal) = self.distance([0.5, -0.25, 0.125]);
        distance.is_finite() && normal.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Surface; 5] {
        let axis = unit([1.0, 2.0, -0.5]);
        [
            Surface::Plane { normal: axis, offset: 0.7 },
            Surface::Sphere { center: [0.1, 0.2, 0.3], radius: 1.5 },
            Surface::Cylinder { point: [0.1, 0.2, 0.3], axis, radius: 0.5 },
            Surface::Cone { point: [0.1, 0.2, 0.3], axis, radius: 0.5, slope: 0.4 },
            Surface::Torus { center: [0.1, 0.2, 0.3], axis, major: 2.0, minor: 0.4 },
        ]
    }

    #[test]
    fn projected_points_lie_on_the_surface_and_the_normal_is_the_gradient() {
        for surface in all() {
            for p in [[1.0, 0.5, 0.25], [-0.3, 2.0, 1.0], [0.2, -0.4, -2.0]] {
                let (distance, normal) = surface.distance(p);
                assert!((norm(normal) - 1.0).abs() < 1e-12);
                assert!(surface.distance(surface.project(p)).0.abs() < 1e-12, "{surface:?}");
                for c in 0..3 {
                    let mut q = p;
                    q[c] += 1e-6;
                    assert!(
                        ((surface.distance(q).0 - distance) / 1e-6 - normal[c]).abs() < 1e-4,
                        "{surface:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn placed_surfaces_have_placed_points() {
        let shift = [3.0, -1.0, 2.0];
        for surface in all() {
            let p = [0.4, 0.9, -0.2];
            let placed = surface.placed(2.0, shift);
            assert!(
                (placed.distance(add(scale(p, 2.0), shift)).0 - 2.0 * surface.distance(p).0).abs() < 1e-12
            );
        }
        let tip = all()[3].apex().unwrap_or_default();
        assert!(all()[3].distance(tip).0.abs() < 1e-12);
    }
}
