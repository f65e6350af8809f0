//! The Laplacian of a cut mesh with weights that keep every solution within the range of its data,
//! and its linear systems.

use sprs::CsMat;

use super::constants::LEAST_WEIGHT;
use crate::intrinsic::delaunay_flips;
use crate::linear::cholesky::Cholesky;
use crate::linear::pattern::LowerPattern;
use crate::linear::Columns;
use crate::mesh::{Connectivity, CutMesh};
use crate::operators::{cotangent_laplacian, mollify, voronoi_mass};
use crate::progress::Progress;
use crate::{memory, Result};

/// Right sides solved at once.
const LANES: usize = 4;

/// Laplacian and mass of a cut mesh.
pub(super) struct Membrane {
    /// Off the diagonal ≤ 0, rows sum to 0: an M-matrix, whose solutions obey the maximum principle.
    pub laplacian: CsMat<f64>,
    /// The Voronoi area of every copy.
    pub mass: Vec<f64>,
}

impl Membrane {
    /// The cotangent Laplacian on the intrinsic Delaunay triangulation of every piece of `cut` (Bobenko and
    /// Springborn 2007), weights under [`LEAST_WEIGHT`] raised to it.
    pub(super) fn new(cut: &CutMesh, lengths: &[[f64; 3]]) -> Result<Self> {
        let n = cut.n_copies();
        let connectivity = Connectivity::new(memory::twin(&cut.faces)?, n)?;
        let mass = voronoi_mass(&connectivity, lengths)?;
        let mut lengths = memory::twin(lengths)?;
        mollify(&connectivity, &mut lengths);
        let (connectivity, lengths, _) = delaunay_flips(&connectivity, &lengths)?;
        let mut laplacian = cotangent_laplacian(&connectivity, &lengths)?;
        for v in 0..n {
            let range = laplacian.indptr().outer_inds_sz(v);
            let (mut sum, mut diagonal) = (0.0, None);
            for k in range {
                if laplacian.indices()[k] == v {
                    diagonal = Some(k);
                } else {
                    let value = laplacian.data()[k].min(-LEAST_WEIGHT);
                    laplacian.data_mut()[k] = value;
                    sum += value;
                }
            }
            if let Some(k) = diagonal {
                laplacian.data_mut()[k] = -sum;
            }
        }
        Ok(Self { laplacian, mass })
    }

    /// `L` plus a diagonal on the rows for which `free` holds: pattern and values.
    fn matrix(
        &self,
        free: &[u32],
        index: &[u32],
        diagonal: impl Fn(usize) -> f64,
    ) -> Result<(LowerPattern, Vec<f64>)> {
        let mut starts = memory::room(free.len() + 1)?;
        starts.push(0);
        let most = free.len() + self.laplacian.nnz() / 2;
        let (mut rows, mut values) = (memory::room(most)?, memory::room(most)?);
        for (j, &v) in free.iter().enumerate() {
            rows.push(j);
            let place = values.len();
            values.push(0.0);
            let neighbors = self.laplacian.outer_view(v as usize);
            for (u, &value) in neighbors.iter().flat_map(|row| row.iter()) {
                if u == v as usize {
                    values[place] += value + diagonal(u);
                } else if index[u] != FIXED && index[u] as usize > j {
                    rows.push(index[u] as usize);
                    values.push(value);
                }
            }
            if values[place] <= 0.0 {
                // A copy that no edge reaches stays where it is.
                values[place] = 1.0;
            }
            starts.push(rows.len());
        }
        Ok((LowerPattern { n: free.len(), starts, rows }, values))
    }
}

/// Screened functions for one set of weights after the other: the pattern is analyzed once.
pub(super) struct Screened<'a> {
    membrane: &'a Membrane,
    cholesky: Option<Cholesky>,
}

impl<'a> Screened<'a> {
    pub(super) fn new(membrane: &'a Membrane) -> Self {
        Self { membrane, cholesky: None }
    }

    /// `argmin uᵀ L u + Σ_i a_i (u_i − t_i)²`, column by column (Rowe et al. 2024, eq. (27)); every piece of
    /// the surface needs a positive weight `a`.
    pub(super) fn screened(
        &mut self,
        weights: &[f64],
        target: &Columns,
        progress: &Progress,
    ) -> Result<Columns> {
        let all = memory::numbers(weights.len())?;
        let (pattern, entries) = self.membrane.matrix(&all, &all, |v| weights[v])?;
        let cholesky = match &mut self.cholesky {
            Some(cholesky) => cholesky,
            none => none.insert(Cholesky::analyze(&pattern, None, progress)?),
        };
        cholesky.factorize(&entries, progress)?;
        let mut values = target.copied()?;
        for c in 0..values.n_columns {
            values.column_mut(c).iter_mut().zip(weights).for_each(|(x, a)| *x *= a);
        }
        solve(cholesky, &mut values, progress)?;
        Ok(values)
    }
}

