//! Splitting long edges.

use crate::remesh::remesher::Remesher;
use crate::Progress;

/// Edges longer than this times their target are split: each half is then as far below the target as the
/// whole was above it (Botsch and Kobbelt 2004).
pub(crate) const LONG: f64 = 4.0 / 3.0;

/// Each round halves the longest edges; this many make a thousandth of any.
const ROUNDS: usize = 10;

/// Splits edges longer than 4/3 of their target in the middle, longest first, until there are none.
///
/// At most `most` faces are added, the longest edges first: what then is still long was asked to be shorter
/// than the surface has room for.
pub(crate) fn split_long_edges(remesher: &mut Remesher, most: usize, progress: &Progress) {
    let limit = remesher.mesh.n_faces().saturating_add(most);
    for _ in 0..ROUNDS {
        let mut long: Vec<(f64, [u32; 2])> = remesher
            .mesh
            .edges()
            .into_iter()
            .map(|[a, b]| (remesher.length(a, b), [a, b]))
            .filter(|&(length, [a, b])| {
                length > LONG * remesher.sizing.target(a, b) && !remesher.curves.is_locked(a, b)
            })
            .collect();
        if long.is_empty() {
            return;
        }
        long.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        for (_, [a, b]) in long {
            if remesher.mesh.n_faces() >= limit || progress.is_stopping() {
                return;
            }
            remesher.split(a, b);
        }
    }
}
