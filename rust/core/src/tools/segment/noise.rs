//! How noisy a function is: from the jumps of its gradient across edges, most of which lie on no border.

use super::surface::Surface;
use crate::linear::Columns;
use crate::operators::Hinge;
use crate::{memory, Result};

/// The median of the length of a standard normal vector, by its number of entries (1 to 4; the square root of
/// the median of a chi-squared variable).
const MEDIAN_LENGTH: [f64; 4] = [0.674_490, 1.177_410, 1.538_172, 1.832_125];

/// The standard deviation of the noise on `values`, with `degrees` independent directions of it: the noise of
/// positions shows along the normal only, 1.
///
/// Across an edge the gradient of an affine function does not jump; independent noise makes it jump by the
/// noise times the norm of the four coefficients. The median over all edges does not see borders (Rousseeuw
/// and Croux 1993). Smooth curvature counts as noise where the mesh resolves it no better.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn noise_level(surface: &Surface<'_>, values: &Columns, degrees: usize) -> Result<f64> {
    let connectivity = surface.connectivity;
    let mut ratios = Vec::new();
    for h in connectivity.edges() {
        let Some(twin) = connectivity.twin(h) else { continue };
        if surface.areas[h / 3] <= 0.0 || surface.areas[twin / 3] <= 0.0 {
            continue;
        }
        let jump = Hinge::new(&surface.lengths, &surface.areas, h, twin).jump();
        let vertices = [
            connectivity.tail(h),
            connectivity.head(h),
            connectivity.opposite(h),
            connectivity.opposite(twin),
        ];
        let squared: f64 = (0..values.n_columns)
            .map(|c| {
                let column = values.column(c);
                let x: f64 = jump.iter().zip(vertices).map(|(j, v)| j * column[v as usize]).sum();
                x * x
            })
            .sum();
        let norm = jump.iter().map(|j| j * j).sum::<f64>().sqrt();
        if norm > 0.0 && norm.is_finite() {
            memory::push(&mut ratios, squared.sqrt() / norm)?;
        }
    }
    if ratios.is_empty() {
        return Ok(0.0);
    }
    let middle = ratios.len() / 2;
    let median = *ratios.select_nth_unstable_by(middle, f64::total_cmp).1;
    let degrees = degrees.clamp(1, MEDIAN_LENGTH.len());
    Ok(median / MEDIAN_LENGTH[degrees - 1])
}
