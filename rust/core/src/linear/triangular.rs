//! Triangular solves with a supernodal Cholesky factor, for a few right sides at once.
//!
//! A general dense kernel spends most of its time on packing when a panel has a handful of columns and there
//! are three right sides. Here four columns of a panel at a time are applied to one right side after the
//! other, straight from the factor.

use pulp::Simd;

use crate::linear::real::Real;

/// Columns of a panel that are applied together: fewer passes over the right sides,
/// few enough for the registers.
const COLUMNS: usize = 4;

/// Sums that are carried along together: one alone waits for itself,
/// more than these do not fit the registers.
const ACCUMULATORS: usize = 12;

/// The most numbers in a vector register. Columns are read in whole registers, past their end: what stands
/// there meets only padding.
pub(super) const LANES: usize = 8;

/// The structure of a factor `L` by supernodes: columns with the same pattern,
/// stored as one dense panel each.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    /// The first column of each panel, and the number of columns at the end.
    pub begin: Vec<usize>,
    /// Where the values of each panel start: column by column, the rows of the triangle first.
    pub values: Vec<usize>,
    /// Where the rows below the triangle of each panel start in `rows`.
    pub below: Vec<usize>,
    /// The rows below the triangles, in the numbers that subtrees give them.
    pub rows: Vec<u32>,
}

/// The numbers of a factor.
#[derive(Debug, Clone, Copy)]
pub(super) struct Values<'v, R> {
    /// The panels, one after the other, and [`LANES`] zeros.
    pub panels: &'v [R],
    /// The reciprocal of each diagonal entry: divisions would be half the time.
    pub reciprocals: &'v [R],
}

/// One panel with its values.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel<'p, R> {
    begin: usize,
    n_columns: usize,
    below: &'p [u32],
    values: &'p [R],
    reciprocals: &'p [R],
}

impl Panels {
    /// Panel `s` with its values.
    #[inline(always)]
    #[must_use]
    pub(super) fn panel<'p, R: Real>(&'p self, s: usize, values: Values<'p, R>) -> Panel<'p, R> {
        let (begin, end) = (self.begin[s], self.begin[s + 1]);
        Panel {
            begin,
            n_columns: end - begin,
            below: &self.rows[self.below[s]..self.below[s + 1]],
            values: &values.panels[self.values[s]..self.values[s + 1] + LANES],
            reciprocals: &values.reciprocals[begin..end],
        }
    }

    /// The most rows that a panel has.
    #[must_use]
    pub(super) fn longest(&self) -> usize {
        (0..self.count()).map(|s| self.n_rows(s)).max().unwrap_or(0)
    }

    /// Rows of a panel.
    #[inline(always)]
    #[must_use]
    pub(super) fn n_rows(&self, s: usize) -> usize {
        self.begin[s + 1] - self.begin[s] + self.below[s + 1] - self.below[s]
    }

    /// The reciprocals of the diagonal of the factor with these values.
    pub(super) fn reciprocals<R: Real>(&self, values: &[R], out: &mut Vec<R>) {
        out.clear();
        for s in 0..self.count() {
            let n_columns = self.begin[s + 1] - self.begin[s];
            let n_rows = n_columns + self.below[s + 1] - self.below[s];
            out.extend((0..n_columns).map(|j| R::ONE / values[self.values[s] + j * n_rows + j]));
        }
    }

    /// Number of panels.
    #[must_use]
    pub(super) fn count(&self) -> usize {
        self.begin.len().saturating_sub(1)
    }

    /// The rows below the triangle of a panel.
    #[inline(always)]
    #[must_use]
    pub(super) fn below(&self, s: usize) -> &[u32] {
        &self.rows[self.below[s]..self.below[s + 1]]
    }

    /// Multiplications that eliminating the columns of a panel takes.
    #[must_use]
    pub(super) fn multiplications(&self, s: usize) -> f64 {
        let (k, below) = (self.begin[s + 1] - self.begin[s], self.below(s).len());
        (0..k).map(|j| ((k - j + below) as f64).powi(2)).sum::<f64>() / 2.0
    }
}

