//! Signals of any unit.

use crate::linear::Columns;
use crate::Result;

/// A signal shifted and scaled so that its widest column has a range of 1:
/// weights then mean the same for every signal.
pub(super) struct Normalized {
    pub values: Columns,
    low: Vec<f64>,
    pub range: f64,
}

impl Normalized {
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn of(values: &Columns) -> Result<Self> {
        let ends = |c: usize| {
            let column = values.column(c).iter();
            column.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)])
        };
        let ends: Vec<[f64; 2]> = (0..values.n_columns).map(ends).collect();
        let low: Vec<f64> = ends.iter().map(|[low, _]| *low).collect();
        let range = ends.iter().fold(0.0_f64, |range, [low, high]| range.max(high - low));
        let range = if range > 0.0 { range } else { 1.0 };
        let mut normalized = values.copied()?;
        for (c, low) in low.iter().enumerate() {
            normalized.column_mut(c).iter_mut().for_each(|x| *x = (*x - low) / range);
        }
        Ok(Self { values: normalized, low, range })
    }

    pub(super) fn restored(&self, columns: &Columns) -> Result<Columns> {
        let mut restored = columns.copied()?;
        for (c, low) in self.low.iter().enumerate() {
            restored.column_mut(c).iter_mut().for_each(|x| *x = *x * self.range + low);
        }
        Ok(restored)
    }
}
