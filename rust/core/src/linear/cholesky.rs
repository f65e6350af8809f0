//! Sparse Cholesky factorization: the one file that names the library that analyzes.
//!
//! Symbolic analysis once per pattern, numeric factorization as often as the values change, solves for
//! several right sides at once, in double or in single precision. Results do not depend on the number of
//! threads.

use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw,
    SymmetricOrdering,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use faer::sparse::{FaerError, SymbolicSparseColMatRef};
use faer::Side;

use crate::error::SolveError;
use crate::linear::factor::Factor;
use crate::linear::multifrontal::Tree;
use crate::linear::ordering::eliminated;
use crate::linear::pattern::LowerPattern;
use crate::linear::subtrees::Subtrees;
use crate::linear::triangular::Panels;
use crate::{memory, Progress, Result};

/// Neighboring supernodes of at most so many columns are joined while less than this part of the result is
/// zero. The library's own thresholds make one solve a tenth slower and the factorization no faster (measured
/// on 10k and 58k rows).
const RELAXATION: &[(usize, f64)] = &[(8, 0.3), (16, 0.1)];

/// How many digits a factor has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Sixteen.
    Double,
    /// Seven: half the memory and half the time of a large factor. What a solution is off by is a part of the
    /// right side that grows with how unlike the matrix's eigenvalues are.
    Single,
}

impl Precision {
    /// Bytes of a number.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::Double => size_of::<f64>(),
            Self::Single => size_of::<f32>(),
        }
    }
}

/// The factor in one of its precisions.
#[derive(Debug)]
enum Numbers {
    Double(Factor<f64>),
    Single(Factor<f32>),
}

/// A factorization whose pattern is analyzed once.
pub struct Cholesky {
    n: usize,
    panels: Panels,
    tree: Tree,
    subtrees: Subtrees,
    /// The row of the matrix that each row of the factor stands for.
    order: Vec<u32>,
    numbers: Numbers,
    /// Entries of the factor.
    factor_len: usize,
    memory_limit: Option<usize>,
    n_factorizations: usize,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("n", &self.n).field("factor_len", &self.factor_len).finish()
    }
}

impl Cholesky {
    /// Orders (approximate minimum degree, below nested dissection for large ones) and analyzes the pattern,
    /// for a factor and waiting updates of at most `memory_limit` bytes.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the factor is larger than that, or than what the system gives;
    /// [`crate::Error::Cancelled`].
    pub fn analyze(pattern: &LowerPattern, memory_limit: Option<usize>, progress: &Progress) -> Result<Self> {
        Self::analyze_in(Precision::Double, pattern, memory_limit, progress)
    }

