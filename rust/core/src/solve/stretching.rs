//! Matrix stretching (Grcar 1990; Adlers and Björck 2000): blocks with many columns cut into pieces with few.
//!
//! A block of `H` with `d` columns, as the Hessian at a vertex with `d` neighbors, makes a dense clique of
//! `d²` entries of its term `HᵀRH` in the normal equations, and a factor that grows with the cube of `d`. Cut
//! into `N` pieces `H_1 u + … + H_N u` with new unknowns `s_i` between them, each piece has a residual of its
//! own,
//!
//! `e_1 = H_1 u + s_1, e_2 = H_2 u − s_1 + s_2, …, e_N = H_N u − s_{N−1}`,
//!
//! which sum to `H u`. The least of `N Σ e_iᵀ V e_i` over the `s_i` has all `e_i` alike and is
//! `(H u)ᵀ V (H u)`: eliminating the new unknowns from the stretched matrix leaves the one before, for every
//! `V`, so both have the same solution, and one is as definite as the other. Pieces follow each other in the
//! order in which the rest of the matrix would be eliminated; then a subtree of the elimination holds a run
//! of pieces, and no front grows by more than the unknowns at the two ends of a run.

use crate::block_rows::{BlockRows, BLOCK};
use crate::linear::ordering::eliminated;
use crate::solve::normal_pattern::pattern_of;
use crate::{memory, Progress, Result};

/// Blocks with more columns than this are cut. Measured on spheres with poles of so many columns, 24k and
/// 120k vertices in all: at 128 cutting takes as long or a fifth longer, at 256 two thirds of the time, at
/// 1024 a fifth.
const DENSE: usize = 160;

/// Columns of a piece: 16 to 48 take alike, 64 a fifth more (the same spheres).
const PIECE: usize = 32;

/// An entry of the stretched operator that is none of the operator.
const LINK: u32 = u32::MAX;

/// How an operator with dense blocks is cut.
#[derive(Debug, Clone)]
pub(super) struct Stretching {
    /// Columns of the operator.
    n_columns: usize,
    /// The cut operator, with values at the new unknowns only.
    rows: BlockRows,
    /// The block that each block of the cut operator is, or is a piece of.
    blocks: Vec<u32>,
    /// The entry that each entry is, or [`LINK`].
    entries: Vec<u32>,
    /// What the entries of each block are multiplied with: `√N`.
    scales: Vec<f64>,
    /// The blocks that are cut, and which of their rows have entries.
    cut: Vec<(u32, [bool; BLOCK])>,
}

impl Stretching {
    /// How `operator` is cut; `None` when no block has many columns.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`] when the system does not give what it takes.
    pub(super) fn new(operator: &BlockRows, progress: &Progress) -> Result<Option<Self>> {
        Self::above(DENSE, operator, progress)
    }

    /// The same for blocks with more than `most` columns.
    ///
    /// # Errors
    /// As [`Stretching::new`].
    pub(super) fn above(most: usize, operator: &BlockRows, progress: &Progress) -> Result<Option<Self>> {
        let size = |b| operator.starts[b + 1] - operator.starts[b];
        let is_dense = |b| size(b) > most.max(PIECE);
        let n_dense = (0..operator.n_blocks()).filter(|&b| is_dense(b)).count();
        if n_dense == 0 {
            return Ok(None);
        }
        let mut place = memory::repeated(0u32, operator.n_columns)?;
        for (k, i) in eliminated(&pattern_of(operator, |b| !is_dense(b))?, progress)?.into_iter().enumerate()
        {
            place[i] = k as u32;
        }
        let n_pieces = |b| if is_dense(b) { size(b).div_ceil(PIECE) } else { 1 };
        let n_links = |b| 2 * BLOCK * (n_pieces(b) - 1);
        let n_blocks: usize = (0..operator.n_blocks()).map(n_pieces).sum();
        let n_entries = operator.columns.len() + (0..operator.n_blocks()).map(n_links).sum::<usize>();
        let mut starts = memory::room(n_blocks + 1)?;
        starts.push(0);
        let mut found = Self {
            n_columns: operator.n_columns,
            rows: BlockRows {
                n_columns: operator.n_columns,
                starts,
                columns: memory::room(n_entries)?,
                values: memory::room(n_entries)?,
            },
            blocks: memory::room(n_blocks)?,
            entries: memory::room(n_entries)?,
            scales: memory::room(n_blocks)?,
            cut: memory::room(n_dense)?,
        };
        for b in 0..operator.n_blocks() {
            let mut entries: Vec<u32> = (operator.starts[b] as u32..operator.starts[b + 1] as u32).collect();
            if is_dense(b) {
                entries.sort_by_key(|&e| place[operator.columns[e as usize] as usize]);
                found.push_pieces(operator, b, &mut entries);
            } else {
                found.push(operator, b, 1.0, &entries);
                found.rows.starts.push(found.rows.columns.len());
            }
        }
        Ok(Some(found))
    }

