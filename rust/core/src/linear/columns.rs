//! A dense matrix of a few columns: one column a function on the vertices.

use std::borrow::Cow;

use crate::unit::Unit;
use crate::{memory, Error, Result};

/// A dense `n_rows × n_columns` matrix, stored column by column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    /// Number of rows.
    pub n_rows: usize,
    /// Number of columns.
    pub n_columns: usize,
    /// The entries, column by column.
    pub data: Vec<f64>,
}

impl Columns {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(n_rows: usize, n_columns: usize) -> Self {
        Self { n_rows, n_columns, data: vec![0.0; n_rows * n_columns] }
    }

    /// [`Columns::zeros`], refused where memory is missing.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(crate) fn try_zeros(n_rows: usize, n_columns: usize) -> Result<Self> {
        Ok(Self { n_rows, n_columns, data: memory::repeated(0.0, n_rows * n_columns)? })
    }

    /// One column.
    #[must_use]
    pub fn from_column(data: Vec<f64>) -> Self {
        Self { n_rows: data.len(), n_columns: 1, data }
    }

    /// The three coordinates of points as three columns.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn from_points(points: &[[f64; 3]]) -> Result<Self> {
        let mut data = memory::room(3 * points.len())?;
        for axis in 0..3 {
            data.extend(points.iter().map(|p| p[axis]));
        }
        Ok(Self { n_rows: points.len(), n_columns: 3, data })
    }

    /// The rows of a three-column matrix as points.
    ///
    /// # Errors
    /// [`Error::Argument`] when there are not three columns.
    pub fn to_points(&self) -> Result<Vec<[f64; 3]>> {
        if self.n_columns != 3 {
            return Err(Error::argument("values", format!("has {} columns, points need 3", self.n_columns)));
        }
        let point = |i: usize| std::array::from_fn(|axis| self.column(axis)[i]);
        Ok(memory::gathered((0..self.n_rows).map(point))?)
    }

    /// A copy.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub fn copied(&self) -> Result<Self> {
        Ok(Self { data: memory::twin(&self.data)?, ..*self })
    }

    /// The entries measured in `unit`.
    #[must_use]
    pub fn measured(&self, unit: Unit) -> Cow<'_, Self> {
        match unit.measure_all(&self.data) {
            Cow::Borrowed(_) => Cow::Borrowed(self),
            Cow::Owned(data) => Cow::Owned(Self { data, ..*self }),
        }
    }

    /// Column `c`.
    #[must_use]
    pub fn column(&self, c: usize) -> &[f64] {
        &self.data[c * self.n_rows..(c + 1) * self.n_rows]
    }

    /// Column `c`, to be written.
    pub fn column_mut(&mut self, c: usize) -> &mut [f64] {
        &mut self.data[c * self.n_rows..(c + 1) * self.n_rows]
    }

    /// Refuses a matrix of the wrong shape or with entries that are not finite.
    ///
    /// # Errors
    /// [`Error::Argument`] with the `name` given and what is wrong.
    pub fn check(&self, name: &'static str, n_rows: usize) -> Result<()> {
        if self.n_rows != n_rows {
            return Err(Error::argument(name, format!("has {} rows, expected {n_rows}", self.n_rows)));
        }
        if self.n_columns == 0 {
            return Err(Error::argument(name, "has no columns"));
        }
        match self.data.iter().position(|x| !x.is_finite()) {
            Some(k) => Err(Error::argument(
                name,
                format!("row {} column {} is not finite; remove or replace it", k % n_rows, k / n_rows),
            )),
            None => Ok(()),
        }
    }
}
