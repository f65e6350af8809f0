//! What holds for every connectivity, for tests.

use crate::mesh::{Connectivity, EdgeKind};

/// The first broken invariant, as a sentence.
///
/// Faces name existing vertices; mates are mutual, lie on different halfedges and join the same two vertices,
/// in opposite directions if the edge is interior and in the same direction if it is inconsistent; other
/// edges have no mate.
///
/// # Errors
/// The sentence.
pub fn check(connectivity: &Connectivity) -> Result<(), String> {
    let n = connectivity.n_vertices();
    if let Some(f) = connectivity.faces().iter().position(|face| face.iter().any(|&v| v as usize >= n)) {
        return Err(format!("face {f} names a vertex that does not exist"));
    }
    for h in 0..connectivity.n_halfedges() {
        let kind = connectivity.kind(h);
        let Some(mate) = connectivity.mate(h) else {
            if matches!(kind, EdgeKind::Interior | EdgeKind::Inconsistent) {
                return Err(format!("halfedge {h} is {kind:?} but has no mate"));
            }
            continue;
        };
        if mate == h || connectivity.mate(mate) != Some(h) || connectivity.kind(mate) != kind {
            return Err(format!("halfedges {h} and {mate} are not each other's mates"));
        }
        let ends = (connectivity.tail(h), connectivity.head(h));
        let joined = match kind {
            EdgeKind::Interior => ends == (connectivity.head(mate), connectivity.tail(mate)),
            EdgeKind::Inconsistent => ends == (connectivity.tail(mate), connectivity.head(mate)),
            _ => return Err(format!("halfedge {h} is {kind:?} but has a mate")),
        };
        if !joined {
            return Err(format!("halfedges {h} and {mate} are mates but do not join the same vertices"));
        }
    }
    Ok(())
}
