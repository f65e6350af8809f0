//! Fewer colors along a curve: knots, and linear colors by arc length between them.

/// Thins the colors of one curve: `rows` has a row of `width` numbers a point,
/// `lengths` the edges between the points.
///
/// The knots are the ends and, again and again, the point that is farthest from the linear colors between its
/// neighboring knots (Ramer 1972; Douglas and Peucker 1973), until no number is off by more than `tolerance`.
/// Returns how many there are.
pub(super) fn thin(rows: &mut [f64], width: usize, lengths: &[f64], tolerance: f64) -> usize {
    let last = lengths.len();
    let mut places = vec![0.0; last + 1];
    for (i, length) in lengths.iter().enumerate() {
        places[i + 1] = places[i] + length;
    }
    let between = |rows: &[f64], i: usize, [from, to]: [usize; 2], k: usize| {
        let span = places[to] - places[from];
        let t = if span > 0.0 { (places[i] - places[from]) / span } else { 0.0 };
        (1.0 - t) * rows[from * width + k] + t * rows[to * width + k]
    };
    let mut knots = vec![0];
    let mut ends = vec![last];
    while let Some(&to) = ends.last() {
        let from = knots[knots.len() - 1];
        let off = |i: usize| {
            let differences =
                (0..width).map(|k| (rows[i * width + k] - between(rows, i, [from, to], k)).abs());
            differences.fold(0.0, f64::max)
        };
        let farthest = (from + 1..to).map(|i| (i, off(i))).reduce(|a, b| if b.1 > a.1 { b } else { a });
        match farthest {
            Some((i, distance)) if distance > tolerance => ends.push(i),
            _ => {
                ends.pop();
                knots.push(to);
            }
        }
    }
    for pair in knots.windows(2) {
        for i in pair[0] + 1..pair[1] {
            for k in 0..width {
                rows[i * width + k] = between(rows, i, [pair[0], pair[1]], k);
            }
        }
    }
    knots.len()
}