    /// [`Cholesky::analyze`] for a factor in this precision.
    ///
    /// # Errors
    /// As there.
    pub fn analyze_in(
        precision: Precision,
        pattern: &LowerPattern,
        memory_limit: Option<usize>,
        progress: &Progress,
    ) -> Result<Self> {
        let failed = |error| match error {
            // What it asked for it does not say: of what it makes, the factor's pattern is the largest.
            FaerError::OutOfMemory => {
                SolveError::Memory { needed: size_of::<usize>() * pattern.rows.len(), limit: memory_limit }
            }
            other => SolveError::Factorization { reason: format!("{other:?}") },
        };
        let view =
            SymbolicSparseColMatRef::new_checked(pattern.n, pattern.n, &pattern.starts, None, &pattern.rows);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            supernodal_params: SymbolicSupernodalParams { relax: Some(RELAXATION) },
            ..CholeskySymbolicParams::default()
        };
        let forward = eliminated(pattern, progress)?;
        let mut backward = memory::repeated(0, pattern.n)?;
        for (k, &i) in forward.iter().enumerate() {
            backward[i] = k;
        }
        progress.check()?;
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &backward, pattern.n));
        let symbolic =
            factorize_symbolic_cholesky(view, Side::Lower, ordering, parameters).map_err(failed)?;
        progress.check()?;
        let mut order = memory::room(pattern.n)?;
        order.extend(symbolic.perm().into_iter().flat_map(|p| p.arrays().0).map(|&i| i as u32));
        let mut panels = panels(&symbolic)?;
        progress.check()?;
        let tree = Tree::new(pattern, &order, &panels)?;
        progress.check()?;
        let subtrees = Subtrees::new(&mut panels, &tree)?;
        let factor_len = symbolic.len_val();
        drop(symbolic);
        let numbers = room(precision, factor_len, &tree, &panels, memory_limit)?;
        Ok(Self {
            n: pattern.n,
            panels,
            tree,
            subtrees,
            order,
            numbers,
            factor_len,
            memory_limit,
            n_factorizations: 0,
        })
    }

    /// How many digits the factor has.
    #[must_use]
    pub fn precision(&self) -> Precision {
        match self.numbers {
            Numbers::Double(_) => Precision::Double,
            Numbers::Single(_) => Precision::Single,
        }
    }

    /// The next factorizations have a factor in this precision; one in another is forgotten.
    ///
    /// # Errors
    /// [`SolveError::Memory`], as in [`Cholesky::analyze`].
    pub fn set_precision(&mut self, precision: Precision) -> std::result::Result<(), SolveError> {
        if self.precision() != precision {
            // The old one goes before the new one comes.
            self.numbers = Numbers::Single(Factor::new(0, 0)?);
            self.numbers = room(precision, self.factor_len, &self.tree, &self.panels, self.memory_limit)?;
        }
        Ok(())
    }

    /// Rows of the matrix.
    #[must_use]
    pub fn n(&self) -> usize {
        self.n
    }

    /// Numeric factorizations made so far.
    #[must_use]
    pub fn n_factorizations(&self) -> usize {
        self.n_factorizations
    }

    /// Entries of the factor.
    #[must_use]
    pub fn factor_len(&self) -> usize {
        self.factor_len
    }

    /// Factors the matrix with these values (one per entry of the pattern).
    ///
    /// # Errors
    /// [`SolveError::Factorization`] when the matrix is not positive definite, in single precision also when
    /// it nearly is not. [`crate::Error::Cancelled`]: there is no factor then.
    pub fn factorize(&mut self, values: &[f64], progress: &Progress) -> Result<()> {
        self.n_factorizations += 1;
        match &mut self.numbers {
            Numbers::Double(factor) => factor.factorize(&self.tree, &self.panels, values, progress),
            Numbers::Single(factor) => factor.factorize(&self.tree, &self.panels, values, progress),
        }
    }

    /// Solves in place for `K` right sides, with the last factorization. Rows of the matrix behind the last
    /// of `right` are zero on the right side, and what they are in the solution is left out.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve<const K: usize>(&mut self, right: &mut [[f64; K]]) -> std::result::Result<(), SolveError> {
        self.solve_columns::<K, K>(right)
    }

    /// [`Cholesky::solve`] for the first `A` of `K` right sides.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve_columns<const A: usize, const K: usize>(
        &mut self,
        right: &mut [[f64; K]],
    ) -> std::result::Result<(), SolveError> {
        let (panels, subtrees, order) = (&self.panels, &self.subtrees, &self.order);
        match &mut self.numbers {
            Numbers::Double(factor) => factor.solve::<A, K>(panels, subtrees, order, right),
            Numbers::Single(factor) => factor.solve::<A, K>(panels, subtrees, order, right),
        }
    }
}

/// Room for a factor of so many entries and for the updates that wait while it is made.
///
/// # Errors
/// [`SolveError::Memory`] when that is more than `memory_limit` bytes, or than what the system gives.
fn room(
    precision: Precision,
    len: usize,
    tree: &Tree,
    panels: &Panels,
    memory_limit: Option<usize>,
) -> std::result::Result<Numbers, SolveError> {
    let size = precision.size();
    // Every further thread has about half as much waiting as the first (measured at 200k and 1M rows).
    let waiting = size * (tree.most_waiting(panels) * (rayon::current_num_threads() + 1) / 2);
    let needed = size * len + waiting;
    let too_large = || SolveError::Memory { needed, limit: memory_limit };
    if needed > memory_limit.unwrap_or_else(|| memory::share_of_free(needed)) {
        return Err(too_large());
    }
    let n = panels.begin.last().copied().unwrap_or(0);
    let numbers = match precision {
        Precision::Double => Factor::new(len, n).map(Numbers::Double),
        Precision::Single => Factor::new(len, n).map(Numbers::Single),
    };
    let numbers = numbers.map_err(|_| too_large())?;
    // Asked for now, while it can still be refused, and given back until it is needed.
    Vec::<u8>::new().try_reserve_exact(waiting).map_err(|_| too_large())?;
    Ok(numbers)
}

