//! The indicator of borders for a fixed signal: one linear system on the faces, its pattern analyzed once.

use super::surface::Surface;
use crate::linear::cholesky::Cholesky;
use crate::linear::pattern::LowerPattern;
use crate::{memory, Progress, Result};

/// `v ← argmin vᵀ (diag ‖(H u)_f‖ + λ ε L + λ/(4ε) M_F) v − λ/(2ε) 1ᵀ M_F v` (Rowe et al. 2024, supplement
/// E), for one `ε` after the other. `λ` is times a cost for each face, and for each edge the mean of both.
pub(super) struct IndicatorStep {
    cholesky: Cholesky,
    /// `λ` times the cost and the area of each face.
    weighted_areas: Vec<f64>,
    /// Where the columns of `λ L` start, each with its diagonal entry.
    starts: Vec<usize>,
    /// The entries of `λ L`.
    laplacian: Vec<f64>,
    values: Vec<f64>,
    epsilon: f64,
}

impl IndicatorStep {
    /// Analyzes the pattern of these faces, all of the surface or a piece of it, each at its place there.
    /// `weights` are those of the halfedges ([`crate::operators::face_laplacian_weights`]).
    ///
    /// # Errors
    /// Too little memory for the factor, or [`crate::Error::Cancelled`].
    pub(super) fn new(
        surface: &Surface<'_>,
        [faces, places]: [&[u32]; 2],
        weights: &[[f64; 3]],
        length_weight: f64,
        face_costs: &[f64],
        progress: &Progress,
    ) -> Result<Self> {
        let m = faces.len();
        let n_sides: usize = faces.iter().map(|&f| surface.around(f as usize).count()).sum();
        let (mut starts, mut rows) = (memory::room(m + 1)?, memory::room(m + n_sides / 2)?);
        let mut laplacian = memory::room(m + n_sides / 2)?;
        starts.push(0);
        for (k, &f) in faces.iter().enumerate() {
            let f = f as usize;
            let mut column: Vec<(usize, f64)> = Vec::with_capacity(3);
            let mut diagonal = 0.0;
            for (h, g) in surface.around(f) {
                let weight = length_weight * 0.5 * (face_costs[f] + face_costs[g]) * weights[f][h % 3];
                diagonal += weight;
                if g > f {
                    column.push((places[g] as usize, -weight));
                }
            }
            column.sort_by_key(|(row, _)| *row);
            rows.push(k);
            laplacian.push(diagonal);
            for same in column.chunk_by(|a, b| a.0 == b.0) {
                rows.push(same[0].0);
                laplacian.push(same.iter().map(|(_, value)| value).sum());
            }
            starts.push(rows.len());
        }
        let weighted =
            faces.iter().map(|&f| length_weight * face_costs[f as usize] * surface.areas[f as usize]);
        let weighted_areas = memory::gathered(weighted)?;
        let pattern = LowerPattern { n: m, starts, rows };
        Ok(Self {
            cholesky: Cholesky::analyze(&pattern, None, progress)?,
            starts: pattern.starts,
            weighted_areas,
            values: memory::twin(&laplacian)?,
            laplacian,
            epsilon: 1.0,
        })
    }

    /// Sets `ε`.
    pub(super) fn prepare(&mut self, epsilon: f64) {
        self.epsilon = epsilon;
    }

    /// The minimizer for the norms `‖(H u)_f‖`. Faces that nothing determines, those without area, get 1.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or [`crate::Error::Cancelled`].
    pub(super) fn minimize(&mut self, norms: &[f64], progress: &Progress) -> Result<Vec<f64>> {
        let largest = self.weighted_areas.iter().fold(0.0_f64, |a, b| a.max(*b)).max(f64::MIN_POSITIVE);
        for (value, entry) in self.values.iter_mut().zip(&self.laplacian) {
            *value = self.epsilon * entry;
        }
        let pull = |area: f64| 0.25 / self.epsilon * area.max(1e-12 * largest);
        for ((&start, norm), &area) in self.starts.iter().zip(norms).zip(&self.weighted_areas) {
            self.values[start] += norm + pull(area);
        }
        let mut v: Vec<[f64; 1]> = memory::gathered(self.weighted_areas.iter().map(|&area| [pull(area)]))?;
        self.cholesky.factorize(&self.values, progress)?;
        self.cholesky.solve(&mut v)?;
        // Exactly, 0 < v ≤ 1 by the maximum principle.
        v.iter_mut().for_each(|[v]| *v = v.clamp(0.0, 1.0));
        Ok(v.into_flattened())
    }
}
