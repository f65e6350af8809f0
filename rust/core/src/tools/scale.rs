//! The unit of length in which weights are meant, and the sizes of a shape.

use crate::mesh::{rows_of_lengths, triangle, Connectivity};

/// A cube's side over the root mean square distance of its surface from its center:
/// 0.25 + 2/12 for a side of 1.
const SIDE_OF_EXTENT: f64 = 1.549_193_338_482_966_8;

/// Barycenters whose squared distances are this part of those within faces are in one place, to rounding.
const ONE_PLACE: f64 = 1e-9;

/// The unit of length: energies grow with length, fidelity terms with its fourth power.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Scale {
    /// The longest edge (Rowe et al. 2024, section 7.3).
    #[default]
    MaxEdge,
    /// The longest side of the axis-aligned bounding box.
    BoundingBox,
    /// The square root of the surface area: like the bounding box, but independent of rotations.
    Area,
    /// The side of the cube whose surface is as far from its center, root mean square: nearer to the bounding
    /// box than the area is, and independent of rotations.
    Extent,
    /// This length, whatever the shape.
    Length(f64),
}

impl Scale {
    /// The unit for a shape with these `points` and edge `lengths`.
    pub(super) fn unit(self, connectivity: &Connectivity, points: &[[f64; 3]], lengths: &[[f64; 3]]) -> f64 {
        match self {
            Self::MaxEdge => lengths.iter().flatten().fold(0.0, |a, &l| a.max(l)),
            Self::BoundingBox => longest_side(connectivity, points),
            Self::Area => lengths.iter().map(|&l| triangle::area(l)).sum::<f64>().sqrt(),
            Self::Extent => SIDE_OF_EXTENT * extent(connectivity, points).0,
            Self::Length(length) => length,
        }
    }
}

/// Root mean square distance of the face barycenters, weighted by area, from their center (a size that
/// rotations do not change), and the area. Where these are in one place, as of one triangle and its copies,
/// that of all points of the faces.
pub(super) fn extent(connectivity: &Connectivity, points: &[[f64; 3]]) -> (f64, f64) {
    let (mut total, mut first, mut second, mut inside) = (0.0, [0.0; 3], 0.0, 0.0);
    for (face, l) in connectivity.faces().iter().zip(rows_of_lengths(connectivity.faces(), points)) {
        let area = triangle::area(l);
        let center: [f64; 3] =
            std::array::from_fn(|c| face.iter().map(|&v| points[v as usize][c]).sum::<f64>() / 3.0);
        total += area;
        for (f, c) in first.iter_mut().zip(&center) {
            *f += area * c;
        }
        second += area * center.iter().map(|c| c * c).sum::<f64>();
        inside += area * l.iter().map(|l| l * l).sum::<f64>() / 36.0;
    }
    if total <= 0.0 {
        return (0.0, 0.0);
    }
    let mean = first.map(|f| f / total);
    let apart = (second / total - mean.iter().map(|m| m * m).sum::<f64>()).max(0.0);
    let is_one_place = apart * total < ONE_PLACE * inside;
    (if is_one_place { inside / total } else { apart }.sqrt(), total)
}

/// The longest side of the bounding box of the vertices that faces use.
fn longest_side(connectivity: &Connectivity, points: &[[f64; 3]]) -> f64 {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &v in connectivity.faces().iter().flatten() {
        for (c, x) in points[v as usize].iter().enumerate() {
            low[c] = low[c].min(*x);
            high[c] = high[c].max(*x);
        }
    }
    (0..3).fold(0.0, |side: f64, c| side.max(high[c] - low[c]))
}
