//! Dense kernels of the factorization: the first columns of a front, and what they take off the rest.
//!
//! Fronts of surface meshes are small: a handful of columns, tens of rows. General dense kernels spend their
//! time on packing there, so these work straight on the columns; large updates go to the library's product.

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};

use super::padded::{stride_of, Padded, COLUMNS};
use crate::linear::real::Real;
use crate::{Progress, Result};

/// Columns that are eliminated before the rest of a wide panel is brought up to date.
const BLOCK_COLUMNS: usize = 64;

/// From this many columns on the library's product is faster (measured: equal at 32).
const LARGE: usize = 24;

/// Products of fewer rows are not worth sharing between threads. How they are cut does not depend on the
/// threads, so results do not either.
const SHARED: usize = 512;

/// One front: `panel` holds its first `n_columns` columns of `n_rows`,
/// `update` the columns and rows after these.
#[derive(Debug)]
pub(super) struct Front<'f, R> {
    /// Columns to be eliminated, lower triangle.
    pub panel: &'f mut Padded<R>,
    /// What is left for the parent, lower triangle with the stride of [`Padded`];
    /// what stood there is forgotten.
    pub update: &'f mut [R],
    /// Rows of the panel.
    pub n_rows: usize,
    /// Columns of the panel.
    pub n_columns: usize,
}

impl<R: Real> Front<'_, R> {
    /// Turns the panel into columns of the factor and takes their product off the update;
    /// `false` when a pivot is not positive.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`], from a front with more than one block of columns or with products for
    /// several threads; the others take less than a millisecond.
    pub(super) fn eliminate(&mut self, progress: &Progress) -> Result<bool> {
        let mut begin = 0;
        while begin < self.n_columns {
            let end = self.n_columns.min(begin + BLOCK_COLUMNS);
            let stride = self.panel.stride;
            let block = &mut self.panel.values[begin * stride..];
            if !Arch::new().dispatch(Eliminate { block, stride, first: begin, n_columns: end - begin }) {
                return Ok(false);
            }
            if end < self.n_columns {
                progress.check()?;
                self.bring_up_to_date(begin, end, progress)?;
            }
            begin = end;
        }
        self.take_off(progress)?;
        Ok(true)
    }

    /// Takes the columns `begin..end` off the later ones of the panel.
    fn bring_up_to_date(&mut self, begin: usize, end: usize, progress: &Progress) -> Result<()> {
        let (stride, n_rows) = (self.panel.stride, self.n_rows);
        let (done, rest) = self.panel.values.split_at_mut(end * stride);
        let rest = &mut rest[..(self.n_columns - end) * stride];
        let done =
            MatRef::from_column_major_slice_with_stride(&done[begin * stride..], n_rows, end - begin, stride);
        let width = self.n_columns - end;
        let rest = MatMut::from_column_major_slice_with_stride_mut(rest, n_rows, width, stride);
        let (_, rest) = rest.split_at_row_mut(end);
        let (triangle, below) = rest.split_at_row_mut(width);
        let (_, done) = done.split_at_row(end);
        let (top, bottom) = done.split_at_row(width);
        subtract_product(triangle, top, Accum::Add, progress)?;
        subtract_rectangle(below, bottom, top, Accum::Add, progress)
    }

    /// Writes what all columns of the panel take off the rows below.
    fn take_off(&mut self, progress: &Progress) -> Result<()> {
        let (k, m) = (self.n_columns, self.n_rows);
        let n = m - k;
        let (stride, own) = (stride_of(n), self.panel.stride);
        if k < LARGE {
            let update = &mut *self.update;
            Arch::new().dispatch(TakeOff { update, stride, n, panel: &self.panel.values, own, k });
            return Ok(());
        }
        let panel = MatRef::from_column_major_slice_with_stride(&self.panel.values, m, k, own).subrows(k, n);
        let update = MatMut::from_column_major_slice_with_stride_mut(self.update, n, n, stride);
        subtract_product(update, panel, Accum::Replace, progress)
    }
}

/// `target −= x xᵀ` or `target = −x xᵀ`, lower triangle: cut in halves,
/// on several threads while they are large.
fn subtract_product<R: Real>(
    target: MatMut<'_, R>,
    x: MatRef<'_, R>,
    accumulate: Accum,
    progress: &Progress,
) -> Result<()> {
    let n = target.nrows();
    if n < SHARED {
        let (lower, rectangle) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
        let (other, minus) = (x.transpose(), R::of(-1.0));
        triangular::matmul(target, lower, accumulate, x, rectangle, other, rectangle, minus, Par::Seq);
        return Ok(());
    }
    progress.check()?;
    let (left, _, below, right) = target.split_at_mut(n / 2, n / 2);
    let (top, bottom) = x.split_at_row(n / 2);
    let corner = || subtract_rectangle(below, bottom, top, accumulate, progress);
    let triangles = || {
        both(rayon::join(
            || subtract_product(left, top, accumulate, progress),
            || subtract_product(right, bottom, accumulate, progress),
        ))
    };
    both(rayon::join(corner, triangles))
}

