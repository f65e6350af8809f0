//! Postorders of elimination trees.

use crate::buckets::Buckets;
use crate::error::SolveError;
use crate::linear::pattern::LowerPattern;
use crate::memory;

/// No row.
const NONE: u32 = u32::MAX;

/// `order` changed so that every subtree of the elimination tree is contiguous: that leaves the factor as it
/// is, and lets columns with the same pattern stand together.
///
/// # Errors
/// [`SolveError::Memory`].
pub fn postordered(pattern: &LowerPattern, order: &[u32]) -> Result<Vec<usize>, SolveError> {
    let tree = parents(pattern, order)?;
    let n = tree.len();
    let (mut first_child, mut sibling) = (memory::repeated(NONE, n)?, memory::repeated(NONE, n)?);
    let mut roots = NONE;
    for k in (0..n).rev() {
        let head = if tree[k] == NONE { &mut roots } else { &mut first_child[tree[k] as usize] };
        sibling[k] = std::mem::replace(head, k as u32);
    }
    let mut out = memory::room(n)?;
    let mut stack = Vec::new();
    let mut at = roots;
    loop {
        while at != NONE {
            stack.push(at);
            at = first_child[at as usize];
        }
        let Some(done) = stack.pop() else {
            return Ok(out);
        };
        out.push(order[done as usize] as usize);
        at = sibling[done as usize];
    }
}

/// The elimination tree of the matrix in this order (Liu 1986): per column the parent, or [`NONE`].
fn parents(pattern: &LowerPattern, order: &[u32]) -> Result<Vec<u32>, SolveError> {
    let n = pattern.n;
    let mut place = memory::repeated(0u32, n)?;
    for (k, &i) in order.iter().enumerate() {
        place[i as usize] = k as u32;
    }
    // The columns of each row of the lower triangle, in the new order.
    let columns = Buckets::new(n, |visit| {
        for j in 0..n {
            for &i in &pattern.rows[pattern.starts[j] + 1..pattern.starts[j + 1]] {
                let (a, b) = (place[i], place[j]);
                visit(a.max(b) as usize, a.min(b));
            }
        }
    })?;
    let mut parent = memory::repeated(NONE, n)?;
    let mut ancestor = memory::repeated(NONE, n)?;
    for k in 0..n {
        for &column in columns.of(k) {
            let mut i = column;
            while i != NONE && i != k as u32 {
                let above = std::mem::replace(&mut ancestor[i as usize], k as u32);
                if above == NONE {
                    parent[i as usize] = k as u32;
                }
                i = above;
            }
        }
    }
    Ok(parent)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A path of four rows, eliminated from both ends, beside a single row.
    #[test]
    fn subtrees_become_contiguous_and_the_tree_stays() {
        let pattern =
            LowerPattern { n: 5, starts: vec![0, 2, 4, 6, 7, 8], rows: vec![0, 1, 1, 2, 2, 3, 3, 4] };
        let order = [0, 3, 4, 1, 2];
        assert_eq!(parents(&pattern, &order).unwrap(), [3, 4, NONE, 4, NONE]);
        let post = postordered(&pattern, &order).unwrap();
        assert_eq!(post, [4, 3, 0, 1, 2]);
    }
}
