//! What speaks for a surface: coincidences beyond those that determine it, and how clearly it ends.
//!
//! The rows of a turned surface count once, however many vertices they have: two circles about one axis lie
//! on a sphere, a cone, and many tori, and a third on a torus still.

use super::super::constants::{
    CLEAR_STOP, LEAST_EVIDENCE, MOST_BEND_ALONG_A_ROW, MOST_BEND_ON_A_SURFACE, ROW_GAP, TANGENT_RISE,
};
use super::facets::{Link, Marks, Shape};
use super::grow::Grown;
use super::starts::beside;
use crate::mesh::vector::{between, cross, dot, norm, sub, Point};
use crate::surfaces::{perpendicular, Surface as Named};
use crate::{memory, Result};

/// A circle of vertices, or a line of them, by what they have in common.
type Key = fn(&Named, Point) -> f64;

impl Shape<'_> {
    /// How many vertices lie on it, and whether they are clearly more than chance, and it ends clearly.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn held(&self, marks: &mut Marks, grown: &Grown) -> Result<Option<usize>> {
        if grown.facets.len() < 2 {
            return Ok(None);
        }
        let vertices = self.vertices_of(&grown.facets)?;
        marks.begin();
        for &f in &grown.facets {
            marks.mark(f);
        }
        let is_shown =
            self.evidence(marks, grown, &vertices)? >= LEAST_EVIDENCE && self.stops(marks, grown)?;
        Ok(is_shown.then_some(vertices.len()))
    }

    fn evidence(&self, marks: &Marks, grown: &Grown, vertices: &[u32]) -> Result<i64> {
        let surface = &grown.surface;
        let n = vertices.len() as i64;
        let points = self.points(vertices)?;
        let count = |key: Key| clusters(points.iter().map(|&p| key(surface, p)));
        Ok(match surface {
            Named::Plane { .. } => 0,
            Named::Sphere { .. } => {
                let is_inside = |v: &&u32| self.at(**v).iter().all(|&f| marks.is_marked(f));
                (vertices.iter().filter(is_inside).count() as i64).min(n - 10)
            }
            Named::Cylinder { .. } => {
                let lines = count(azimuth)?;
                // Triangles without a pattern: smooth strips are nearly on cylinders.
                let own = if 4 * lines > 3 * n { (n - 7) / 4 } else { (lines - 3).min(n - 7) };
                own + self.tangent_sides(marks, grown, azimuth)?
            }
            Named::Torus { .. } if count(azimuth)? < 3 => 0,
            Named::Torus { .. } => {
                (count(latitude)? - 3).min(n - 9) + self.tangent_sides(marks, grown, latitude)?
            }
            Named::Cone { .. } => {
                let (lines, rows) = (count(azimuth)?, count(latitude)?);
                if rows > 4 && 2 * rows > lines {
                    return Ok((n - 8) / 4);
                }
                // A row of any turned surface lies on a cone: one that goes on smoothly says nothing.
                let goes_on = |link: &Link| {
                    let [a, b] = link.ends.map(|v| latitude(surface, self.positions[v as usize]));
                    link.bend < MOST_BEND_ALONG_A_ROW && (a - b).abs() < ROW_GAP
                };
                if self.border(marks, grown).any(goes_on) {
                    return Ok(0);
                }
                (lines - 3).min(n - 8) + self.tangent_sides(marks, grown, azimuth)?
            }
        })
    }

    /// The edges between the marked facets of a surface and others.
    fn border<'a>(&'a self, marks: &'a Marks, grown: &'a Grown) -> impl Iterator<Item = &'a Link> + 'a {
        let links = grown.facets.iter().flat_map(|&f| self.links(f));
        links.filter(|link| !marks.is_marked(link.facet))
    }

    /// On how many sides, two at most, where `key` is the same along the border, a tangent goes on.
    fn tangent_sides(&self, marks: &Marks, grown: &Grown, key: Key) -> Result<i64> {
        let surface = &grown.surface;
        let sides = self.border(marks, grown).filter_map(|link| {
            let [a, b] = link.ends.map(|v| self.positions[v as usize]);
            let is_along = (key(surface, a) - key(surface, b)).abs() < ROW_GAP;
            (is_along && self.is_tangent(link, surface)).then(|| key(surface, between(a, b, 0.5)))
        });
        Ok(match memory::sifted(sides)? {
            sides if sides.is_empty() => 0,
            sides => clusters(sides.into_iter())?.min(2),
        })
    }

    /// Whether the facet across leaves the edge in the tangent plane of a surface.
    pub(super) fn is_tangent(&self, link: &Link, surface: &Named) -> bool {
        link.ends.iter().all(|&v| {
            self.links(link.facet).iter().any(|edge| {
                let other = match edge.ends {
                    [a, b] if a == v => b,
                    [a, b] if b == v => a,
                    _ => return false,
                };
                !link.ends.contains(&other) && self.touches(v, other, surface, TANGENT_RISE)
            })
        })
    }

    /// Whether what goes on smoothly beside it is clearly off, for the most part: a smooth surface leaves
    /// another one by and by.
    fn stops(&self, marks: &Marks, grown: &Grown) -> Result<bool> {
        let smooth = self.border(marks, grown).filter(|link| link.bend < MOST_BEND_ON_A_SURFACE);
        let off = smooth.map(|link| {
            self.vertices(link.facet).iter().map(|&v| self.off(v, &grown.surface)).fold(0.0, f64::max)
        });
        let mut off: Vec<f64> = memory::sifted(off)?;
        let middle = off.len() / 2;
        if off.is_empty() {
            return Ok(true);
        }
        Ok(*off.select_nth_unstable_by(middle, f64::total_cmp).1 > CLEAR_STOP * self.rounding)
    }
}

/// The angle about the axis.
fn azimuth(surface: &Named, p: Point) -> f64 {
    let (point, axis) = match *surface {
        Named::Cylinder { point, axis, .. } | Named::Cone { point, axis, .. } => (point, axis),
        Named::Torus { center, axis, .. } => (center, axis),
        Named::Plane { .. } | Named::Sphere { .. } => return 0.0,
    };
    let first = perpendicular(axis);
    let d = sub(p, point);
    dot(d, cross(axis, first)).atan2(dot(d, first))
}

/// The angle in the tube of a torus; the height on a cone, as a part of the distance from its apex.
fn latitude(surface: &Named, p: Point) -> f64 {
    match *surface {
        Named::Torus { center, axis, major, .. } => {
            let (height, rho) = beside(p, center, axis);
            height.atan2(rho - major)
        }
        Named::Cone { point, axis, .. } => {
            let apex = surface.apex().unwrap_or(point);
            (dot(sub(p, apex), axis) / norm(sub(point, apex)).max(f64::MIN_POSITIVE))
                .min(std::f64::consts::PI)
        }
        _ => 0.0,
    }
}

/// How many different angles there are.
fn clusters(angles: impl Iterator<Item = f64>) -> Result<i64> {
    let mut angles: Vec<f64> = memory::sifted(angles)?;
    angles.sort_unstable_by(f64::total_cmp);
    let gaps = angles.windows(2).filter(|pair| pair[1] - pair[0] > ROW_GAP).count() as i64;
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return Ok(0) };
    let is_closed = gaps > 0 && first + std::f64::consts::TAU - last <= ROW_GAP;
    Ok(gaps + 1 - i64::from(is_closed))
}