    fn push_pieces(&mut self, operator: &BlockRows, b: usize, entries: &mut [u32]) {
        let used = used_rows(operator, b);
        self.cut.push((b as u32, used));
        let count = entries.len().div_ceil(PIECE);
        let scale = (count as f64).sqrt();
        for (k, piece) in entries.chunks_mut(PIECE).enumerate() {
            piece.sort_unstable();
            self.push(operator, b, scale, piece);
            if k > 0 {
                let first = self.rows.n_columns - used.iter().filter(|used| **used).count();
                self.push_links(first, -scale, used);
            }
            if k + 1 < count {
                let first = self.rows.n_columns;
                self.rows.n_columns = self.push_links(first, scale, used);
            }
            self.rows.starts.push(self.rows.columns.len());
        }
    }

    fn push(&mut self, operator: &BlockRows, b: usize, scale: f64, entries: &[u32]) {
        self.blocks.push(b as u32);
        self.scales.push(scale);
        for &e in entries {
            self.rows.columns.push(operator.columns[e as usize]);
            self.rows.values.push([0.0; BLOCK]);
            self.entries.push(e);
        }
    }

    /// Adds an unknown to each of the rows that have entries; returns the column behind the last.
    fn push_links(&mut self, first: usize, value: f64, used: [bool; BLOCK]) -> usize {
        let mut column = first;
        for r in (0..BLOCK).filter(|&r| used[r]) {
            self.rows.columns.push(column as u32);
            self.rows.values.push(std::array::from_fn(|i| if i == r { value } else { 0.0 }));
            self.entries.push(LINK);
            column += 1;
        }
        column
    }

    /// Whether `operator` has entries where the one before had them, and can be cut in the same way:
    /// rows that had no entries still have none.
    pub(super) fn fits(&self, operator: &BlockRows) -> bool {
        let is_entry = |b: usize, k: usize| {
            let (entry, block) = (self.entries[k] as usize, self.blocks[b] as usize);
            let range = operator.starts[block]..operator.starts[block + 1];
            range.contains(&entry) && operator.columns[entry] == self.rows.columns[k]
        };
        let of_operator = |k: &usize| self.entries[*k] != LINK;
        operator.n_columns == self.n_columns
            && self.blocks.last().is_some_and(|&last| last as usize + 1 == operator.n_blocks())
            && (0..self.entries.len()).filter(of_operator).count() == operator.columns.len()
            && (0..self.scales.len()).all(|b| {
                (self.rows.starts[b]..self.rows.starts[b + 1]).filter(of_operator).all(|k| is_entry(b, k))
            })
            && self.cut.iter().all(|&(b, used)| {
                used_rows(operator, b as usize).iter().zip(used).all(|(now, then)| then || !now)
            })
    }

    /// The cut operator without the values of `operator`: its pattern.
    pub(super) fn pattern(&self) -> &BlockRows {
        &self.rows
    }

