//! Surfaces to begin with, from a few facets each.

use super::super::constants::{ALIKE_BENDS, FACETS_OF_A_START, MOST_BEND_ON_A_SURFACE};
use super::facets::{Link, Shape};
use crate::linear::small::{least_eigen3, scatter, solved, symmetric_eigen};
use crate::mesh::vector::{add, cross, distance, dot, norm, scale, sub, unit, Point};
use crate::surfaces::{perpendicular, Kind, Surface as Named};
use crate::Result;

/// Facets, and the surface that they may lie on.
pub(super) type Start = (Vec<u32>, Named);

impl Shape<'_> {
    /// The start of a `kind` at an edge of facet `f`: a sphere around a vertex, a torus around an edge, a
    /// cylinder with its axis along the edge.
    pub(super) fn start_at(&self, kind: Kind, f: u32, link: &Link) -> Result<Option<Start>> {
        let (seed, surface) = match kind {
            Kind::Sphere => {
                let seed = self.fan(f, link.ends[0]);
                let surface = if seed.len() < 3 { None } else { sphere(&self.points_of(&seed)?) };
                (seed, surface)
            }
            Kind::Torus => {
                let seed = self.beside_edge(f, link);
                let surface = if seed.len() < 4 { None } else { self.torus(&seed)? };
                (seed, surface)
            }
            _ => {
                let [from, to] = link.ends.map(|v| self.positions[v as usize]);
                let seed = vec![f, link.facet];
                let surface = cylinder(&self.points_of(&seed)?, unit(sub(to, from)));
                (seed, surface)
            }
        };
        Ok(surface.map(|surface| (seed, surface)))
    }

    /// The facets around vertex `v` of facet `f`, none where one of them is across a ridge.
    fn fan(&self, f: u32, v: u32) -> Vec<u32> {
        let mut fan = vec![f];
        for &g in self.at(v).iter().filter(|&&g| g != f) {
            if self.turn(f, g) > 2.0 * MOST_BEND_ON_A_SURFACE {
                return Vec::new();
            }
            fan.push(g);
        }
        fan
    }

    /// The facets at both ends of an edge of facet `f`.
    fn beside_edge(&self, f: u32, link: &Link) -> Vec<u32> {
        let mut beside = vec![f];
        for &g in link.ends.iter().flat_map(|&v| self.at(v)) {
            if !beside.contains(&g) && self.turn(f, g) < 2.0 * MOST_BEND_ON_A_SURFACE {
                beside.push(g);
            }
        }
        beside
    }

    /// Facets in a row with `f` and the one across `link` that turn alike, as the strips of a cone do.
    pub(super) fn row(&self, f: u32, link: &Link) -> Vec<u32> {
        let mut row = vec![f, link.facet];
        for end in [f, link.facet] {
            let mut last = end;
            for _ in 0..2 {
                let off = |other: &Link| (other.bend - link.bend).abs();
                let alike = self.links(last).iter().filter(|other| off(other) < ALIKE_BENDS * link.bend);
                let next = alike.filter(|other| !row.contains(&other.facet));
                let Some(next) = next.min_by(|a, b| off(a).total_cmp(&off(b))) else { break };
                row.push(next.facet);
                last = next.facet;
            }
        }
        row
    }

    /// So many facets nearest to `f` across edges.
    pub(super) fn nearest(&self, f: u32, most: usize) -> Vec<u32> {
        let mut found = vec![f];
        let mut next = 0;
        while next < found.len() && found.len() < most {
            for link in self.links(found[next]) {
                let is_new = link.bend < MOST_BEND_ON_A_SURFACE && !found.contains(&link.facet);
                if is_new && found.len() < most {
                    found.push(link.facet);
                }
            }
            next += 1;
        }
        found
    }

    fn turn(&self, f: u32, g: u32) -> f64 {
        distance(self.normals[f as usize], self.normals[g as usize])
    }

    /// The torus about the axis that the normals of the facets meet: those of the planar trapezoids of a
    /// turned surface do so exactly.
    fn torus(&self, seed: &[u32]) -> Result<Option<Named>> {
        let points = self.points_of(seed)?;
        let (middle, size) = extent(&points);
        let mut matrix = vec![vec![0.0; 6]; 6];
        for &f in seed {
            let normal = self.normals[f as usize];
            let moment = cross(scale(sub(self.centers[f as usize], middle), 1.0 / size), normal);
            let row = [moment[0], moment[1], moment[2], normal[0], normal[1], normal[2]];
            for i in 0..6 {
                (0..6).for_each(|j| matrix[i][j] += row[i] * row[j]);
            }
        }
        let (_, vectors) = symmetric_eigen(matrix);
        let (along, moment) = {
            let v = &vectors[0];
            ([v[0], v[1], v[2]], [v[3], v[4], v[5]])
        };
        let length = norm(along);
        if length < FLAT_COMPLEX {
            return Ok(None);
        }
        let axis = scale(along, 1.0 / length);
        let point = add(scale(cross(along, moment), size / (length * length)), middle);
        let profile = points.iter().map(|&p| {
            let (height, rho) = beside(p, point, axis);
            [rho, height]
        });
        Ok(circle(&profile.collect::<Vec<_>>()).filter(|found| found[0] > 0.0).map(
            |[major, height, minor]| {
                let center = add(point, scale(axis, height));
                Named::Torus { center, axis, major, minor }
            },
        ))
    }

    /// The cylinder or cone whose facets `seed` are, by their normals.
    pub(super) fn start_of(&self, kind: Kind, seed: &[u32]) -> Result<Option<Named>> {
        if seed.len() < FACETS_OF_A_START[0] {
            return Ok(None);
        }
        let points = self.points_of(seed)?;
        if points.len() < kind.n_parameters() {
            return Ok(None);
        }
        let normals = || seed.iter().map(|&f| self.normals[f as usize]);
        let sum = normals().fold([0.0; 3], add);
        // Normals of a cylinder are across its axis, those of a cone on a circle about it.
        let mean = if kind == Kind::Cone { scale(sum, 1.0 / seed.len() as f64) } else { [0.0; 3] };
        let (_, axis) = least_eigen3(scatter(normals().map(|n| (sub(n, mean), 1.0))));
        if kind == Kind::Cylinder {
            return Ok(cylinder(&points, axis));
        }
        // The planes of its facets meet in its apex.
        let (middle, _) = extent(&points);
        let (mut matrix, mut right) = (vec![vec![0.0; 3]; 3], [0.0; 3]);
        for (&f, n) in seed.iter().zip(normals()) {
            let offset = dot(n, sub(self.centers[f as usize], middle));
            for i in 0..3 {
                right[i] += offset * n[i];
                (0..3).for_each(|j| matrix[i][j] += n[i] * n[j]);
            }
        }
        let found = solved(matrix, &right, f64::EPSILON, 0.0);
        let apex = add(middle, [found[0], found[1], found[2]]);
        let height = dot(sub(middle, apex), axis);
        let axis = scale(axis, height.signum());
        let ratios = points.iter().map(|&p| {
            let (height, rho) = beside(p, apex, axis);
            rho / height
        });
        let ratio = ratios.sum::<f64>() / points.len() as f64;
        let point = add(apex, scale(axis, height.abs()));
        Ok(Some(Named::Cone { point, axis, radius: ratio * height.abs(), slope: ratio.atan() }))
    }
}

