//! Removing slivers.

use crate::memory;
use crate::mesh::vector::quality;
use crate::remesh::flips::gain;
use crate::remesh::guard;
use crate::remesh::relax::relax_and_project;
use crate::remesh::remesher::Remesher;
use crate::shape_guard::SLIVER;
use crate::{Progress, Result};

/// A repair can make another one possible; hardly any takes more.
const ROUNDS: usize = 5;

/// How much longer than its target an edge may get where that removes a sliver.
const LONGEST: f64 = 2.0;

/// Removes faces thinner than [`SLIVER`], the thinnest first: by flipping an edge if that makes better faces,
/// else by collapsing the shortest edge; what is left after that is moved again. Next to fixed vertices some
/// may have to stay.
pub(crate) fn remove_slivers(remesher: &mut Remesher, progress: &Progress) -> Result<()> {
    for _ in 0..ROUNDS {
        let faces = remesher.mesh.faces().map(|(f, face)| (quality(remesher.mesh.corners(face)), f));
        let mut slivers = memory::sifted(faces.filter(|&(q, _)| q < SLIVER))?;
        if slivers.is_empty() {
            return Ok(());
        }
        slivers.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (_, f) in slivers {
            if progress.is_stopping() {
                return Ok(());
            }
            remove(remesher, f)?;
        }
        relax_and_project(remesher, progress)?;
    }
    Ok(())
}

/// Removes face `f` if it is still there and still a sliver.
fn remove(remesher: &mut Remesher, f: u32) -> Result<()> {
    let Some([a, b, c]) = remesher.mesh.face(f) else { return Ok(()) };
    if quality(remesher.mesh.corners([a, b, c])) >= SLIVER {
        return Ok(());
    }
    let mut edges = [[a, b], [b, c], [c, a]];
    edges.sort_by(|x, y| remesher.length(y[0], y[1]).total_cmp(&remesher.length(x[0], x[1])));
    for [a, b] in edges {
        if remesher.is_free(a, b) && gain(&remesher.mesh, a, b) > 1.0 && guard::may_flip(&remesher.mesh, a, b)
        {
            remesher.mesh.flip(a, b);
            return Ok(());
        }
    }
    for [a, b] in edges.into_iter().rev() {
        if !remesher.curves.is_locked(a, b) && remesher.collapse(a, b, LONGEST)? {
            break;
        }
    }
    Ok(())
}
