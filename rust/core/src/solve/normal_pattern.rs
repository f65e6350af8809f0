//! Where `HᵀH` has entries.

use crate::block_rows::BlockRows;
use crate::buckets::Buckets;
use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::memory;

/// The lower triangle of `HᵀH` where only the blocks count that `is_taken` takes;
/// every diagonal entry is there.
///
/// # Errors
/// [`SolveError::Memory`] when the system does not give what it takes.
pub(super) fn pattern_of(
    operator: &BlockRows,
    is_taken: impl Fn(usize) -> bool,
) -> Result<LowerPattern, SolveError> {
    let n = operator.n_columns;
    let mut gathered = Buckets::new(n, |visit| {
        (0..n).for_each(|j| visit(j, j as u32));
        for b in (0..operator.n_blocks()).filter(|&b| is_taken(b)) {
            let (columns, _) = operator.block(b);
            for (i, &row) in columns.iter().enumerate() {
                columns[..i].iter().for_each(|&column| visit(column as usize, row));
            }
        }
    })?;
    let mut starts = memory::room(n + 1)?;
    (0..n).for_each(|j| gathered.of_mut(j).sort_unstable());
    let distinct = |j| gathered.of(j).chunk_by(|a, b| a == b).count();
    let mut rows: Vec<usize> = memory::room((0..n).map(distinct).sum())?;
    starts.push(0);
    for j in 0..n {
        let first = rows.len();
        for &row in gathered.of(j) {
            if rows.len() == first || rows[rows.len() - 1] != row as usize {
                rows.push(row as usize);
            }
        }
        starts.push(rows.len());
    }
    Ok(LowerPattern { n, starts, rows })
}
