//! Corners of very many facets, and facets with very many corners, in a step of Newton.
//!
//! Each couples all its pairs of facet and corner: a dense block, and a factor that takes the cube of their
//! number. The block has no more than rank three, though. The system without these blocks is factorized, and
//! what they add is solved for on top of it [Woodbury: Golub and Van Loan 2013, section 2.1.4]; where both
//! are far apart digits are lost on the way, and what is left over is solved for again.

use std::cmp::Reverse;

use crate::linear::cholesky::Cholesky;
use crate::linear::pattern::LowerPattern;
use crate::linear::small::DenseCholesky;
use crate::memory;
use crate::mesh::vector::{dot, Point};
use crate::Result;

/// Blocks larger than this are taken apart. One of so many pairs takes 6 million operations, less than a
/// hundredth of a second; 4000 would take 3000 times as much.
const LARGEST: usize = 256;

/// Of at most so many hubs, the largest: solving for what they add takes the square of their number.
const MOST: usize = 64;

/// How often what is left over is solved for again: each time leaves a millionth.
const AGAIN: usize = 2;

/// The pairs at one corner, or of one facet, where they are very many.
pub(super) struct Hubs {
    /// Of each hub: its pairs.
    pairs: Vec<Vec<usize>>,
    /// Of each hub: whether it is a corner, and its number.
    names: Vec<(bool, usize)>,
}

/// The block of one hub in a step: `V Vᵀ`, with a row of `V` for each of its pairs.
struct Block<'a> {
    pairs: &'a [usize],
    rows: Vec<Point>,
}

impl Hubs {
    /// The hubs among corners and facets, whose pairs are given.
    pub(super) fn new(at_corners: &[Vec<usize>], at_facets: &[Vec<usize>]) -> Result<Self> {
        let mut large = Vec::new();
        for (is_corner, at) in [(true, at_corners), (false, at_facets)] {
            for (i, pairs) in at.iter().enumerate().filter(|(_, pairs)| pairs.len() > LARGEST) {
                memory::push(&mut large, (Reverse(pairs.len()), is_corner, i))?;
            }
        }
        large.sort_unstable();
        large.truncate(MOST);
        let mut hubs = Self { pairs: memory::room(large.len())?, names: memory::room(large.len())? };
        for (_, is_corner, i) in large {
            hubs.pairs.push(memory::twin(&if is_corner { at_corners } else { at_facets }[i])?);
            hubs.names.push((is_corner, i));
        }
        Ok(hubs)
    }

    /// Which of `n` corners, or facets, are hubs.
    pub(super) fn mask(&self, of_corners: bool, n: usize) -> Result<Vec<bool>> {
        let mut mask = memory::repeated(false, n)?;
        self.names.iter().filter(|name| name.0 == of_corners).for_each(|name| mask[name.1] = true);
        Ok(mask)
    }

    /// Solves for `right` where `cholesky` has the factor of the matrix of `values` in `pattern`, to which
    /// the blocks of all hubs are added: `part` gives the row of a pair for a corner or a facet. Whether
    /// rounding leaves a solution.
    pub(super) fn solve(
        &self,
        cholesky: &mut Cholesky,
        (pattern, values): (&LowerPattern, &[f64]),
        right: &mut [[f64; 1]],
        part: impl Fn(bool, usize) -> Point,
    ) -> Result<bool> {
        if self.names.is_empty() {
            cholesky.solve(right)?;
            return Ok(true);
        }
        let n = 3 * self.names.len();
        let mut blocks = memory::room(self.names.len())?;
        for (pairs, &(is_corner, _)) in self.pairs.iter().zip(&self.names) {
            let rows = memory::gathered(pairs.iter().map(|&k| part(is_corner, k)))?;
            blocks.push(Block { pairs, rows });
        }
        // What the factor makes of every column of the blocks, and how far they come back.
        let mut columns = memory::room(blocks.len())?;
        for block in &blocks {
            let mut column = memory::repeated([0.0; 3], right.len())?;
            block.pairs.iter().zip(&block.rows).for_each(|(&k, row)| column[k] = *row);
            cholesky.solve(&mut column)?;
            columns.push(column);
        }
        let mut small = memory::repeated(0.0, n * n)?;
        for (i, block) in blocks.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                for (&k, row) in block.pairs.iter().zip(&block.rows) {
                    for (a, b) in (0..9).map(|e| (e / 3, e % 3)) {
                        small[(3 * i + a) * n + 3 * j + b] += row[a] * column[k][b];
                    }
                }
            }
        }
        (0..n).for_each(|i| small[i * n + i] += 1.0);
        let Some(small) = DenseCholesky::new(&small, n) else { return Ok(false) };
        let mut solution = memory::repeated([0.0], right.len())?;
        for round in 0..=AGAIN {
            let mut left = memory::twin(right)?;
            if round > 0 {
                subtract(pattern, values, &blocks, &solution, &mut left)?;
            }
            cholesky.solve(&mut left)?;
            let mut along = memory::repeated([0.0], n)?;
            for (i, block) in blocks.iter().enumerate() {
                for (&k, row) in block.pairs.iter().zip(&block.rows) {
                    (0..3).for_each(|a| along[3 * i + a][0] += row[a] * left[k][0]);
                }
            }
            small.solve(&mut along);
            for (i, column) in columns.iter().enumerate() {
                let by = [0, 1, 2].map(|a| along[3 * i + a][0]);
                left.iter_mut().zip(column).for_each(|(x, row)| x[0] -= dot(*row, by));
            }
            solution.iter_mut().zip(&left).for_each(|(x, more)| x[0] += more[0]);
        }
        right.copy_from_slice(&solution);
        Ok(true)
    }
}