impl<R: Real> Panel<'_, R> {
    /// The same panel with another number for its first row.
    #[inline(always)]
    #[must_use]
    pub(super) fn beginning(self, begin: usize) -> Self {
        Self { begin, ..self }
    }
}

impl<R: Real> Panel<'_, R> {
    #[inline(always)]
    fn n_rows(&self) -> usize {
        self.n_columns + self.below.len()
    }

    /// The stretch of working space that a right side takes: its rows, and zeros to fill the last register.
    #[inline(always)]
    fn stride(&self) -> usize {
        self.n_rows() + LANES
    }

    /// Column `j` from row `from` on, in registers.
    #[inline(always)]
    fn column<S: Simd>(&self, j: usize, from: usize) -> &[R::Lanes<S>] {
        let n = self.n_rows();
        let lanes = R::lanes::<S>();
        let registers = (n - from).div_ceil(lanes);
        R::registers::<S>(&self.values[j * n + from..j * n + from + registers * lanes])
    }

    /// The rows of this panel's triangle, right side by right side, and zeros behind the rows below.
    #[inline(always)]
    fn load<const K: usize>(&self, x: &[[R; K]], space: &mut [R]) {
        let (n, stride) = (self.n_rows(), self.stride());
        for (i, x) in x[self.begin..self.begin + self.n_columns].iter().enumerate() {
            for c in 0..K {
                space[c * stride + i] = x[c];
            }
        }
        for c in 0..K {
            space[c * stride + n..(c + 1) * stride].fill(R::ZERO);
        }
    }

    #[inline(always)]
    fn store<const K: usize>(&self, x: &mut [[R; K]], space: &[R]) {
        for (i, x) in x[self.begin..self.begin + self.n_columns].iter_mut().enumerate() {
            *x = std::array::from_fn(|c| space[c * self.stride() + i]);
        }
    }

    /// `x ← L⁻¹x` for the columns of this panel, and what that does to the rows below.
    #[inline(always)]
    pub(super) fn forward<S: Simd, const K: usize>(&self, simd: S, x: &mut [[R; K]], space: &mut [R]) {
        let (stride, s) = (self.stride(), self.n_columns);
        self.load(x, space);
        for c in 0..K {
            space[c * stride + s..(c + 1) * stride].fill(R::ZERO);
        }
        let mut j = 0;
        while j + COLUMNS <= s {
            self.eliminate::<S, COLUMNS, K>(simd, j, space);
            j += COLUMNS;
        }
        while j < s {
            self.eliminate::<S, 1, K>(simd, j, space);
            j += 1;
        }
        self.store(x, space);
        for (i, &row) in self.below.iter().enumerate() {
            let x = &mut x[row as usize];
            for c in 0..K {
                x[c] += space[c * stride + s + i];
            }
        }
    }

    /// Solves for the rows `j..j + J` and takes their columns off the rows below.
    #[inline(always)]
    fn eliminate<S: Simd, const J: usize, const K: usize>(&self, simd: S, j: usize, space: &mut [R]) {
        let (n, stride) = (self.n_rows(), self.stride());
        let mut columns: [&[R::Lanes<S>]; J] = [&[]; J];
        for (a, column) in columns.iter_mut().enumerate() {
            *column = self.column::<S>(j + a, j + J);
        }
        for c in 0..K {
            let (top, below) = space[c * stride + j..(c + 1) * stride].split_at_mut(J);
            for a in 0..J {
                let column = &self.values[(j + a) * n + j..(j + a) * n + j + J];
                top[a] *= self.reciprocals[j + a];
                for b in a + 1..J {
                    top[b] -= column[b] * top[a];
                }
            }
            subtract(simd, columns, top, below);
        }
    }

    /// `x ← L⁻ᵀx` for the columns of this panel, from the rows below.
    #[inline(always)]
    pub(super) fn backward<S: Simd, const K: usize>(&self, simd: S, x: &mut [[R; K]], space: &mut [R]) {
        let (stride, s) = (self.stride(), self.n_columns);
        self.load(x, space);
        for (i, &row) in self.below.iter().enumerate() {
            let x = &x[row as usize];
            for c in 0..K {
                space[c * stride + s + i] = x[c];
            }
        }
        let mut j = s;
        while j % COLUMNS != 0 {
            j -= 1;
            self.substitute::<S, 1, K>(simd, j, space);
        }
        while j > 0 {
            j -= COLUMNS;
            self.substitute::<S, COLUMNS, K>(simd, j, space);
        }
        self.store(x, space);
    }

    /// Solves for the rows `j..j + J` when all below are known.
    #[inline(always)]
    fn substitute<S: Simd, const J: usize, const K: usize>(&self, simd: S, j: usize, space: &mut [R]) {
        let (n, stride) = (self.n_rows(), self.stride());
        let mut right: [&[R]; K] = [&[]; K];
        for (c, right) in right.iter_mut().enumerate() {
            *right = &space[c * stride + j + J..(c + 1) * stride];
        }
        let mut columns: [&[R::Lanes<S>]; J] = [&[]; J];
        for (a, column) in columns.iter_mut().enumerate() {
            *column = self.column::<S>(j + a, j + J);
        }
        let mut sums = [[R::ZERO; K]; J];
        if J * K <= ACCUMULATORS {
            sums = products(simd, columns, right);
        } else {
            for (sums, &column) in sums.iter_mut().zip(&columns) {
                [*sums] = products(simd, [column], right);
            }
        }
        for c in 0..K {
            let top = &mut space[c * stride + j..c * stride + j + J];
            for a in (0..J).rev() {
                let column = &self.values[(j + a) * n + j..(j + a) * n + j + J];
                let mut x: R = top[a] - sums[a][c];
                for b in a + 1..J {
                    x -= column[b] * top[b];
                }
                top[a] = x * self.reciprocals[j + a];
            }
        }
    }
}

