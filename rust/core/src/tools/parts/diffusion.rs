//! Diffusion along a surface: what is measured on single faces, smoothed over a length.

use super::constants::{DIFFUSION_RESIDUAL, MOST_ITERATIONS};
use crate::linear::conjugate_gradients::conjugate_gradients;
use crate::{memory, Result};

/// Two faces, and how well what is diffused flows between them: border over distance.
pub(super) type Link = ([u32; 2], f64);

/// Solves `(M + r² L) x = right`: with `right = M x₀` the values `x₀` smoothed over the length `r`.
pub(super) fn diffused<const K: usize>(
    masses: &[f64],
    links: &[Link],
    length: f64,
    right: Vec<[f64; K]>,
) -> Result<Vec<[f64; K]>> {
    let time = length * length;
    let mut diagonal = memory::twin(masses)?;
    for (ends, strength) in links {
        ends.iter().for_each(|&f| diagonal[f as usize] += time * strength);
    }
    let matrix = |x: &[[f64; K]]| {
        let mut out = memory::gathered(x.iter().zip(masses).map(|(x, mass)| x.map(|x| mass * x)))?;
        for &([f, g], strength) in links {
            let [f, g] = [f as usize, g as usize];
            for k in 0..K {
                let flow = time * strength * (x[f][k] - x[g][k]);
                out[f][k] += flow;
                out[g][k] -= flow;
            }
        }
        Ok(out)
    };
    let precondition = |x: &mut [[f64; K]]| {
        x.iter_mut().zip(&diagonal).for_each(|(x, d)| *x = x.map(|x| x / d));
        Ok(())
    };
    Ok(conjugate_gradients(matrix, precondition, right, DIFFUSION_RESIDUAL, MOST_ITERATIONS)?.solution)
}
