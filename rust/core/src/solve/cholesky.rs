//! Sparse Cholesky factorisation: the one file that names the library behind it.
//!
//! Symbolic analysis once per pattern, numeric factorisation as often as the values change, solves for several right
//! sides at once. Everything runs on the calling thread, so that results do not depend on the number of threads
//! (and three right sides solve faster that way: measured 6 × on two cores).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::solvers::{Llt, Solve};
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};

use crate::error::SolveError;

/// The lower triangle of a symmetric matrix, column by column with sorted rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LowerPattern {
    /// Number of rows and columns.
    pub n: usize,
    /// Column `j` owns the entries `starts[j]..starts[j + 1]`.
    pub starts: Vec<usize>,
    /// The row of each entry, `>= j`; the diagonal entry comes first.
    pub rows: Vec<usize>,
}

/// A factorisation whose pattern is analysed once.
pub struct Cholesky {
    pattern: LowerPattern,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
    n_factorisations: usize,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("n", &self.pattern.n).field("factor_len", &self.factor.len()).finish()
    }
}

impl Cholesky {
    /// Orders (approximate minimum degree) and analyses the pattern for solves with up to `n_right` right sides.
    ///
    /// # Errors
    /// [`SolveError::Factorisation`] when memory runs out.
    pub fn analyse(pattern: LowerPattern, n_right: usize) -> Result<Self, SolveError> {
        let failed = |e: &dyn std::fmt::Debug| SolveError::Factorisation { reason: format!("{e:?}") };
        let view = SymbolicSparseColMatRef::new_checked(pattern.n, pattern.n, &pattern.starts, None, &pattern.rows);
        let symbolic =
            factorize_symbolic_cholesky(view, Side::Lower, SymmetricOrdering::Amd, CholeskySymbolicParams::default())
                .map_err(|e| failed(&e))?;
        let scratch = symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(n_right.max(1), Par::Seq));
        let memory = MemBuffer::try_new(scratch).map_err(|e| failed(&e))?;
        let factor = vec![0.0; symbolic.len_val()];
        Ok(Self { pattern, symbolic, factor, memory, n_factorisations: 0 })
    }

    /// The pattern that was analysed.
    #[must_use]
    pub fn pattern(&self) -> &LowerPattern {
        &self.pattern
    }

    /// Numeric factorisations made so far.
    #[must_use]
    pub fn n_factorisations(&self) -> usize {
        self.n_factorisations
    }

    /// Entries of the factor.
    #[must_use]
    pub fn factor_len(&self) -> usize {
        self.factor.len()
    }

    /// Factors the matrix with these values (one per entry of the pattern).
    ///
    /// # Errors
    /// [`SolveError::Factorisation`] when the matrix is not positive definite.
    pub fn factorise(&mut self, values: &[f64]) -> Result<(), SolveError> {
        let p = &self.pattern;
        let view = SymbolicSparseColMatRef::new_checked(p.n, p.n, &p.starts, None, &p.rows);
        let matrix = SparseColMatRef::new(view, values);
        self.n_factorisations += 1;
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                faer::Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| SolveError::Factorisation {
                reason: "the matrix is not positive definite; fix more vertices or raise the fidelity".into(),
            })
    }

    /// Solves in place for `k` right sides stored column by column (`n × k`), with the last factorisation.
    pub fn solve(&mut self, right: &mut [f64], k: usize) {
        let factor = LltRef::new(&self.symbolic, &self.factor);
        let right = MatMut::from_column_major_slice_mut(right, self.pattern.n, k);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, MemStack::new(&mut self.memory));
    }
}

/// The factorisation of a small dense matrix.
#[derive(Debug)]
pub struct DenseCholesky {
    factor: Llt<f64>,
}

impl DenseCholesky {
    /// Factors the lower triangle of a `p × p` matrix stored column by column; `None` when it is not clearly positive
    /// definite: a pivot under 1e-12 of its diagonal entry is lost to rounding.
    #[must_use]
    pub fn new(matrix: &[f64], p: usize) -> Option<Self> {
        let matrix = MatRef::from_column_major_slice(matrix, p, p);
        let factor = Llt::new(matrix, Side::Lower).ok()?;
        let lower = factor.L();
        let sound = (0..p).all(|i| lower[(i, i)] * lower[(i, i)] > 1e-12 * matrix[(i, i)]);
        sound.then_some(Self { factor })
    }

    /// Solves in place for `K` right sides stored row by row.
    pub fn solve<const K: usize>(&self, right: &mut [[f64; K]]) {
        let mut dense = Mat::from_fn(right.len(), K, |i, c| right[i][c]);
        self.factor.solve_in_place(&mut dense);
        for (i, row) in right.iter_mut().enumerate() {
            for (c, x) in row.iter_mut().enumerate() {
                *x = dense[(i, c)];
            }
        }
    }
}
