//! The smallest eigenpairs of a quadratic energy against a mass, by inverse iteration on a subspace.

use crate::block_rows::BlockRows;
use crate::error::SolveError;
use crate::linear::cholesky::Cholesky;
use crate::linear::small::symmetric_eigen;
use crate::linear::Columns;
use crate::progress::Progress;
use crate::solve::normal_matrix::NormalMatrix;
use crate::{memory, Error, Result};

/// Vectors that one triangular solve takes: a vector register's worth.
const AT_ONCE: usize = 4;

/// Vectors in the subspace beyond those asked for: as many again and some;
/// modes of a surface then converge by 4 to 10 a round.
const SPARE: usize = 8;

/// On meshes with slivers rounding in the factor ends the convergence before that; below this residual it is
/// taken for the end when it has not halved for so many rounds.
const ACCURACY_OF_ROUNDING: f64 = 1e-4;
const ROUNDS_AT_REST: usize = 5;

/// Rounds at most; modes of meshes take 10 to 30.
const MOST_ROUNDS: usize = 300;

/// Rounds after which solutions are refined, in case it is rounding that holds modes up, and the subspace
/// takes in those of the two rounds before (locally optimal block conjugate gradients, Knyazev 2001), in case
/// others have nearly their energy. Rings of 2,000 edges and more around a hole and double cones of 8,000 had
/// not settled after 300 rounds; with both they take 45 to 180.
const PLAIN_ROUNDS: usize = 40;

/// What is left of a vector of length 1 beside others that counts as a direction of its own.
const INDEPENDENT: f64 = 1e-6;

/// Passes of Gram and Schmidt at most; two are usual, and what is left of rounding takes three.
const MOST_PASSES: usize = 16;

/// The shift as a part of the scale of eigenvalues: small against them, large against rounding.
///
/// Where even the largest value of the subspace is below the shift, all of them look alike, and a round gains
/// less than half: the shift is then this part of that value. The energies of a ring around a hole fall with
/// the square of its edges: L1 modes of rings of 2,000, 4,000, and 8,000 take 0.2, 0.4, and 0.5 s, and took
/// 0.8, 4.7, and 16.8.
const SHIFT: f64 = 0.1;

/// How often the shift grows tenfold while the shifted matrix is not positive definite.
const SHIFT_ATTEMPTS: usize = 8;

/// Eigenpairs, ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigenpairs {
    /// The eigenvalues.
    pub values: Vec<f64>,
    /// The eigenvectors, orthonormal with respect to the mass; zero where there is no mass.
    pub vectors: Columns,
}

/// `uᵀ Q u = Σ_b weights_b ‖(H u)_b‖²` against `uᵀ M u`.
#[derive(Debug, Clone, Copy)]
pub struct Pencil<'a> {
    /// `H`.
    pub operator: &'a BlockRows,
    /// One per block; they may be negative.
    pub weights: &'a [f64],
    /// The diagonal of `M`; rows without mass take no part.
    pub mass: &'a [f64],
    /// About how large the smallest positive eigenvalues are.
    pub scale: f64,
    /// The residual `‖(Q + σM)⁻¹ M u − ρ u‖ / ρ` of a vector that is done.
    pub accuracy: f64,
    /// The most bytes that the factor may take.
    pub memory_limit: Option<usize>,
}