/// `target −= x yᵀ` or `target = −x yᵀ`, cut into parts for several threads.
fn subtract_rectangle<R: Real>(
    target: MatMut<'_, R>,
    x: MatRef<'_, R>,
    y: MatRef<'_, R>,
    accumulate: Accum,
    progress: &Progress,
) -> Result<()> {
    let n = target.nrows();
    if n < SHARED {
        matmul(target, accumulate, x, y.transpose(), R::of(-1.0), Par::Seq);
        return Ok(());
    }
    progress.check()?;
    let (above, below) = target.split_at_row_mut(n / 2);
    let (top, bottom) = x.split_at_row(n / 2);
    both(rayon::join(
        || subtract_rectangle(above, top, y, accumulate, progress),
        || subtract_rectangle(below, bottom, y, accumulate, progress),
    ))
}

/// Whether both halves are done.
fn both((one, other): (Result<()>, Result<()>)) -> Result<()> {
    one.and(other)
}

/// `target −= Σ_a source_a · tops_a` for the rows from `first` to `end` of [`COLUMNS`] columns: row `i` of
/// the target goes with row `i + shift` of the sources, and `tops_a` are the rows from `top` on of source
/// `a`.
struct RankUpdate<'u, R> {
    target: &'u mut [R],
    stride: usize,
    first: usize,
    end: usize,
    sources: &'u [R],
    own: usize,
    n_sources: usize,
    shift: usize,
    top: usize,
}

impl<R: Real> RankUpdate<'_, R> {
    #[inline(always)]
    fn run<S: Simd, const REPLACES: bool>(self, simd: S) {
        let step = 2 * R::lanes::<S>();
        let mut i = self.first;
        while i < self.end {
            let mut sums = [[R::splat(simd, R::ZERO); 2]; COLUMNS];
            for a in 0..self.n_sources {
                let source = &self.sources[a * self.own..];
                let rows = R::registers::<S>(&source[i + self.shift..i + self.shift + step]);
                let tops = &source[self.top..self.top + COLUMNS];
                for c in 0..COLUMNS {
                    let top = R::splat(simd, tops[c]);
                    sums[c][0] = R::times_plus(simd, rows[0], top, sums[c][0]);
                    sums[c][1] = R::times_plus(simd, rows[1], top, sums[c][1]);
                }
            }
            for (c, sums) in sums.iter().enumerate() {
                let rows = &mut self.target[c * self.stride + i..c * self.stride + i + step];
                let rows = R::registers_mut::<S>(rows);
                for (row, sum) in rows.iter_mut().zip(sums) {
                    *row = if REPLACES { R::negated(simd, *sum) } else { R::minus(simd, *row, *sum) };
                }
            }
            i += step;
        }
    }
}

/// Eliminates `n_columns` columns, those from `first` on of a panel; `block` starts with them.
struct Eliminate<'e, R> {
    block: &'e mut [R],
    stride: usize,
    first: usize,
    n_columns: usize,
}

impl<R: Real> WithSimd for Eliminate<'_, R> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let stride = self.stride;
        let step = 2 * R::lanes::<S>();
        for j in (0..self.n_columns).step_by(COLUMNS) {
            let row = self.first + j;
            let first = row / step * step;
            let (done, target) = self.block.split_at_mut(j * stride);
            let update = RankUpdate {
                target,
                stride,
                first,
                end: stride,
                sources: done,
                own: stride,
                n_sources: j,
                shift: 0,
                top: row,
            };
            update.run::<S, false>(simd);
            let columns = &mut self.block[j * stride..(j + COLUMNS) * stride];
            let width = COLUMNS.min(self.n_columns - j);
            let Some((lower, reciprocals)) = corner(columns, stride, row, width) else {
                return false;
            };
            divide(simd, columns, stride, first, &lower, &reciprocals);
            for (c, column) in lower.iter().enumerate().take(width) {
                columns[c * stride + row + c..c * stride + row + width].copy_from_slice(&column[c..width]);
            }
        }
        true
    }
}