/// Subtracts the matrix with its blocks, times `x`, from `from`.
fn subtract(
    pattern: &LowerPattern,
    values: &[f64],
    blocks: &[Block<'_>],
    x: &[[f64; 1]],
    from: &mut [[f64; 1]],
) -> Result<()> {
    for k in 0..pattern.n {
        let own = pattern.starts[k]..pattern.starts[k + 1];
        for (&row, value) in pattern.rows[own.clone()].iter().zip(&values[own]) {
            from[row][0] -= value * x[k][0];
            if row != k {
                from[k][0] -= value * x[row][0];
            }
        }
    }
    for block in blocks {
        let with = block.pairs.iter().zip(&block.rows);
        let sum = with.clone().fold([0.0; 3], |sum, (&k, row)| [0, 1, 2].map(|a| sum[a] + row[a] * x[k][0]));
        with.for_each(|(&k, row)| from[k][0] -= dot(*row, sum));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::random::Random;
    use crate::Progress;

    #[test]
    fn a_system_with_hubs_has_the_solution_of_the_dense_one() {
        let n = 2 * LARGEST;
        let mut random = Random::new(1);
        // A corner with the first two thirds of the pairs, and a facet with the last two thirds.
        let pairs: [Vec<usize>; 2] = [(0..2 * n / 3).collect(), (n / 3..n).collect()];
        let rows: [Vec<Point>; 2] =
            [(); 2].map(|()| (0..n).map(|_| [(); 3].map(|()| 10.0 * random.symmetric())).collect());
        let diagonal: Vec<f64> = (0..n).map(|_| 0.01 + random.uniform()).collect();
        let right: Vec<[f64; 1]> = (0..n).map(|_| [random.symmetric()]).collect();
        let mut dense = vec![0.0; n * n];
        (0..n).for_each(|k| dense[k * n + k] = diagonal[k]);
        for (pairs, rows) in pairs.iter().zip(&rows) {
            for (&j, &k) in pairs.iter().flat_map(|j| pairs.iter().map(move |k| (j, k))) {
                dense[j * n + k] += dot(rows[j], rows[k]);
            }
        }
        let mut expected = right.clone();
        DenseCholesky::new(&dense, n).unwrap().solve(&mut expected);

        let hubs = Hubs::new(&pairs[..1], &pairs[1..]).unwrap();
        assert_eq!([hubs.mask(true, 1).unwrap(), hubs.mask(false, 1).unwrap()], [[true], [true]]);
        let pattern = LowerPattern { n, starts: (0..=n).collect(), rows: (0..n).collect() };
        let mut cholesky = Cholesky::analyze(&pattern, None, &Progress::new()).unwrap();
        cholesky.factorize(&diagonal, &Progress::new()).unwrap();
        let mut found = right;
        let part = |is_corner: bool, k: usize| rows[usize::from(!is_corner)][k];
        assert!(hubs.solve(&mut cholesky, (&pattern, &diagonal), &mut found, part).unwrap());
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found[0] - expected[0]).abs() < 1e-10 * (1.0 + expected[0].abs()));
        }
    }
}
