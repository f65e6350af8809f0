//! Splitting long edges.

use crate::memory;
use crate::remesh::remesher::Remesher;
use crate::{Progress, Result};

/// Edges longer than this times their target are split: each half is then as far below the target as the
/// whole was above it (Botsch and Kobbelt 2004).
pub(crate) const LONG: f64 = 4.0 / 3.0;

/// Each round halves the longest edges; this many make a thousandth of any.
const ROUNDS: usize = 10;

/// Splits edges longer than 4/3 of their target in the middle, longest first, until there are none.
///
/// At most `most` faces are added, the longest edges first: what then is still long was asked to be shorter
/// than the surface has room for.
pub(crate) fn split_long_edges(remesher: &mut Remesher, most: usize, progress: &Progress) -> Result<()> {
    let limit = remesher.mesh.n_faces().saturating_add(most);
    for _ in 0..ROUNDS {
        let edges = remesher.mesh.edges()?.into_iter();
        let is_long = |&(length, [a, b]): &(f64, [u32; 2])| {
            length > LONG * remesher.sizing.target(a, b) && !remesher.curves.is_locked(a, b)
        };
        let mut long = memory::sifted(edges.map(|[a, b]| (remesher.length(a, b), [a, b])).filter(is_long))?;
        if long.is_empty() {
            return Ok(());
        }
        long.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        for (_, [a, b]) in long {
            if remesher.mesh.n_faces() >= limit || progress.is_stopping() {
                return Ok(());
            }
            remesher.split(a, b)?;
        }
    }
    Ok(())
}