/// `L` of the triangle at `row`, column by column, and the reciprocals of its diagonal;
/// the identity behind `width`.
#[inline(always)]
fn corner<R: Real>(
    columns: &[R],
    stride: usize,
    row: usize,
    width: usize,
) -> Option<([[R; COLUMNS]; COLUMNS], [R; COLUMNS])> {
    let (mut lower, mut reciprocals) = ([[R::ZERO; COLUMNS]; COLUMNS], [R::ONE; COLUMNS]);
    for j in 0..width {
        for i in j..width {
            let mut sum = columns[j * stride + row + i];
            for before in &lower[..j] {
                sum -= before[i] * before[j];
            }
            if i == j {
                if !(sum > R::ZERO && sum.is_number()) {
                    return None;
                }
                lower[j][j] = sum.root();
                reciprocals[j] = R::ONE / lower[j][j];
            } else {
                lower[j][i] = sum * reciprocals[j];
            }
        }
    }
    Some((lower, reciprocals))
}

/// The rows from `first` on of [`COLUMNS`] columns times the inverse transpose of a triangle.
#[inline(always)]
fn divide<S: Simd, R: Real>(
    simd: S,
    columns: &mut [R],
    stride: usize,
    first: usize,
    lower: &[[R; COLUMNS]; COLUMNS],
    reciprocals: &[R; COLUMNS],
) {
    for c in 0..COLUMNS {
        let (before, column) = columns.split_at_mut(c * stride);
        let column = R::registers_mut::<S>(&mut column[first..stride]);
        let scale = R::splat(simd, reciprocals[c]);
        let mut earlier: [&[R::Lanes<S>]; COLUMNS] = [&[]; COLUMNS];
        for b in 0..c {
            earlier[b] = &R::registers::<S>(&before[b * stride + first..(b + 1) * stride])[..column.len()];
        }
        for i in 0..column.len() {
            let mut x = column[i];
            for b in 0..c {
                x = R::minus_times(simd, earlier[b][i], R::splat(simd, lower[b][c]), x);
            }
            column[i] = R::times(simd, x, scale);
        }
    }
}

/// Writes what the `k` columns of a panel take off the `n` rows below, lower triangle.
struct TakeOff<'t, R> {
    update: &'t mut [R],
    stride: usize,
    n: usize,
    panel: &'t [R],
    own: usize,
    k: usize,
}

impl<R: Real> WithSimd for TakeOff<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let step = 2 * R::lanes::<S>();
        for t in (0..self.n).step_by(COLUMNS) {
            let update = RankUpdate {
                target: &mut self.update[t * self.stride..],
                stride: self.stride,
                first: t / step * step,
                end: self.n,
                sources: self.panel,
                own: self.own,
                n_sources: self.k,
                shift: self.k,
                top: self.k + t,
            };
            update.run::<S, true>(simd);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::padded::update_len;
    use super::*;

    /// A positive definite matrix of `m` rows.
    fn entry(i: usize, j: usize, m: usize) -> f64 {
        ((7 * i.max(j) + 3 * i.min(j)) as f64).sin() + if i == j { 2.0 * m as f64 } else { 0.0 }
    }

    /// `L Lᵀ` of the columns, plus what is left, is the matrix again, whatever the sizes.
    #[test]
    fn eliminated_columns_and_the_rest_are_the_matrix() {
        for (m, k) in
            [(1, 1), (2, 1), (5, 3), (8, 4), (16, 16), (23, 9), (40, 33), (150, 70), (600, 200), (530, 3)]
        {
            let (mut panel, mut update) = (Padded::default(), vec![f64::NAN; update_len(m - k)]);
            let stride = stride_of(m - k);
            panel.clear(m, k).unwrap();
            for j in 0..k {
                for i in j..m {
                    panel.values[j * panel.stride + i] = entry(i, j, m);
                }
            }
            let mut front = Front { panel: &mut panel, update: &mut update, n_rows: m, n_columns: k };
            assert!(front.eliminate(&Progress::new()).unwrap());
            for j in 0..m {
                for i in j..m {
                    let mut sum: f64 = (0..k.min(j + 1))
                        .map(|a| panel.values[a * panel.stride + i] * panel.values[a * panel.stride + j])
                        .sum();
                    if j >= k {
                        sum += update[(j - k) * stride + i - k];
                    }
                    let expected = if j < k { entry(i, j, m) } else { 0.0 };
                    let error = (sum - expected).abs();
                    assert!(error < 1e-12 * m as f64, "{m} rows, {k} columns, entry {i}, {j}: {error}");
                }
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_told() {
        for bad in [0, 3, 5, 66] {
            let (mut panel, mut update) = (Padded::default(), vec![0.0; update_len(3)]);
            panel.clear(70, 67).unwrap();
            for j in 0..67 {
                panel.values[j * panel.stride + j] = if j == bad { -1.0 } else { 1.0 };
            }
            let mut front = Front { panel: &mut panel, update: &mut update, n_rows: 70, n_columns: 67 };
            assert!(!front.eliminate(&Progress::new()).unwrap());
        }
    }
}
