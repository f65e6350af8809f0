//! The penalties of the fast solver: found from the problem itself, never set by hand.

use crate::solve::cones::{norm, scaled, Block};
use crate::solve::reduced::Reduced;
use crate::solve::system::System;
use crate::{Progress, Result};

/// The product of penalty and typical block length, in units of the weight, at which alternating directions converge
/// fastest (0.2 to 1 measured alike).
const BALANCE: f64 = 0.5;

/// Lengths are clipped to these multiples of their mean: outside, the linear system loses digits and nothing is gained.
const CLIP: [f64; 2] = [0.03, 30.0];

/// Penalties `R_b = BALANCE · w_b / length_b`, lengths clipped around their mean.
#[must_use]
pub fn reweighted(lengths: &[f64], weights: &[f64]) -> Vec<f64> {
    let mean = weighted_mean(lengths, weights);
    if mean <= 0.0 {
        return weights.to_vec();
    }
    lengths.iter().zip(weights).map(|(g, w)| BALANCE * w / g.clamp(CLIP[0] * mean, CLIP[1] * mean)).collect()
}

/// The uniform scale `ρ` of `R = ρ w` with `ρ · mean ‖H u(ρ) + c‖ ≈ BALANCE`, where `u(ρ)` is the quadratic minimiser;
/// one to a few factorisations. `h` is the operator applied to the target.
///
/// Without fidelity the scale does not enter the linear system, and one factorisation does.
///
/// # Errors
/// A failed factorisation, or [`crate::Error::Cancelled`].
pub fn uniform_scale<const K: usize>(
    reduced: &mut Reduced<'_, K>,
    system: &mut System,
    h: &[Block<K>],
    progress: &Progress,
) -> Result<f64> {
    let has_fidelity = reduced.fidelity.iter().any(|a| *a > 0.0);
    let mut scale = if has_fidelity { balance_for(reduced, h) } else { 1.0 };
    for _ in 0..6 {
        progress.check()?;
        let r: Vec<f64> = reduced.weights.iter().map(|w| scale * w).collect();
        system.factorise(reduced, &r)?;
        let mut right = Vec::new();
        reduced.apply_transposed(|b| scaled(-r[b], &reduced.constant(b)), &mut right);
        let mut u = reduced.target.clone();
        system.solve(reduced, &right, &mut u);
        let mut smooth = Vec::new();
        reduced.apply(&u, &mut smooth);
        let next = balance_for(reduced, &smooth);
        if !has_fidelity || next < 2.0 * scale || progress.is_finishing() {
            return Ok(next);
        }
        scale = next;
    }
    Ok(scale)
}

fn balance_for<const K: usize>(reduced: &Reduced<'_, K>, h: &[Block<K>]) -> f64 {
    let lengths: Vec<f64> = h.iter().map(norm).collect();
    let mean = weighted_mean(&lengths, reduced.weights);
    if mean > 0.0 && mean.is_finite() {
        BALANCE / mean
    } else {
        1.0
    }
}

fn weighted_mean(values: &[f64], weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let sum: f64 = values.iter().zip(weights).map(|(x, w)| x * w).sum();
    if total > 0.0 {
        sum / total
    } else {
        0.0
    }
}
