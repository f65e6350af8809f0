//! How many facets.

use super::constants::{ERROR, FLAT};
use super::faces::Scan;
use super::hierarchy::{Cut, Hierarchy};
use super::job::Job;
use super::merging::Merges;
use super::moments::Moments;
use crate::Result;

/// What decides how many facets there are, lengths in the unit of the calculation.
#[derive(Debug, Clone, Copy)]
pub(super) enum Wanted {
    Facets(usize),
    Error(f64),
    Found,
}

/// How unlikely so many facets are, with this mean square distance, on a mesh of so many vertices: the more,
/// the less. The planes have three parameters each (Schwarz 1978).
pub(super) fn unlikely(n_facets: usize, mean_square: f64, n_vertices: usize) -> f64 {
    let data = n_vertices as f64;
    data * mean_square.max(FLAT * FLAT).ln() + 3.0 * n_facets as f64 * data.ln()
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
    pub(super) fn distance(&self, n: usize, count: usize, area: f64) -> f64 {
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
                let unlikely =
                    |&count: &usize| unlikely(count, self.distance(n, count, area).powi(2), n_vertices);
                let counts = fewest..=self.within(ERROR, n, area);
                counts.min_by(|a, b| unlikely(a).total_cmp(&unlikely(b))).unwrap_or(most)
            }
        }
    }
}

impl Job<'_> {
    /// The merges that leave `count` regions, and these. Where one of them is farther off than `error`, it is
    /// divided, since what is small hardly shows in the mean of all; but not where these would be less likely
    /// as a whole, as noise makes them.
    pub(super) fn start(
        &self,
        merges: &Merges,
        count: usize,
        error: Option<f64>,
        scan: &Scan,
    ) -> Result<(Hierarchy, Cut)> {
        let n = self.parts.len();
        let (tree, cut) = Hierarchy::new(merges, n, n - count)?;
        if let Some(error) = error {
            let mut divided = cut.clone();
            let is_beyond = |m: &Moments| m.fit().squared_distance > error * error * m.area;
            tree.split_beyond(&mut divided, &scan.moments, is_beyond)?;
            tree.close(&mut divided, |labels, n| self.regions(labels, n))?;
            let unlikely = |cut: &Cut| -> Result<f64> {
                let sums = scan.sums(&tree.labels(cut)?.0, cut.len())?;
                let squares: f64 = sums.iter().map(|m| m.fit().squared_distance).sum();
                Ok(unlikely(cut.len(), squares / scan.area.max(f64::MIN_POSITIVE), self.positions.len()))
            };
            if unlikely(&divided)? < unlikely(&cut)? {
                return Ok((tree, divided));
            }
        }
        Ok((tree, cut))
    }
}