/// The supernodes of the factor; a factor without any, of a matrix that is nearly diagonal,
/// has panels of one column.
///
/// # Errors
/// [`SolveError::Memory`].
fn panels(symbolic: &SymbolicCholesky<usize>) -> std::result::Result<Panels, SolveError> {
    let mut panels = Panels::default();
    let push = |panels: &mut Panels, begin: usize, below: &[usize]| {
        panels.begin.push(begin);
        panels.rows.extend(below.iter().map(|&row| row as u32));
        panels.below.push(panels.rows.len());
    };
    match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(factor) => {
            let len = (0..factor.n_supernodes()).map(|s| factor.supernode(s).pattern().len()).sum();
            panels.rows = memory::room(len)?;
            panels.begin = memory::room(factor.n_supernodes() + 1)?;
            panels.below = memory::room(factor.n_supernodes() + 1)?;
            panels.below.push(0);
            for s in 0..factor.n_supernodes() {
                let supernode = factor.supernode(s);
                push(&mut panels, supernode.start(), supernode.pattern());
            }
            panels.values = memory::twin(factor.col_ptr_for_val())?;
        }
        SymbolicCholeskyRaw::Simplicial(factor) => {
            panels.rows = memory::room(factor.row_idx().len())?;
            panels.begin = memory::room(factor.col_ptr().len())?;
            panels.below = memory::room(factor.col_ptr().len())?;
            panels.below.push(0);
            for (j, bounds) in factor.col_ptr().windows(2).enumerate() {
                // The diagonal entry comes first.
                push(&mut panels, j, &factor.row_idx()[bounds[0] + 1..bounds[1]]);
            }
            panels.values = memory::twin(factor.col_ptr())?;
        }
    }
    panels.begin.push(symbolic.ncols());
    Ok(panels)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Error;

    /// A diagonally dominant matrix with wide panels: `n` rows,
    /// entries up to `band` off the diagonal and in the last rows.
    fn matrix(n: usize, band: usize) -> (LowerPattern, Vec<f64>) {
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            for i in (j..n).filter(|i| i - j <= band || i + 3 >= n) {
                rows.push(i);
                let entry = ((7 * i + 3 * j) as f64).sin();
                values.push(if i == j { 4.0 * n as f64 } else { entry });
            }
            starts.push(rows.len());
        }
        (LowerPattern { n, starts, rows }, values)
    }

    fn times<const K: usize>(pattern: &LowerPattern, values: &[f64], x: &[[f64; K]]) -> Vec<[f64; K]> {
        let mut out = vec![[0.0; K]; pattern.n];
        for j in 0..pattern.n {
            let column = pattern.starts[j]..pattern.starts[j + 1];
            for (&i, value) in pattern.rows[column.clone()].iter().zip(&values[column]) {
                for c in 0..K {
                    out[i][c] += value * x[j][c];
                    if i != j {
                        out[j][c] += value * x[i][c];
                    }
                }
            }
        }
        out
    }

    fn check_solves<const A: usize, const K: usize>(n: usize, band: usize) {
        let (pattern, values) = matrix(n, band);
        let x: Vec<[f64; K]> =
            (0..n).map(|i| std::array::from_fn(|c| (i as f64 + 0.3 * c as f64).cos())).collect();
        let right = times(&pattern, &values, &x);
        let mut cholesky = Cholesky::analyze(&pattern, None, &Progress::new()).unwrap();
        cholesky.factorize(&values, &Progress::new()).unwrap();
        let mut solution = right.clone();
        cholesky.solve_columns::<A, K>(&mut solution).unwrap();
        for i in 0..n {
            for c in 0..K {
                let expected = if c < A { x[i][c] } else { right[i][c] };
                assert!(
                    (solution[i][c] - expected).abs() < 1e-12,
                    "{n} rows, band {band}, row {i}, column {c} of {K}"
                );
            }
        }
    }

    #[test]
    fn solves_whatever_the_size_of_the_panels() {
        for n in [1, 2, 3, 4, 5, 7, 8, 9, 17, 40, 101] {
            for band in [0, 1, 3, 6, 12, 50] {
                check_solves::<1, 1>(n, band);
                check_solves::<2, 2>(n, band);
                check_solves::<3, 4>(n, band);
                check_solves::<16, 16>(n, band);
            }
        }
    }

    #[test]
    fn refuses_a_factor_that_is_larger_than_the_limit_and_says_how_large() {
        let (pattern, _) = matrix(200, 199);
        let error = Cholesky::analyze(&pattern, Some(10_000), &Progress::new()).unwrap_err();
        let needed = match error {
            Error::Solve(SolveError::Memory { needed, limit: Some(10_000) }) => needed,
            _ => 0,
        };
        assert!(needed >= 8 * 200 * 201 / 2, "{needed}");
        assert!(error.to_string().contains("the limit of 0.01 MB; raise memory_limit"), "{error}");
        assert!(Cholesky::analyze(&pattern, Some(needed), &Progress::new()).is_ok());
    }

    #[test]
    fn refuses_a_matrix_that_is_not_positive_definite_and_recovers() {
        let (pattern, values) = matrix(20, 4);
        let mut cholesky = Cholesky::analyze(&pattern, None, &Progress::new()).unwrap();
        let negative: Vec<f64> = values.iter().map(|v| -v).collect();
        assert!(cholesky.factorize(&negative, &Progress::new()).is_err());
        cholesky.factorize(&values, &Progress::new()).unwrap();
        let mut right = times(&pattern, &values, &[[1.0]; 20]);
        cholesky.solve(&mut right).unwrap();
        assert!(right.iter().all(|[x]| (x - 1.0).abs() < 1e-13));
    }
}
