//! Sharpness: iterated reweighting, which makes facets where the plain L1 energy makes domes.
//!
//! The Frobenius norm of the Hessian prefers a dome to facets, since `√(κ₁² + κ₂²) < κ₁ + κ₂`. Weights that
//! fall with the curvature already there (Candès et al. 2008) turn the sum of norms toward the sum of their
//! `p`-th powers.

use rayon::prelude::*;

use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::solve::Coupling;
use crate::{memory, Result};

/// Curvature below this part of the mean counts as none: keeps the weights of flat faces finite. 0.03 and 0.1
/// look alike, 0.1 converges faster.
const FLOOR: f64 = 0.1;

/// The norms `‖(H u)_b‖` of every block, joint over the columns or summed over them.
///
/// # Errors
/// [`crate::error::SolveError::Memory`].
pub(super) fn block_norms(operator: &BlockRows, u: &Columns, coupling: Coupling) -> Result<Vec<f64>> {
    let mut norms = memory::room(operator.n_blocks())?;
    (0..operator.n_blocks())
        .into_par_iter()
        .with_min_len(2048)
        .map(|b| {
            let squares = (0..u.n_columns).map(|c| operator.block_square(b, u.column(c)));
            match coupling {
                Coupling::Joint => squares.sum::<f64>().sqrt(),
                Coupling::Separate => squares.map(f64::sqrt).sum(),
            }
        })
        .collect_into_vec(&mut norms);
    Ok(norms)
}

/// `base · (a_f / mean a + 0.1)^(−sharpness)` with `a_f = ‖(H u)_f‖ / √A_f`, scaled so that `Σ w_f ‖(H u)_f‖`
/// is what it was with `base` alone. `norms` are the `‖(H u)_f‖` (times area, as the operator has them),
/// `areas` the `A_f`.
///
/// # Errors
/// [`crate::error::SolveError::Memory`].
pub fn sharpened_weights(norms: &[f64], areas: &[f64], base: &[f64], sharpness: f64) -> Result<Vec<f64>> {
    if sharpness == 0.0 {
        return Ok(memory::twin(base)?);
    }
    let dense = |(norm, area): (&f64, &f64)| if *area > 0.0 { norm / area.sqrt() } else { 0.0 };
    let density: Vec<f64> = memory::gathered(norms.iter().zip(areas).map(dense))?;
    let mean = density.iter().sum::<f64>() / density.len().max(1) as f64;
    if mean <= 0.0 || !mean.is_finite() {
        return Ok(memory::twin(base)?);
    }
    let mut raw = density;
    raw.iter_mut().zip(base).for_each(|(a, w)| *a = w * (*a / mean + FLOOR).powf(-sharpness));
    let total = |weights: &[f64]| weights.iter().zip(norms).map(|(w, x)| w * x).sum::<f64>();
    let (before, after) = (total(base), total(&raw));
    if after <= 0.0 || !after.is_finite() {
        return Ok(memory::twin(base)?);
    }
    raw.iter_mut().for_each(|w| *w = *w * before / after);
    Ok(raw)
}