/// `t -= Σ columns[j] x[j]`.
#[inline(always)]
fn subtract<S: Simd, R: Real, const J: usize>(simd: S, columns: [&[R::Lanes<S>]; J], x: &[R], t: &mut [R]) {
    let t = R::registers_mut::<S>(t);
    let n = columns[0].len();
    let t = &mut t[..n];
    let mut splats = [R::splat(simd, R::ZERO); J];
    let mut shorter = columns;
    for j in 0..J {
        splats[j] = R::splat(simd, x[j]);
        shorter[j] = &columns[j][..n];
    }
    for (i, t) in t.iter_mut().enumerate() {
        let mut sum = *t;
        for j in 0..J {
            sum = R::minus_times(simd, shorter[j][i], splats[j], sum);
        }
        *t = sum;
    }
}

/// `⟨column, t⟩` for every column and every `t`.
#[inline(always)]
fn products<S: Simd, R: Real, const J: usize, const K: usize>(
    simd: S,
    columns: [&[R::Lanes<S>]; J],
    t: [&[R]; K],
) -> [[R; K]; J] {
    let n = columns[0].len();
    let mut left: [&[R::Lanes<S>]; J] = [&[]; J];
    for j in 0..J {
        left[j] = &columns[j][..n];
    }
    let mut right: [&[R::Lanes<S>]; K] = [&[]; K];
    for c in 0..K {
        right[c] = &R::registers::<S>(t[c])[..n];
    }
    let mut sums = [[R::splat(simd, R::ZERO); K]; J];
    for i in 0..n {
        for j in 0..J {
            for c in 0..K {
                sums[j][c] = R::times_plus(simd, left[j][i], right[c][i], sums[j][c]);
            }
        }
    }
    sums.map(|sums| sums.map(|sum| R::sum(simd, sum)))
}
