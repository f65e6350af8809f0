//! How far a shape has moved.

/// Root mean square distance of two point lists, with a weight for each point.
pub(super) fn weighted_distance(a: &[[f64; 3]], b: &[[f64; 3]], weights: &[f64]) -> f64 {
    let square =
        |(p, q): (&[f64; 3], &[f64; 3])| p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
    let sum: f64 = a.iter().zip(b).map(square).zip(weights).map(|(d, w)| w * d).sum();
    let total: f64 = weights.iter().sum();
    if total > 0.0 {
        (sum / total).sqrt()
    } else {
        0.0
    }
}

/// Root mean square distance of two point lists.
pub(super) fn root_mean_square(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let sum: f64 = a.iter().zip(b).flat_map(|(p, q)| p.iter().zip(q)).map(|(x, y)| (x - y) * (x - y)).sum();
    (sum / a.len().max(1) as f64).sqrt()
}
