//! The penalties of the fast solver: found from the problem itself, never set by hand.

use crate::solve::cones::scaled;
use crate::solve::fast::system::{System, Weighing};
use crate::solve::reduced::Reduced;
use crate::{memory, Progress, Result};

/// The product of penalty and typical block length, in units of the weight, at which alternating directions
/// converge fastest (0.2 to 1 measured alike).
const BALANCE: f64 = 0.5;

/// Lengths are clipped to these multiples of their mean: outside,
/// the linear system loses digits and nothing is gained.
const CLIP: [f64; 2] = [0.03, 30.0];

/// A scale within this factor of the one sought is taken: new penalties come after a few iterations anyway,
/// and the search would cost a factorization more.
const GOOD_ENOUGH: f64 = 3.2;

/// The scale grows with noise, each time by less. On ten problems from light to heavy noise the whole way was
/// the first growth to the power of 1.6 to 2.6, so this saves one factorization and rarely overshoots.
const JUMP: f64 = 1.7;

/// The sum of all block lengths of a typical function without noise, in units of its standard deviation and
/// of the mean norm of the blocks. It depends little on the mesh: from 5 (a sphere's coordinates) to 70 (a
/// function with many ridges) measured.
const FOLDS: f64 = 20.0;

/// How much of the way from the scale of the noisy target to that of a function without noise the search
/// starts at, in logarithms.
const SMOOTH_SHARE: f64 = 5.0 / 6.0;

/// Factorizations that the search may take.
const MOST_ATTEMPTS: usize = 6;

/// Penalties `R_b = BALANCE · w_b / length_b`, lengths clipped around their mean; the weights alone where
/// rounding has left no lengths, as with edges where more than two faces meet.
///
/// # Errors
/// [`crate::error::SolveError::Memory`].
pub fn reweighted(lengths: &[f64], weights: &[f64]) -> Result<Vec<f64>> {
    let mean = weighted_mean(lengths, weights);
    if mean <= 0.0 || !mean.is_finite() {
        return Ok(memory::twin(weights)?);
    }
    let penalty = |(g, w): (&f64, &f64)| BALANCE * w / g.clamp(CLIP[0] * mean, CLIP[1] * mean);
    Ok(memory::gathered(lengths.iter().zip(weights).map(penalty))?)
}

/// The penalties `R = ρ w` to start with: `ρ · mean ‖H u(ρ) + c‖ ≈ BALANCE`, where `u(ρ)` is the
/// quadratic minimizer. Leaves `system` factored for them, after one to a few factorizations. `lengths`
/// are those of the operator applied to the target.
///
/// Without fidelity `u(ρ)` does not depend on `ρ`, and one factorization does.
///
/// # Errors
/// A failed factorization, or [`crate::Error::Cancelled`].
pub fn uniform<const K: usize>(
    reduced: &mut Reduced<'_, K>,
    system: &mut System,
    lengths: &[f64],
    progress: &Progress,
) -> Result<Vec<f64>> {
    let has_fidelity = reduced.fidelity.iter().any(|a| *a > 0.0);
    let mut scale = if has_fidelity { first_scale(reduced, lengths) } else { 1.0 };
    let weights = reduced.weights.clone();
    let penalties = |scale: f64| memory::gathered(weights.iter().map(|w| scale * w));
    let mut attempts = 0;
    loop {
        progress.check()?;
        let r = penalties(scale)?;
        system.factorize(reduced, Weighing::Penalties(&r), progress)?;
        attempts += 1;
        if attempts == MOST_ATTEMPTS || progress.is_finishing() {
            return Ok(r);
        }
        let right = reduced.apply_transposed(|b| scaled(-r[b], &reduced.block_at(b, &reduced.target)))?;
        let mut u = memory::twin(&reduced.target)?;
        system.solve(reduced, &right, &mut u)?;
        let next = balance_for(reduced, &reduced.lengths(&u)?);
        if !has_fidelity {
            system.rescale(next / scale);
            return Ok(penalties(next)?);
        }
        if next < GOOD_ENOUGH * scale && scale < GOOD_ENOUGH * next {
            return Ok(r);
        }
        scale = if next > scale { scale * (next / scale).powf(JUMP) } else { next };
    }
}

/// A guess at the scale, before anything is known but the target: what balances the target itself is far too
/// little where there is noise, by a factor of thousands on fine meshes, so what would balance [`FOLDS`] over
/// the whole surface counts for the most of it.
fn first_scale<const K: usize>(reduced: &Reduced<'_, K>, lengths: &[f64]) -> f64 {
    let noisy = balance_for(reduced, lengths);
    let smooth = BALANCE * lengths.len() as f64 / (FOLDS * deviation(&reduced.target) * mean_norm(reduced));
    if smooth.is_finite() && smooth > noisy {
        noisy * (smooth / noisy).powf(SMOOTH_SHARE)
    } else {
        noisy
    }
}

/// The standard deviation of the rows, all columns together.
fn deviation<const K: usize>(rows: &[[f64; K]]) -> f64 {
    let n = rows.len().max(1) as f64;
    let mut variance = 0.0;
    for c in 0..K {
        let mean = rows.iter().map(|row| row[c]).sum::<f64>() / n;
        variance += rows.iter().map(|row| (row[c] - mean).powi(2)).sum::<f64>() / n;
    }
    variance.sqrt()
}

/// The mean Frobenius norm of the blocks of the operator.
fn mean_norm<const K: usize>(reduced: &Reduced<'_, K>) -> f64 {
    let operator = &reduced.free.operator;
    let norm = |b| operator.block(b).1.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    (0..operator.n_blocks()).map(norm).sum::<f64>() / operator.n_blocks().max(1) as f64
}

fn balance_for<const K: usize>(reduced: &Reduced<'_, K>, lengths: &[f64]) -> f64 {
    let mean = weighted_mean(lengths, &reduced.weights);
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
