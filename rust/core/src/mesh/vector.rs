//! Points and vectors in space.

/// A point or a vector.
pub type Point = [f64; 3];

/// `a + b`.
#[must_use]
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[must_use]
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `factor a`.
#[must_use]
pub fn scale(a: Point, factor: f64) -> Point {
    a.map(|x| factor * x)
}

/// The inner product.
#[must_use]
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[must_use]
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
#[must_use]
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// The vector of length 1 along `a`, or zero if `a` is zero.
#[must_use]
pub fn unit(a: Point) -> Point {
    let length = norm(a);
    if length > 0.0 {
        scale(a, 1.0 / length)
    } else {
        [0.0; 3]
    }
}

/// The distance between two points.
#[must_use]
pub fn distance(a: Point, b: Point) -> f64 {
    norm(sub(a, b))
}

/// `(1 - t) a + t b`.
#[must_use]
pub fn between(a: Point, b: Point, t: f64) -> Point {
    add(a, scale(sub(b, a), t))
}

/// Names for places: those of two points are equal if all coordinates are, whatever the sign of a zero.
#[must_use]
pub fn place(point: Point) -> [u64; 3] {
    point.map(|x| (x + 0.0).to_bits())
}

/// The mean of three points.
#[must_use]
pub fn centroid([a, b, c]: [Point; 3]) -> Point {
    scale(add(add(a, b), c), 1.0 / 3.0)
}

/// The area vector of a triangle: along its normal (counterclockwise corners seen from its tip),
/// as long as its area.
#[must_use]
pub fn area_vector([a, b, c]: [Point; 3]) -> Point {
    scale(cross(sub(b, a), sub(c, a)), 0.5)
}

/// The cosine of the angle between two vectors; 1 if one is zero.
#[must_use]
pub fn cosine(a: Point, b: Point) -> f64 {
    let lengths = norm(a) * norm(b);
    if lengths > 0.0 {
        dot(a, b) / lengths
    } else {
        1.0
    }
}

/// The quality `4 √3 area / Σ length²` of a triangle: 1 if equilateral,
/// 0 if degenerate (Bank and Smith 1997).
#[must_use]
pub fn quality(corners: [Point; 3]) -> f64 {
    let [a, b, c] = corners;
    let squares = [sub(b, a), sub(c, b), sub(a, c)].iter().map(|&e| dot(e, e)).sum::<f64>();
    if squares > 0.0 {
        4.0 * 3.0_f64.sqrt() * norm(area_vector(corners)) / squares
    } else {
        0.0
    }
}