    /// `operator`, cut.
    pub(super) fn rows(&self, operator: &BlockRows) -> BlockRows {
        let mut rows = self.rows.clone();
        for (b, scale) in self.scales.iter().enumerate() {
            for k in rows.starts[b]..rows.starts[b + 1] {
                if self.entries[k] != LINK {
                    rows.values[k] = operator.values[self.entries[k] as usize].map(|x| scale * x);
                }
            }
        }
        rows
    }

    /// The block that a block of the cut operator is, or is a piece of.
    pub(super) fn block(&self, piece: usize) -> usize {
        self.blocks[piece] as usize
    }

    /// Whether a block of the cut operator is a piece of another.
    pub(super) fn is_piece(&self, piece: usize) -> bool {
        self.scales[piece] != 1.0
    }
}

/// Which of the rows of block `b` have entries.
fn used_rows(operator: &BlockRows, b: usize) -> [bool; BLOCK] {
    let (_, values) = operator.block(b);
    std::array::from_fn(|r| values.iter().any(|x| x[r] != 0.0))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::linear::cholesky::Cholesky;
    use crate::solve::normal_matrix::NormalMatrix;
    use crate::solve::primal_dual::Stiffness;

    /// A ring of `n` columns in a scattered order around two more: blocks of three neighbors and a hub, and
    /// for both hubs blocks of all, the last with entries in its first row only.
    fn hubs(n: usize) -> BlockRows {
        let mut rows = BlockRows::empty(n + 2);
        let scattered = |k: usize| ((k % n) * 7 % n) as u32;
        let value = |b: usize, k: usize| std::array::from_fn(|r| ((5 * b + 3 * k + 7 * r + 1) as f64).sin());
        for b in 0..n {
            let around = (0..3).map(|k| (scattered(b + k), value(b, k)));
            rows.push_block(around.chain([((n + b % 2) as u32, value(b, 3))]));
        }
        for hub in 0..2 {
            rows.push_block((0..n).chain([n + hub]).map(|k| (k as u32, value(n + hub, k))));
        }
        rows.push_block((0..n).map(|k| (k as u32, [value(n + 2, k)[0], 0.0, 0.0])));
        rows
    }

    /// `n` is no multiple of 7, so that the ring visits every column.
    const SIZE: usize = 300;

    fn solved(normal: &NormalMatrix, values: &[f64], n: usize) -> (Vec<[f64; 2]>, usize) {
        let mut cholesky = Cholesky::analyze(normal.pattern(), None, &Progress::new()).unwrap();
        cholesky.factorize(values, &Progress::new()).unwrap();
        let mut right: Vec<[f64; 2]> = (0..n).map(|i| [(i as f64).cos(), 1.0 / (1 + i) as f64]).collect();
        cholesky.solve(&mut right).unwrap();
        (right, cholesky.factor_len())
    }

    /// Checks that what `assemble` makes of the matrix cut and whole has the same solutions, to a part of
    /// their size.
    fn check_same(
        h: &BlockRows,
        cut: &NormalMatrix,
        within: f64,
        assemble: impl Fn(&NormalMatrix, &mut Vec<f64>),
    ) {
        let whole = NormalMatrix::new(h).unwrap();
        let (mut of_whole, mut of_cut) = (Vec::new(), Vec::new());
        assemble(&whole, &mut of_whole);
        assemble(cut, &mut of_cut);
        let (cut, whole) = (solved(cut, &of_cut, h.n_columns).0, solved(&whole, &of_whole, h.n_columns).0);
        let size = whole.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
        for (a, b) in cut.iter().flatten().zip(whole.iter().flatten()) {
            assert!((a - b).abs() < within * size, "{a} is not {b}");
        }
    }

    #[test]
    fn solutions_are_those_of_the_matrix_that_is_not_cut() {
        let h = hubs(SIZE);
        let weights: Vec<f64> = (0..h.n_blocks()).map(|b| 0.2 + 0.5 * (b % 5) as f64).collect();
        let diagonal: Vec<f64> = (0..h.n_columns).map(|i| 0.1 + 0.3 * (i % 2) as f64).collect();
        let cut = NormalMatrix::stretched(&h, &Progress::new()).unwrap();
        // Two blocks with three new unknowns a cut, one with one.
        assert_eq!(cut.pattern().n, h.n_columns + 7 * (h.n_columns / PIECE));
        check_same(&h, &cut, 1e-11, |matrix, out| matrix.assemble(&h, &weights, &diagonal, out));

        let stiffness: Vec<Stiffness> = weights
            .iter()
            .map(|&scale| Stiffness {
                scale,
                drop: 0.3 * scale,
                dual: [0.9, 0.1, 0.2],
                primal: [0.5, 0.7, -0.3],
            })
            .collect();
        check_same(&h, &cut, 1e-6, |matrix, out| matrix.assemble_stiff(&h, &stiffness, &diagonal, out));
    }

    #[test]
    fn blocks_without_weight_leave_nothing() {
        let h = hubs(SIZE);
        let mut weights = vec![1.0; h.n_blocks()];
        weights[SIZE..].fill(0.0);
        let diagonal = vec![0.1; h.n_columns];
        let cut = NormalMatrix::stretched(&h, &Progress::new()).unwrap();
        check_same(&h, &cut, 1e-11, |matrix, out| matrix.assemble(&h, &weights, &diagonal, out));
    }

    #[test]
    fn the_factor_grows_with_the_columns_of_a_block_and_not_with_their_square() {
        let entries = |n: usize| {
            let h = hubs(n);
            let cut = NormalMatrix::stretched(&h, &Progress::new()).unwrap();
            Cholesky::analyze(cut.pattern(), None, &Progress::new()).unwrap().factor_len() as f64
        };
        let sizes = [2000, 4000, 8000, 16_000].map(|n| entries(n) / n as f64);
        assert!(sizes.iter().all(|a| *a < 150.0) && sizes[3] < 1.2 * sizes[0], "entries a column: {sizes:?}");
    }

    #[test]
    fn an_operator_whose_blocks_are_small_is_left_alone() {
        let mut h = BlockRows::empty(DENSE);
        h.push_block((0..DENSE as u32).map(|k| (k, [1.0; BLOCK])));
        assert!(Stretching::new(&h, &Progress::new()).unwrap().is_none());
        assert_eq!(
            NormalMatrix::stretched(&h, &Progress::new()).unwrap().pattern(),
            NormalMatrix::new(&h).unwrap().pattern()
        );
    }

    #[test]
    fn a_row_that_has_entries_now_and_had_none_before_does_not_fit() {
        let mut h = hubs(SIZE);
        let cut = Stretching::new(&h, &Progress::new()).unwrap().unwrap();
        assert!(cut.fits(&h));
        h.values.last_mut().unwrap()[1] = 1.0;
        assert!(!cut.fits(&h));
    }

    #[test]
    fn an_operator_with_other_entries_does_not_fit() {
        let cut = Stretching::new(&hubs(SIZE), &Progress::new()).unwrap().unwrap();
        let changed = |change: &dyn Fn(&mut BlockRows)| {
            let mut other = hubs(SIZE);
            change(&mut other);
            other
        };
        assert!(cut.fits(&changed(&|other| other.values[2] = [7.0; BLOCK])));
        for (what, other) in [
            ("a column of a small block", changed(&|other| other.columns[1] = 5)),
            ("a column of a large one", changed(&|other| *other.columns.last_mut().unwrap() += 1)),
            ("another number of columns", changed(&|other| other.n_columns += 1)),
            ("an entry in another block", changed(&|other| other.starts[1] -= 1)),
            ("a block more", changed(&|other| other.push_block([]))),
            ("another size", hubs(SIZE + 1)),
        ] {
            assert!(!cut.fits(&other), "{what}");
        }
    }
}
