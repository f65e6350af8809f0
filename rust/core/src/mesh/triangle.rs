//! One triangle known by its edge lengths; length `i` is opposite corner `i`.

/// A triangle counts as degenerate when its triangle inequality holds by less than this part of its longest
/// edge.
///
/// Rounding leaves an error of some 1e-15 of the longest edge in `c - (a - b)`, so below it nothing can be
/// said about the shape. A triangle of base 1 falls under it at a height of about 7e-8; a needle at a base of
/// 1e-14.
pub const DEGENERATE_SLACK: f64 = 1e-14;

/// The lengths from longest to shortest.
fn sorted(l: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = l;
    let (a, b) = if a < b { (b, a) } else { (a, b) };
    let (b, c) = if b < c { (c, b) } else { (b, c) };
    let (a, b) = if a < b { (b, a) } else { (a, b) };
    [a, b, c]
}

/// By how much the triangle inequality holds: the two shorter edges less the longest;
/// negative if it is violated.
#[must_use]
pub fn slack(l: [f64; 3]) -> f64 {
    let [a, b, c] = sorted(l);
    c - (a - b)
}

/// Whether the triangle has no usable shape, by [`DEGENERATE_SLACK`]; also if a length is not finite.
#[must_use]
pub fn is_degenerate(l: [f64; 3]) -> bool {
    let [a, b, c] = sorted(l);
    let sound = c - (a - b) > DEGENERATE_SLACK * a && a.is_finite();
    !sound
}

/// The area by Kahan's formula, accurate for needles; 0 if the triangle inequality is violated.
#[must_use]
pub fn area(l: [f64; 3]) -> f64 {
    let [a, b, c] = sorted(l);
    let product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    0.25 * product.max(0.0).sqrt()
}

/// The cotangents of the three angles. Infinite or NaN where the triangle is degenerate.
#[must_use]
pub fn cotangents(l: [f64; 3]) -> [f64; 3] {
    let quadruple_area = 4.0 * area(l);
    [0, 1, 2].map(|i| twice_dot(l, i) / quadruple_area)
}

/// The three angles in radians; a degenerate triangle has angles 0 and π.
#[must_use]
pub fn angles(l: [f64; 3]) -> [f64; 3] {
    let quadruple_area = 4.0 * area(l);
    [0, 1, 2].map(|i| quadruple_area.atan2(twice_dot(l, i)))
}

/// Twice the dot product of the two edges that leave corner `i`: `b² + c² − a²`,
/// with the difference factored.
pub(crate) fn twice_dot(l: [f64; 3], i: usize) -> f64 {
    let (a, b, c) = (l[i], l[(i + 1) % 3], l[(i + 2) % 3]);
    let (long, short) = if b > c { (b, c) } else { (c, b) };
    (long - a) * (long + a) + short * short
}

/// Corner `i` seen from its opposite edge: `[s, h]`, the foot of the height, measured from the start of
/// halfedge `i` (corner `i + 1`), and the height. `area` is that of [`area`]; the length of the edge must not
/// be 0.
#[must_use]
pub fn apex(l: [f64; 3], i: usize, area: f64) -> [f64; 2] {
    let (base, to_tail, to_head) = (l[i], l[(i + 2) % 3], l[(i + 1) % 3]);
    let inverse = 1.0 / base;
    [0.5 * (base + (to_tail - to_head) * (to_tail + to_head) * inverse), 2.0 * area * inverse]
}

/// The corners in the plane, counterclockwise, corner 0 at the origin and corner 1 on the positive x axis:
/// the frame of Rowe et al. 2024, eq. (28).
#[must_use]
pub fn layout(l: [f64; 3]) -> [[f64; 2]; 3] {
    [[0.0, 0.0], [l[2], 0.0], apex(l, 2, area(l))]
}
