//! Surfaces to begin a fit with, from points and normals.

use super::{beside, perpendicular, Kind, Surface};
use crate::error::SolveError;
use crate::linear::small::{eigen3, scatter, solved, symmetric_eigen};
use crate::memory;
use crate::mesh::vector::{add, cross, dot, norm, scale, sub, unit, Point};
use crate::surfaces::Samples;

type Result<T> = std::result::Result<T, SolveError>;

/// Surfaces of a `kind` near points that lie about the origin, with the size 1.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give that much, here and below.
pub(super) fn starts(kind: Kind, samples: &Samples) -> Result<Vec<Surface>> {
    match kind {
        Kind::Plane => planes(samples),
        Kind::Sphere => Ok(spheres(samples)),
        Kind::Cylinder | Kind::Cone | Kind::Torus => {
            let mut found = Vec::new();
            for (axis, point) in axes(samples) {
                found.extend(about(kind, samples, axis, point)?);
            }
            Ok(found)
        }
    }
}

/// `Σ w (v − mean)(v − mean)ᵀ`, or about 0 where `is_central` is false.
fn spread(vectors: &[Point], weights: &[f64], is_central: bool) -> [[f64; 3]; 3] {
    let total: f64 = weights.iter().sum();
    let sum = vectors.iter().zip(weights).fold([0.0; 3], |sum, (&v, &w)| add(sum, scale(v, w)));
    let mean = if is_central { scale(sum, 1.0 / total) } else { [0.0; 3] };
    scatter(vectors.iter().zip(weights).map(|(&v, &w)| (sub(v, mean), w)))
}

/// The eigenvectors by falling eigenvalues.
fn principal(matrix: [[f64; 3]; 3]) -> [Point; 3] {
    let mut pairs = eigen3(matrix);
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs.map(|pair| pair.1)
}

fn planes(samples: &Samples) -> Result<Vec<Surface>> {
    let [.., thin] = principal(spread(&samples.points, &samples.weights, true));
    let sum =
        samples.normals.iter().zip(&samples.weights).fold([0.0; 3], |sum, (&n, &w)| add(sum, scale(n, w)));
    let through = |normal: Point| {
        let mut offsets: Vec<f64> = memory::gathered(samples.points.iter().map(|&p| dot(p, normal)))?;
        let middle = offsets.len() / 2;
        Ok(Surface::Plane { normal, offset: *offsets.select_nth_unstable_by(middle, f64::total_cmp).1 })
    };
    [thin, unit(sum)].into_iter().filter(|n| norm(*n) > 0.5).map(through).collect()
}

/// Least squares over rows of coefficients, right side and weight.
fn least_squares<const N: usize>(rows: impl Iterator<Item = ([f64; N], f64, f64)>) -> Vec<f64> {
    let (mut matrix, mut right) = (vec![vec![0.0; N]; N], vec![0.0; N]);
    for (row, value, weight) in rows {
        for i in 0..N {
            right[i] += weight * row[i] * value;
            (0..N).for_each(|j| matrix[i][j] += weight * row[i] * row[j]);
        }
    }
    solved(matrix, &right, 1e-12, 0.0)
}

/// `|p|² = 2 c · p + k`, and from the normals, which meet in the center.
fn spheres(samples: &Samples) -> Vec<Surface> {
    let each = || samples.points.iter().zip(&samples.normals).zip(&samples.weights);
    let x =
        least_squares(each().map(|((p, _), &w)| ([2.0 * p[0], 2.0 * p[1], 2.0 * p[2], 1.0], dot(*p, *p), w)));
    let algebraic = [x[0], x[1], x[2]];
    let radius = (x[3] + dot(algebraic, algebraic)).max(0.0).sqrt();
    // p = c + r n
    let rows = each().flat_map(|((p, n), &w)| {
        (0..3).map(move |c| {
            let mut row = [0.0, 0.0, 0.0, n[c]];
            row[c] = 1.0;
            (row, p[c], w)
        })
    });
    let y = least_squares(rows);
    vec![
        Surface::Sphere { center: algebraic, radius },
        Surface::Sphere { center: [y[0], y[1], y[2]], radius: y[3].abs() },
    ]
}

/// Axes that the surface may turn about: directions, each with a point where the normals tell one.
fn axes(samples: &Samples) -> Vec<(Point, Option<Point>)> {
    let (points, normals, weights) = (&samples.points, &samples.normals, &samples.weights);
    let [_, _, across] = principal(spread(normals, weights, false));
    let [_, middle, circle] = principal(spread(normals, weights, true));
    let long = principal(spread(points, weights, true));
    let mut axes: Vec<(Point, Option<Point>)> =
        [across, circle, middle, long[0], long[1], long[2]].into_iter().map(|axis| (axis, None)).collect();
    axes.extend(complex(samples).map(|(axis, point)| (axis, Some(point))));
    axes
}