impl Pencil<'_> {
    /// The `count` smallest eigenvalues of `Q u = λ M u` and their vectors, Rowe et al. 2024, eq. (38)
    /// without its L1 norm; `count` must not exceed the rows with mass.
    ///
    /// The first rows of the start are a fixed sequence, so that the same input gives the same bits.
    ///
    /// # Errors
    /// [`SolveError`] when the matrix cannot be factored or the iteration does not settle;
    /// [`Error::Cancelled`].
    pub fn smallest(&self, count: usize, progress: &Progress) -> Result<Eigenpairs> {
        let n = self.mass.len();
        let massive = self.mass.iter().filter(|m| **m > 0.0).count();
        let size = massive.min(2 * count + SPARE);
        let mut shifted = self.analyzed(progress)?;
        let mut wanted_shift = SHIFT * self.scale;
        shifted.factorize(self, wanted_shift, progress)?;
        let first = |j: usize| {
            let step = (j as f64 + 2.5).sqrt();
            let entry = |i: usize| ((i + 1) as f64 * step).fract() - 0.5;
            memory::gathered((0..n).map(|i| if self.mass[i] > 0.0 { entry(i) } else { 0.0 }))
        };
        let mut block: Vec<Vec<f64>> = (0..size).map(first).collect::<std::result::Result<_, _>>()?;
        block[0].iter_mut().zip(self.mass).for_each(|(x, m)| *x = if *m > 0.0 { 1.0 } else { 0.0 });
        let (mut values, mut before) = (Vec::new(), Vec::new());
        let (mut best, mut at_rest) = (f64::INFINITY, 0);
        for round in 0..MOST_ROUNDS {
            progress.check()?;
            let mut next: Vec<Vec<f64>> =
                block.iter().map(|x| memory::twin(x)).collect::<std::result::Result<_, _>>()?;
            for group in next.chunks_mut(AT_ONCE) {
                let row =
                    |i: usize| std::array::from_fn(|c| group.get(c).map_or(0.0, |x| self.mass[i] * x[i]));
                // Zeros for the unknowns between pieces of blocks.
                let mut right = memory::repeated([0.0; AT_ONCE], shifted.cholesky.n())?;
                right.iter_mut().zip((0..n).map(row)).for_each(|(right, row)| *right = row);
                let wanted = (round >= PLAIN_ROUNDS).then(|| memory::twin(&right)).transpose()?;
                shifted.cholesky.solve(&mut right)?;
                if let Some(mut left) = wanted {
                    self.subtract_shifted(shifted.shift, &right, group.len(), &mut left)?;
                    shifted.cholesky.solve(&mut left)?;
                    for (x, more) in right.iter_mut().zip(&left) {
                        *x = std::array::from_fn(|c| x[c] + more[c]);
                    }
                }
                for (c, x) in group.iter_mut().enumerate() {
                    x.iter_mut().zip(&right).for_each(|(x, row)| *x = row[c]);
                }
            }
            let residual =
                block[..count].iter().zip(&next).map(|(x, y)| self.residual(x, y)).fold(0.0, f64::max);
            at_rest = if residual < 0.5 * best { 0 } else { at_rest + 1 };
            best = if at_rest == 0 { residual } else { best };
            let settled =
                residual <= self.accuracy || best <= ACCURACY_OF_ROUNDING && at_rest >= ROUNDS_AT_REST;
            if round > 0 && settled {
                values.truncate(count);
                let vectors = Columns { n_rows: n, n_columns: count, data: block[..count].concat() };
                return Ok(Eigenpairs { values, vectors });
            }
            self.orthonormalize(&mut next)?;
            if round >= PLAIN_ROUNDS {
                for x in block.iter().chain(&before) {
                    self.add_independent(&mut next, memory::twin(x)?)?;
                }
            }
            let images: Vec<Vec<f64>> = next.iter().map(|x| self.times(x)).collect::<Result<_>>()?;
            let projected = images.iter().map(|y| next.iter().map(|x| dot(x, y)).collect()).collect();
            let (found, mut rotation) = symmetric_eigen(projected);
            rotation.truncate(size);
            values = found;
            before = std::mem::replace(&mut block, combined(&next, &rotation)?);
            let largest = values[size - 1];
            if at_rest > 0 && wanted_shift > 0.0 && largest < wanted_shift {
                let is_lower = shifted.lower(self, SHIFT * largest, progress)?;
                wanted_shift = if is_lower { SHIFT * largest } else { 0.0 };
                (best, at_rest) = (f64::INFINITY, 0);
            }
        }
        let reason = format!(
            "{count} modes did not settle in {MOST_ROUNDS} rounds; flip slivers away (delaunay), merge close \
            vertices, or \
             ask for fewer"
        );
        Err(Error::Solve(SolveError::Factorization { reason }))
    }

    /// The pattern of `Q + σM`, analyzed.
    fn analyzed(&self, progress: &Progress) -> Result<Shifted> {
        // A cut block with a negative weight makes any matrix one that is not definite.
        let negative = self.weights.iter().any(|w| *w < 0.0);
        let normal = if negative {
            NormalMatrix::new(self.operator)?
        } else {
            NormalMatrix::stretched(self.operator, progress)?
        };
        let cholesky = Cholesky::analyze(normal.pattern(), self.memory_limit, progress)?;
        Ok(Shifted { values: memory::room(normal.pattern().rows.len())?, normal, cholesky, shift: 0.0 })
    }

    /// Subtracts `(Q + σM) x` from the first rows of `left`, for so many columns of `x`.
    fn subtract_shifted(
        &self,
        shift: f64,
        x: &[[f64; AT_ONCE]],
        n_columns: usize,
        left: &mut [[f64; AT_ONCE]],
    ) -> Result<()> {
        let rows = || x.iter().zip(self.mass);
        for c in 0..n_columns {
            let column: Vec<f64> = memory::gathered(rows().map(|(row, _)| row[c]))?;
            let image = self.times(&column)?;
            for (((row, m), image), left) in rows().zip(&image).zip(left.iter_mut()) {
                left[c] -= image + shift * m * row[c];
            }
        }
        Ok(())
    }

    /// `Q u`, zero where there is no mass.
    fn times(&self, u: &[f64]) -> Result<Vec<f64>> {
        let mut out = self.operator.normal_times(self.weights, u)?;
        out.iter_mut().zip(self.mass).filter(|(_, m)| **m == 0.0).for_each(|(x, _)| *x = 0.0);
        Ok(out)
    }

    /// How far the `image` of `u` under the inverse is from a multiple of `u`, relative to it.
    fn residual(&self, u: &[f64], image: &[f64]) -> f64 {
        let factor = mass_dot(self.mass, u, image);
        let terms = u.iter().zip(image).zip(self.mass).map(|((x, y), m)| m * (y - factor * x).powi(2));
        terms.sum::<f64>().sqrt() / factor.abs().max(f64::MIN_POSITIVE)
    }

    /// Adds what a vector has beside an orthonormal block, unless that is nothing but rounding.
    fn add_independent(&self, block: &mut Vec<Vec<f64>>, mut x: Vec<f64>) -> Result<()> {
        for _ in 0..2 {
            for y in block.iter() {
                let along = mass_dot(self.mass, &x, y);
                x.iter_mut().zip(y).for_each(|(x, y)| *x -= along * y);
            }
            let length = mass_dot(self.mass, &x, &x).sqrt();
            if length.is_nan() || length <= INDEPENDENT {
                return Ok(());
            }
            x.iter_mut().for_each(|x| *x /= length);
        }
        memory::push(block, x)?;
        Ok(())
    }

    /// Gram and Schmidt against the mass, twice, and again while a vector loses half of its length: what is
    /// left of one that nearly lies in the span of those before is rounding, and not orthogonal to them
    /// (Daniel et al. 1976, *Reorthogonalization and stable algorithms for updating the Gram-Schmidt QR
    /// factorization*).
    fn orthonormalize(&self, block: &mut [Vec<f64>]) -> Result<()> {
        for j in 0..block.len() {
            let (before, rest) = block.split_at_mut(j);
            let Some(x) = rest.first_mut() else { continue };
            x.iter_mut().zip(self.mass).filter(|(_, m)| **m == 0.0).for_each(|(x, _)| *x = 0.0);
            for round in 0.. {
                for y in before.iter() {
                    let along = mass_dot(self.mass, x, y);
                    x.iter_mut().zip(y).for_each(|(x, y)| *x -= along * y);
                }
                let length = mass_dot(self.mass, x, x).sqrt();
                if !(length > 0.0 && length.is_finite()) || round == MOST_PASSES {
                    let reason = "the modes are not independent; ask for fewer".into();
                    return Err(Error::Solve(SolveError::Factorization { reason }));
                }
                x.iter_mut().for_each(|x| *x /= length);
                if round > 0 && length > 0.5 {
                    break;
                }
            }
        }
        Ok(())
    }
}

