//! How many facets.

use super::constants::{ERROR, FLAT};
use super::merging::Merges;

/// What decides how many facets there are, lengths in the unit of the calculation.
#[derive(Debug, Clone, Copy)]
pub(super) enum Wanted {
    Facets(usize),
    Error(f64),
    Found,
}

impl Wanted {
    /// The same beside faces that stay.
    pub(super) fn and(self, n_held: usize) -> Self {
        match self {
            Self::Facets(count) => Self::Facets(count + n_held),
            other => other,
        }
    }
}

impl Merges {
    /// Fewest and most regions of `n`.
    pub(super) fn range(&self, n: usize) -> [usize; 2] {
        [n - self.pairs.len(), n]
    }

    /// The root mean square distance from the planes of `count` regions of `n`, on faces of so much `area`.
    fn distance(&self, n: usize, count: usize, area: f64) -> f64 {
        let made = n - count;
        let squares = if made == 0 { 0.0 } else { self.squared_distances[made - 1] };
        (squares / area).sqrt()
    }

    /// How many of `n` regions have no more than `error`.
    fn within(&self, error: f64, n: usize, area: f64) -> usize {
        let [fewest, most] = self.range(n);
        (fewest..=most).find(|&count| self.distance(n, count, area) <= error).unwrap_or(most)
    }

    /// How many planes `n` faces lie on.
    pub(super) fn planes(&self, n: usize, area: f64) -> usize {
        self.within(FLAT, n, area)
    }

    /// How many of `n` regions to leave, on a mesh of so many vertices.
    pub(super) fn count(&self, wanted: Wanted, n: usize, n_vertices: usize, area: f64) -> usize {
        let [fewest, most] = self.range(n);
        match wanted {
            // More facets than the mesh has planes would only cut these up.
            Wanted::Facets(count) => count.clamp(fewest, self.planes(n, area)),
            Wanted::Error(error) => self.within(error, n, area),
            Wanted::Found => {
                let data = n_vertices as f64;
                let unlikely = |&count: &usize| {
                    data * self.distance(n, count, area).max(FLAT).powi(2).ln()
                        + 3.0 * count as f64 * data.ln()
                };
                let counts = fewest..=self.within(ERROR, n, area);
                counts.min_by(|a, b| unlikely(a).total_cmp(&unlikely(b))).unwrap_or(most)
            }
        }
    }
}