/// The normals of a plane meet no axis: it is at infinity.
const FLAT_COMPLEX: f64 = 1e-6;

/// The height of `p` along an axis through `point`, and how far it is from that.
pub(super) fn beside(p: Point, point: Point, axis: Point) -> (f64, f64) {
    let d = sub(p, point);
    let height = dot(d, axis);
    (height, norm(sub(d, scale(axis, height))))
}

/// The mean of points, and how far they are from it.
fn extent(points: &[Point]) -> (Point, f64) {
    let middle = scale(points.iter().fold([0.0; 3], |sum, &p| add(sum, p)), 1.0 / points.len() as f64);
    (middle, points.iter().map(|&p| distance(p, middle)).fold(f64::MIN_POSITIVE, f64::max))
}

/// The sphere through points, `|p|² = 2 c · p + k`.
fn sphere(points: &[Point]) -> Option<Named> {
    let (middle, size) = extent(points);
    let (mut matrix, mut right) = (vec![vec![0.0; 4]; 4], [0.0; 4]);
    for &p in points {
        let q = scale(sub(p, middle), 1.0 / size);
        let row = [2.0 * q[0], 2.0 * q[1], 2.0 * q[2], 1.0];
        for i in 0..4 {
            right[i] += row[i] * dot(q, q);
            (0..4).for_each(|j| matrix[i][j] += row[i] * row[j]);
        }
    }
    let x = solved(matrix, &right, 1e-12, 0.0);
    let center = [x[0], x[1], x[2]];
    let square = x[3] + dot(center, center);
    (square > 0.0)
        .then(|| Named::Sphere { center: add(scale(center, size), middle), radius: square.sqrt() * size })
}

/// The cylinder through points with that axis.
fn cylinder(points: &[Point], axis: Point) -> Option<Named> {
    let (middle, _) = extent(points);
    let first = perpendicular(axis);
    let second = cross(axis, first);
    let flat: Vec<[f64; 2]> = points
        .iter()
        .map(|&p| {
            let d = sub(p, middle);
            [dot(d, first), dot(d, second)]
        })
        .collect();
    let [x, y, radius] = circle(&flat)?;
    Some(Named::Cylinder { point: add(middle, add(scale(first, x), scale(second, y))), axis, radius })
}

/// The circle through points in a plane: center and radius.
fn circle(points: &[[f64; 2]]) -> Option<[f64; 3]> {
    let lifted: Vec<Point> = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let (middle, size) = extent(&lifted);
    let (mut matrix, mut right) = (vec![vec![0.0; 3]; 3], [0.0; 3]);
    for &p in &lifted {
        let q = scale(sub(p, middle), 1.0 / size);
        let row = [2.0 * q[0], 2.0 * q[1], 1.0];
        for i in 0..3 {
            right[i] += row[i] * dot(q, q);
            (0..3).for_each(|j| matrix[i][j] += row[i] * row[j]);
        }
    }
    let x = solved(matrix, &right, 1e-12, 0.0);
    let square = x[2] + x[0] * x[0] + x[1] * x[1];
    (square > 0.0).then(|| [x[0] * size + middle[0], x[1] * size + middle[1], square.sqrt() * size])
}