/// `Q + σM` with its factor.
struct Shifted {
    normal: NormalMatrix,
    cholesky: Cholesky,
    values: Vec<f64>,
    /// `σ`
    shift: f64,
}

impl Shifted {
    /// Factors the matrix for a shift, or a larger one where that is not enough to make it positive definite.
    fn factorize(&mut self, pencil: &Pencil<'_>, shift: f64, progress: &Progress) -> Result<()> {
        self.shift = shift;
        for _ in 1..SHIFT_ATTEMPTS {
            if self.is_factored(pencil, progress)? {
                return Ok(());
            }
            self.shift *= 10.0;
        }
        self.factored(pencil, progress)
    }

    /// Factors the matrix for a smaller shift; where rounding leaves none, for the one before, and `false`.
    fn lower(&mut self, pencil: &Pencil<'_>, shift: f64, progress: &Progress) -> Result<bool> {
        if shift <= 0.0 {
            return Ok(false);
        }
        let before = std::mem::replace(&mut self.shift, shift);
        if self.is_factored(pencil, progress)? {
            return Ok(true);
        }
        self.shift = before;
        self.factored(pencil, progress)?;
        Ok(false)
    }

    fn is_factored(&mut self, pencil: &Pencil<'_>, progress: &Progress) -> Result<bool> {
        match self.factored(pencil, progress) {
            Ok(()) => Ok(true),
            Err(Error::Solve(SolveError::Factorization { .. })) => Ok(false),
            Err(error) => Err(error),
        }
    }

    fn factored(&mut self, pencil: &Pencil<'_>, progress: &Progress) -> Result<()> {
        let diagonal: Vec<f64> = memory::gathered(pencil.mass.iter().map(|m| self.shift * m))?;
        self.normal.assemble(pencil.operator, pencil.weights, &diagonal, &mut self.values);
        for (&start, m) in self.normal.pattern().starts.iter().zip(pencil.mass) {
            if *m == 0.0 && self.values[start] == 0.0 {
                self.values[start] = 1.0;
            }
        }
        self.cholesky.factorize(&self.values, progress)
    }
}

/// `xᵀ M y`.
#[must_use]
pub fn mass_dot(mass: &[f64], x: &[f64], y: &[f64]) -> f64 {
    mass.iter().zip(x.iter().zip(y)).map(|(m, (x, y))| m * x * y).sum()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The linear combinations of `block` in the columns of `rotation` (one vector a column).
fn combined(block: &[Vec<f64>], rotation: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
    let combine = |coefficients: &Vec<f64>| {
        let mut sum = memory::repeated(0.0, block[0].len())?;
        for (x, c) in block.iter().zip(coefficients) {
            sum.iter_mut().zip(x).for_each(|(s, x)| *s += c * x);
        }
        Ok(sum)
    };
    rotation.iter().map(combine).collect()
}