/// The axis that all normals meet: `(p × n) · a + n · b = 0` with `a` along it (Pottmann and Randrup 1998).
fn complex(samples: &Samples) -> Option<(Point, Point)> {
    let mut matrix = vec![vec![0.0; 6]; 6];
    for ((&p, &n), w) in samples.points.iter().zip(&samples.normals).zip(&samples.weights) {
        let moment = cross(p, n);
        let row = [moment[0], moment[1], moment[2], n[0], n[1], n[2]];
        for i in 0..6 {
            (0..6).for_each(|j| matrix[i][j] += w * row[i] * row[j]);
        }
    }
    let (_, vectors) = symmetric_eigen(matrix);
    let v = vectors.first()?;
    let (along, moment) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
    let length = norm(along);
    if length < 1e-6 {
        return None;
    }
    // b = point × a, less what a screw would add.
    Some((scale(along, 1.0 / length), scale(cross(along, moment), 1.0 / (length * length))))
}

/// Surfaces of a kind about an axis in a direction, through `point` where that is known.
fn about(kind: Kind, samples: &Samples, axis: Point, point: Option<Point>) -> Result<Vec<Surface>> {
    let first = perpendicular(axis);
    let second = cross(axis, first);
    let place = |x: f64, y: f64| add(scale(first, x), scale(second, y));
    let flat: Vec<[f64; 2]> =
        memory::gathered(samples.points.iter().map(|&p| [dot(p, first), dot(p, second)]))?;
    let meeting = || {
        let rows = samples.normals.iter().zip(&flat).zip(&samples.weights).map(|((&n, p), &w)| {
            let n = [dot(n, first), dot(n, second)];
            ([n[1], -n[0]], p[0] * n[1] - p[1] * n[0], w)
        });
        let x = least_squares(rows);
        place(x[0], x[1])
    };
    let mut through: Vec<Point> = vec![point.unwrap_or_else(meeting)];
    if let Some([x, y, _]) = circle(flat.iter().copied().zip(samples.weights.iter().copied())) {
        through.push(place(x, y));
    }
    through.into_iter().filter_map(|point| turned(kind, samples, axis, point).transpose()).collect()
}

/// The circle through points in a plane: center and radius, by algebraic least squares.
fn circle(points: impl Iterator<Item = ([f64; 2], f64)>) -> Option<[f64; 3]> {
    let rows = points.map(|([x, y], w)| ([2.0 * x, 2.0 * y, 1.0], x * x + y * y, w));
    let x = least_squares(rows);
    let square = x[2] + x[0] * x[0] + x[1] * x[1];
    (square > 0.0).then(|| [x[0], x[1], square.sqrt()])
}

/// The surface of a kind about an axis, by the heights of the points along it and their distances from it.
fn turned(kind: Kind, samples: &Samples, axis: Point, point: Point) -> Result<Option<Surface>> {
    let places = samples.points.iter().map(|&p| {
        let (height, rho, _) = beside(p, point, axis);
        [rho, height]
    });
    let profile: Vec<[f64; 2]> = memory::gathered(places)?;
    let total = samples.total();
    let mean = |k: usize| profile.iter().zip(&samples.weights).map(|(p, w)| w * p[k]).sum::<f64>() / total;
    let (rho, height) = (mean(0), mean(1));
    Ok(match kind {
        Kind::Cylinder => Some(Surface::Cylinder { point, axis, radius: rho }),
        Kind::Cone => {
            // The line through the profile, by its direction of most spread.
            let rows: Vec<Point> = memory::gathered(profile.iter().map(|p| [p[0], p[1], 0.0]))?;
            let [mut along, ..] = principal(spread(&rows, &samples.weights, true));
            if along[1] < 0.0 {
                along = scale(along, -1.0);
            }
            let point = add(point, scale(axis, height));
            Some(Surface::Cone { point, axis, radius: rho, slope: along[0].atan2(along[1]) })
        }
        Kind::Torus => {
            let found = circle(profile.into_iter().zip(samples.weights.iter().copied()));
            found.map(|[major, center, minor]| {
                let center = add(point, scale(axis, center));
                Surface::Torus { center, axis, major: major.abs(), minor }
            })
        }
        Kind::Plane | Kind::Sphere => None,
    })
}
