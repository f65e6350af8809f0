//! Sparse Cholesky factorization: the one file that names the library that analyzes.
//!
//! Symbolic analysis once per pattern, numeric factorization as often as the values change, solves for
//! several right sides at once. Results do not depend on the number of threads.

use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw,
    SymmetricOrdering,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use faer::sparse::{FaerError, SymbolicSparseColMatRef};
use faer::Side;

use crate::error::SolveError;
use crate::linear::multifrontal::{self, Tree, Workspace};
use crate::linear::ordering::eliminated;
use crate::linear::pattern::LowerPattern;
use crate::linear::subtrees::Subtrees;
use crate::linear::triangular::{Panels, Values, LANES};
use crate::memory;

/// Neighboring supernodes of at most so many columns are joined while less than this part of the result is
/// zero. The library's own thresholds make one solve a tenth slower and the factorization no faster (measured
/// on 10k and 58k rows).
const RELAXATION: &[(usize, f64)] = &[(8, 0.3), (16, 0.1)];

/// A factorization whose pattern is analyzed once.
pub struct Cholesky {
    pattern: LowerPattern,
    panels: Panels,
    tree: Tree,
    subtrees: Subtrees,
    workspace: Workspace,
    /// The row of the matrix that each row of the factor stands for.
    order: Vec<u32>,
    factor: Vec<f64>,
    reciprocals: Vec<f64>,
    /// The right sides in the order of the factor, and room for a panel of them.
    rows: Vec<f64>,
    space: Vec<f64>,
    n_factorizations: usize,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky")
            .field("n", &self.pattern.n)
            .field("factor_len", &self.factor.len())
            .finish()
    }
}

impl Cholesky {
    /// Orders (approximate minimum degree, below nested dissection for large ones) and analyzes the pattern,
    /// for a factor and waiting updates of at most `memory_limit` bytes.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the factor is larger than that, or than what the system gives.
    pub fn analyze(pattern: LowerPattern, memory_limit: Option<usize>) -> Result<Self, SolveError> {
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
        let forward = eliminated(&pattern)?;
        let mut backward = memory::repeated(0, pattern.n)?;
        for (k, &i) in forward.iter().enumerate() {
            backward[i] = k;
        }
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &backward, pattern.n));
        let symbolic =
            factorize_symbolic_cholesky(view, Side::Lower, ordering, parameters).map_err(failed)?;
        let mut order = memory::room(pattern.n)?;
        order.extend(symbolic.perm().into_iter().flat_map(|p| p.arrays().0).map(|&i| i as u32));
        let panels = panels(&symbolic)?;
        let tree = Tree::new(&pattern, &order, &panels)?;
        let subtrees = Subtrees::new(&panels, &tree)?;
        let len = symbolic.len_val() + LANES;
        // Every further thread has about half as much waiting as the first (measured at 200k and 1M rows).
        let waiting = tree.most_waiting(&panels) * (rayon::current_num_threads() + 1) / 2;
        let needed = size_of::<f64>() * (len + waiting);
        let too_large = || SolveError::Memory { needed, limit: memory_limit };
        if needed > memory_limit.unwrap_or_else(|| memory::share_of_free(needed)) {
            return Err(too_large());
        }
        let mut factor = Vec::new();
        factor.try_reserve_exact(len).map_err(|_| too_large())?;
        // Asked for now, while it can still be refused, and given back until it is needed.
        Vec::<f64>::new().try_reserve_exact(waiting).map_err(|_| too_large())?;
        factor.resize(len, 0.0);
        let n = pattern.n;
        Ok(Self {
            pattern,
            panels,
            tree,
            subtrees,
            workspace: Workspace::default(),
            order,
            factor,
            reciprocals: memory::room(n)?,
            rows: Vec::new(),
            space: Vec::new(),
            n_factorizations: 0,
        })
    }

    /// The pattern that was analyzed.
    #[must_use]
    pub fn pattern(&self) -> &LowerPattern {
        &self.pattern
    }

    /// Numeric factorizations made so far.
    #[must_use]
    pub fn n_factorizations(&self) -> usize {
        self.n_factorizations
    }

    /// Entries of the factor.
    #[must_use]
    pub fn factor_len(&self) -> usize {
        self.factor.len() - LANES
    }

    /// Factors the matrix with these values (one per entry of the pattern).
    ///
    /// # Errors
    /// [`SolveError::Factorization`] when the matrix is not positive definite.
    pub fn factorize(&mut self, values: &[f64]) -> Result<(), SolveError> {
        self.n_factorizations += 1;
        multifrontal::factorize(&self.tree, &self.panels, values, &mut self.factor, &self.workspace)?;
        self.panels.reciprocals(&self.factor, &mut self.reciprocals);
        Ok(())
    }

    /// Solves in place for `K` right sides, with the last factorization. Rows of the matrix behind the last
    /// of `right` are zero on the right side, and what they are in the solution is left out.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve<const K: usize>(&mut self, right: &mut [[f64; K]]) -> Result<(), SolveError> {
        self.solve_columns::<K, K>(right)
    }

    /// [`Cholesky::solve`] for the first `A` of `K` right sides.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn solve_columns<const A: usize, const K: usize>(
        &mut self,
        right: &mut [[f64; K]],
    ) -> Result<(), SolveError> {
        memory::refill(&mut self.rows, 0.0, A * self.order.len())?;
        let (x, _) = self.rows.as_chunks_mut::<A>();
        for (x, &i) in x.iter_mut().zip(&self.order) {
            if let Some(right) = right.get(i as usize) {
                x.copy_from_slice(&right[..A]);
            }
        }
        let values = Values { panels: &self.factor, reciprocals: &self.reciprocals };
        self.subtrees.solve(&self.panels, values, x, &mut self.space)?;
        for (x, &i) in x.iter().zip(&self.order) {
            if let Some(right) = right.get_mut(i as usize) {
                right[..A].copy_from_slice(x);
            }
        }
        Ok(())
    }
}

/// The supernodes of the factor; a factor without any, of a matrix that is nearly diagonal,
/// has panels of one column.
///
/// # Errors
/// [`SolveError::Memory`].
fn panels(symbolic: &SymbolicCholesky<usize>) -> Result<Panels, SolveError> {
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
        let mut cholesky = Cholesky::analyze(pattern, None).unwrap();
        cholesky.factorize(&values).unwrap();
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
        let error = Cholesky::analyze(pattern.clone(), Some(10_000)).unwrap_err();
        let needed = match error {
            SolveError::Memory { needed, limit: Some(10_000) } => needed,
            _ => 0,
        };
        assert!(needed >= 8 * 200 * 201 / 2, "{needed}");
        assert!(error.to_string().contains("the limit of 0.01 MB; raise memory_limit"), "{error}");
        assert!(Cholesky::analyze(pattern, Some(needed)).is_ok());
    }

    #[test]
    fn refuses_a_matrix_that_is_not_positive_definite_and_recovers() {
        let (pattern, values) = matrix(20, 4);
        let mut cholesky = Cholesky::analyze(pattern.clone(), None).unwrap();
        assert!(cholesky.factorize(&values.iter().map(|v| -v).collect::<Vec<_>>()).is_err());
        cholesky.factorize(&values).unwrap();
        let mut right = times(&pattern, &values, &[[1.0]; 20]);
        cholesky.solve(&mut right).unwrap();
        assert!(right.iter().all(|[x]| (x - 1.0).abs() < 1e-13));
    }
}
