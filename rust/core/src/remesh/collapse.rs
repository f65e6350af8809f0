//! Collapsing short edges.

use crate::memory;
use crate::remesh::remesher::Remesher;
use crate::remesh::split::LONG;
use crate::{Progress, Result};

/// Edges shorter than this times their target are collapsed (Botsch and Kobbelt 2004).
const SHORT: f64 = 4.0 / 5.0;

/// A collapse can make another one possible; after this many rounds hardly any is left.
const ROUNDS: usize = 3;

/// Collapses edges shorter than 4/5 of their target, shortest first, where that folds nothing and makes no
/// edge that would be split again.
pub(crate) fn collapse_short_edges(remesher: &mut Remesher, progress: &Progress) -> Result<()> {
    for _ in 0..ROUNDS {
        let is_short = |remesher: &Remesher, a: u32, b: u32| {
            remesher.length(a, b) < SHORT * remesher.sizing.target(a, b) && !remesher.curves.is_locked(a, b)
        };
        let edges = remesher.mesh.edges()?.into_iter().filter(|&[a, b]| is_short(remesher, a, b));
        let mut short = memory::sifted(edges.map(|[a, b]| (remesher.length(a, b), [a, b])))?;
        short.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut count = 0;
        for (_, [a, b]) in short {
            if progress.is_stopping() {
                return Ok(());
            }
            // An earlier collapse may have moved or removed it.
            if is_short(remesher, a, b) && remesher.collapse(a, b, LONG)? {
                count += 1;
            }
        }
        if count == 0 {
            break;
        }
    }
    Ok(())
}