/// No row in the matrix.
const FIXED: u32 = u32::MAX;

/// Harmonic functions with given values on some copies (Rowe et al. 2024, eq. (26)).
pub(super) struct Harmonic<'a> {
    membrane: &'a Membrane,
    free: Vec<u32>,
    cholesky: Option<Cholesky>,
}

impl<'a> Harmonic<'a> {
    /// Factors the Laplacian of the copies that are not `fixed`; every piece needs a fixed copy.
    pub(super) fn new(membrane: &'a Membrane, fixed: &[bool], progress: &Progress) -> Result<Self> {
        let free = memory::sifted((0..fixed.len()).filter(|&v| !fixed[v]).map(|v| v as u32))?;
        let mut index = memory::repeated(FIXED, fixed.len())?;
        (0..).zip(&free).for_each(|(i, &v)| index[v as usize] = i);
        let cholesky = if free.is_empty() {
            None
        } else {
            let (pattern, values) = membrane.matrix(&free, &index, |_| 0.0)?;
            let mut cholesky = Cholesky::analyze(&pattern, None, progress)?;
            cholesky.factorize(&values, progress)?;
            Some(cholesky)
        };
        Ok(Self { membrane, free, cholesky })
    }

    /// Replaces the values of the free copies by the harmonic function through the others (Rowe et al. 2024,
    /// eq. (26)).
    pub(super) fn extend(&mut self, values: &mut Columns, progress: &Progress) -> Result<()> {
        let Some(cholesky) = &mut self.cholesky else { return Ok(()) };
        for c in 0..values.n_columns {
            self.free.iter().for_each(|&v| values.column_mut(c)[v as usize] = 0.0);
        }
        let mut right = Columns::try_zeros(self.free.len(), values.n_columns)?;
        for c in 0..values.n_columns {
            let column = values.column(c);
            for (x, &v) in right.column_mut(c).iter_mut().zip(&self.free) {
                *x = -row_times(&self.membrane.laplacian, v as usize, column);
            }
        }
        solve(cholesky, &mut right, progress)?;
        for c in 0..values.n_columns {
            for (x, &v) in right.column(c).iter().zip(&self.free) {
                values.column_mut(c)[v as usize] = *x;
            }
        }
        Ok(())
    }

    /// The transpose of [`Harmonic::extend`]: what a change of each fixed value does to `Σ_i r_i u_i`,
    /// 0 at the free copies.
    pub(super) fn transposed(&mut self, residual: &mut Columns, progress: &Progress) -> Result<()> {
        let Some(cholesky) = &mut self.cholesky else { return Ok(()) };
        let mut inner = Columns::try_zeros(self.free.len(), residual.n_columns)?;
        for c in 0..residual.n_columns {
            for (x, &v) in inner.column_mut(c).iter_mut().zip(&self.free) {
                *x = std::mem::take(&mut residual.column_mut(c)[v as usize]);
            }
        }
        solve(cholesky, &mut inner, progress)?;
        for c in 0..residual.n_columns {
            for (x, &v) in inner.column(c).iter().zip(&self.free) {
                for (u, value) in
                    self.membrane.laplacian.outer_view(v as usize).iter().flat_map(|row| row.iter())
                {
                    residual.column_mut(c)[u] -= value * x;
                }
            }
            self.free.iter().for_each(|&v| residual.column_mut(c)[v as usize] = 0.0);
        }
        Ok(())
    }
}

fn row_times(matrix: &CsMat<f64>, row: usize, x: &[f64]) -> f64 {
    matrix.outer_view(row).iter().flat_map(|row| row.iter()).map(|(j, value)| value * x[j]).sum()
}

/// Solves in place for all columns, [`LANES`] at a time.
fn solve(cholesky: &mut Cholesky, right: &mut Columns, progress: &Progress) -> Result<()> {
    let n = right.n_rows;
    for first in (0..right.n_columns).step_by(LANES) {
        progress.check()?;
        let lanes = LANES.min(right.n_columns - first);
        let at = |i: usize, c: usize| if c < lanes { (first + c) * n + i } else { first * n + i };
        let row = |i: usize| std::array::from_fn(|c| right.data[at(i, c)]);
        let mut rows: Vec<[f64; LANES]> = memory::gathered((0..n).map(row))?;
        cholesky.solve(&mut rows)?;
        for (i, row) in rows.iter().enumerate() {
            (0..lanes).for_each(|c| right.data[at(i, c)] = row[c]);
        }
    }
    Ok(())
}
