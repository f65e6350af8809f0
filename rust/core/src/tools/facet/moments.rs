//! The plane of a set of faces, by integrals over them.

use super::constants::TURN;
use crate::linear::small::least_eigen3;
use crate::mesh::vector::{add, area_vector, dot, norm, scale, unit, Point};

/// The points with `normal · x = offset`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Plane {
    /// Of length 1.
    pub normal: Point,
    pub offset: f64,
}

impl Plane {
    /// The plane through a point.
    pub(super) fn through(point: Point, normal: Point) -> Self {
        Self { normal, offset: dot(normal, point) }
    }

    /// How far a point is above.
    pub(super) fn height(&self, point: Point) -> f64 {
        dot(self.normal, point) - self.offset
    }
}

/// The best plane of faces, and how well it fits.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneFit {
    pub plane: Plane,
    /// The integral of the squared distance.
    pub squared_distance: f64,
    /// The same with what turned faces cost ([`TURN`]).
    pub energy: f64,
}

/// Integrals over faces: of 1, of places, of products of places, of normals.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Moments {
    pub area: f64,
    first: Point,
    second: [Point; 3],
    vector: Point,
}

impl Moments {
    pub(super) fn of(corners: [Point; 3]) -> Self {
        let vector = area_vector(corners);
        let area = norm(vector);
        let sum = corners.into_iter().fold([0.0; 3], add);
        let product = |i: usize, j: usize| corners.iter().map(|c| c[i] * c[j]).sum::<f64>() + sum[i] * sum[j];
        let second = [0, 1, 2].map(|i| [0, 1, 2].map(|j| area / 12.0 * product(i, j)));
        Self { area, first: scale(sum, area / 3.0), second, vector }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            area: self.area + other.area,
            first: add(self.first, other.first),
            second: [0, 1, 2].map(|i| add(self.second[i], other.second[i])),
            vector: add(self.vector, other.vector),
        }
    }

    /// Those of the same faces, moved.
    pub(super) fn moved(&self, by: Point) -> Self {
        let outer =
            |i: usize, j: usize| self.first[i] * by[j] + by[i] * self.first[j] + self.area * by[i] * by[j];
        Self {
            first: add(self.first, scale(by, self.area)),
            second: [0, 1, 2].map(|i| add(self.second[i], [0, 1, 2].map(|j| outer(i, j)))),
            ..*self
        }
    }

    /// Whether the faces look to the side of `normal`, in the mean.
    pub(super) fn faces(&self, normal: Point) -> bool {
        dot(self.vector, normal) >= 0.0
    }

    pub(super) fn center(&self) -> Point {
        scale(self.first, 1.0 / self.area.max(f64::MIN_POSITIVE))
    }

    /// `∫ (x − c)(x − c)ᵀ` about the center `c`.
    pub(super) fn spread(&self) -> [Point; 3] {
        let c = self.center();
        [0, 1, 2].map(|i| add(self.second[i], scale(self.first, -c[i])))
    }

    /// The integral of the squared distance from any plane.
    pub(super) fn squared_distance(&self, plane: &Plane) -> f64 {
        let height = plane.height(self.center());
        quadratic(&self.spread(), plane.normal, plane.normal).max(0.0) + self.area * height * height
    }

    /// The same with what turned faces cost.
    pub(super) fn energy(&self, plane: &Plane) -> f64 {
        let height = plane.height(self.center());
        let turned = 2.0 * (self.area - dot(self.vector, plane.normal)).max(0.0);
        quadratic(&self.spread(), plane.normal, plane.normal).max(0.0)
            + self.area * (height * height + TURN * turned)
    }

    /// The plane of least energy among that of least distance and the one along the mean normal.
    pub(super) fn fit(&self) -> PlaneFit {
        let spread = self.spread();
        let fit = |normal: Point| {
            let squared_distance = quadratic(&spread, normal, normal).max(0.0);
            let turned = 2.0 * (self.area - dot(self.vector, normal)).max(0.0);
            let plane = Plane::through(self.center(), normal);
            PlaneFit { plane, squared_distance, energy: squared_distance + TURN * self.area * turned }
        };
        let (_, least) = least_eigen3(spread);
        let flat = if dot(least, self.vector) < 0.0 { scale(least, -1.0) } else { least };
        let (first, second) = (fit(flat), fit(unit(self.vector)));
        if first.energy <= second.energy || self.vector == [0.0; 3] {
            first
        } else {
            second
        }
    }
}

/// `uᵀ m v`.
pub(super) fn quadratic(m: &[Point; 3], u: Point, v: Point) -> f64 {
    (0..3).map(|i| u[i] * dot(m[i], v)).sum()
}
