//! Weights given for faces, for operators whose blocks are not faces.

use crate::mesh::Connectivity;

/// The mean of the weights of the faces at each vertex, by area; 1 where no face has an area.
pub(crate) fn of_vertices(connectivity: &Connectivity, areas: &[f64], weights: &[f64]) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; connectivity.n_vertices()];
    for ((corners, area), weight) in connectivity.faces().iter().zip(areas).zip(weights) {
        for &corner in corners {
            let sum = &mut sums[corner as usize];
            *sum = [sum[0] + area * weight, sum[1] + area];
        }
    }
    sums.into_iter().map(|[sum, area]| if area > 0.0 { sum / area } else { 1.0 }).collect()
}

/// Which vertices touch an edge that has not exactly two faces with an area, alike oriented:
/// where a surface ends.
pub(crate) fn is_boundary(connectivity: &Connectivity, areas: &[f64]) -> Vec<bool> {
    let mut boundary = vec![false; connectivity.n_vertices()];
    for h in (0..connectivity.n_halfedges()).filter(|h| areas[h / 3] > 0.0) {
        if connectivity.twin(h).is_none_or(|twin| areas[twin / 3] == 0.0) {
            boundary[connectivity.tail(h) as usize] = true;
            boundary[connectivity.head(h) as usize] = true;
        }
    }
    boundary
}
