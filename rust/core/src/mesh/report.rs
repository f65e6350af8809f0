//! What is unusual about a mesh.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::partition::Partition;
use crate::mesh::vector::{cosine, cross, dot, sub};
use crate::mesh::{boundary_loops, flipped_faces, triangle, Connectivity, EdgeKind, Mesh, TJunctions, Weld};
use crate::{memory, Result};

/// Counts, and the edges, vertices and faces that are not as on a clean surface. All lists are sorted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshReport {
    /// Number of connected components among the faces; faces that share a vertex are connected.
    pub n_components: usize,
    /// Number of [`boundary_loops`].
    pub n_boundary_loops: usize,
    /// Edges with more than two faces, or with two that disagree on their orientation, as vertex pairs,
    /// smaller vertex first. Such edges count as boundary for all operators.
    pub nonmanifold_edges: Vec<[u32; 2]>,
    /// Those of the non-manifold edges that have two faces.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Faces turned against the faces around them ([`crate::mesh::flipped_faces`]);
    /// tools take them the other way around.
    pub flipped_faces: Vec<u32>,
    /// Vertices whose faces form more than one fan.
    pub nonmanifold_vertices: Vec<u32>,
    /// Faces that name a vertex twice or have no area ([`triangle::is_degenerate`]).
    pub degenerate_faces: Vec<u32>,
    /// Faces with the three vertices of an earlier face, in any order.
    pub duplicate_faces: Vec<u32>,
    /// Faces that lie on another one from a common edge on, where the edge has more than two: a second lid,
    /// whether or not it is cut into triangles as the first is.
    pub doubled_faces: Vec<u32>,
    /// Vertices in the middle of border edges of other faces, to which they are not joined ([`TJunctions`]).
    pub t_junctions: Vec<u32>,
    /// Vertices that no face names.
    pub unreferenced_vertices: Vec<u32>,
}

/// The report on `mesh`.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn report(mesh: &Mesh) -> Result<MeshReport> {
    let measured = mesh.measured(mesh.unit())?;
    let mesh = measured.as_ref();
    let connectivity = mesh.connectivity();
    let mut referenced = memory::repeated(false, connectivity.n_vertices())?;
    connectivity.faces().iter().flatten().for_each(|&v| referenced[v as usize] = true);
    let flipped = (0..).zip(flipped_faces(connectivity)?);
    let unnamed = (0..).zip(&referenced).filter_map(|(v, &named)| (!named).then_some(v));
    Ok(MeshReport {
        n_components: n_components(connectivity, &referenced)?,
        n_boundary_loops: boundary_loops(connectivity)?.len(),
        nonmanifold_edges: edges(connectivity, |kind| {
            matches!(kind, EdgeKind::NonManifold | EdgeKind::Inconsistent)
        })?,
        inconsistent_edges: edges(connectivity, |kind| kind == EdgeKind::Inconsistent)?,
        flipped_faces: memory::sifted(flipped.filter_map(|(f, flip)| flip.then_some(f)))?,
        nonmanifold_vertices: nonmanifold_vertices(connectivity)?,
        degenerate_faces: degenerate_faces(mesh)?,
        duplicate_faces: duplicate_faces(connectivity)?,
        doubled_faces: doubled_faces(mesh)?,
        t_junctions: t_junctions(mesh)?,
        unreferenced_vertices: memory::sifted(unnamed)?,
    })
}

fn n_components(connectivity: &Connectivity, referenced: &[bool]) -> Result<usize> {
    let mut vertices = Partition::new(connectivity.n_vertices())?;
    for &[a, b, c] in connectivity.faces() {
        vertices.unite(a, b);
        vertices.unite(b, c);
    }
    Ok((0..).zip(referenced).filter(|&(v, &named)| named && vertices.root(v) == v).count())
}

fn edges(connectivity: &Connectivity, wanted: impl Fn(EdgeKind) -> bool) -> Result<Vec<[u32; 2]>> {
    let ends = |h: usize| {
        let (tail, head) = (connectivity.tail(h), connectivity.head(h));
        [tail.min(head), tail.max(head)]
    };
    let found = (0..connectivity.n_halfedges()).filter(|&h| wanted(connectivity.kind(h)));
    let mut edges: Vec<[u32; 2]> = memory::sifted(found.map(ends))?;
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}

/// Corners are united across the edges with two faces; a vertex whose corners stay apart has several fans.
fn nonmanifold_vertices(connectivity: &Connectivity) -> Result<Vec<u32>> {
    let mut corners = Partition::new(connectivity.n_halfedges())?;
    for h in connectivity.edges() {
        if let Some(mate) = connectivity.mate(h) {
            // The corner where a halfedge starts is the index of the next halfedge,
            // that where it ends of the previous.
            let (mut tail, mut head) = (next(mate) as u32, previous(mate) as u32);
            if connectivity.kind(h) == EdgeKind::Interior {
                std::mem::swap(&mut tail, &mut head);
            }
            corners.unite(next(h) as u32, tail);
            corners.unite(previous(h) as u32, head);
        }
    }
    let mut n_fans = memory::repeated(0_u32, connectivity.n_vertices())?;
    for corner in (0..connectivity.n_halfedges()).filter(|&c| connectivity.kind(c) != EdgeKind::Degenerate) {
        if corners.root(corner as u32) == corner as u32 {
            n_fans[connectivity.opposite(corner) as usize] += 1;
        }
    }
    Ok(memory::sifted((0..).zip(n_fans).filter_map(|(v, fans)| (fans > 1).then_some(v)))?)
}

fn degenerate_faces(mesh: &Mesh) -> Result<Vec<u32>> {
    let degenerate = |f: usize| {
        mesh.connectivity().kind(3 * f) == EdgeKind::Degenerate
            || triangle::is_degenerate(mesh.edge_lengths()[f])
    };
    let found = (0..mesh.connectivity().n_faces()).filter(|&f| degenerate(f));
    Ok(memory::sifted(found.map(|f| f as u32))?)
}

fn duplicate_faces(connectivity: &Connectivity) -> Result<Vec<u32>> {
    let sorted = |(f, mut key): (usize, [u32; 3])| {
        key.sort_unstable();
        (key, f as u32)
    };
    let faces = connectivity.faces().iter().copied();
    let mut keys: Vec<([u32; 3], u32)> = memory::gathered(faces.enumerate().map(sorted))?;
    keys.sort_unstable();
    let again = keys.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let mut duplicates: Vec<u32> = memory::sifted(again.map(|pair| pair[1].1))?;
    duplicates.sort_unstable();
    Ok(duplicates)
}

/// Two faces lie on each other if they leave their common edge in the same direction,
/// up to this sine of the angle between them.
const SAME_DIRECTION: f64 = 1e-4;

/// The faces at edges with more than two that lie on another one there.
fn doubled_faces(mesh: &Mesh) -> Result<Vec<u32>> {
    let (connectivity, Some(positions)) = (mesh.connectivity(), mesh.positions()) else {
        return Ok(Vec::new());
    };
    let crowded = (0..connectivity.n_halfedges()).filter(|&h| connectivity.kind(h) == EdgeKind::NonManifold);
    let ends = |h: usize| [connectivity.tail(h), connectivity.head(h)];
    let keyed = |h: usize| {
        let [a, b] = ends(h);
        ([a.min(b), a.max(b)], h)
    };
    let mut at: Vec<([u32; 2], usize)> = memory::sifted(crowded.map(keyed))?;
    at.sort_unstable();
    let mut doubled = Vec::new();
    for edge in at.chunk_by(|x, y| x.0 == y.0) {
        let [a, b] = edge[0].0.map(|v| positions[v as usize]);
        let along = sub(b, a);
        // Across the edge, into the face, turned by a quarter: the length does not matter.
        let across = |h: usize| cross(along, sub(positions[connectivity.opposite(h) as usize], a));
        for &(_, h) in edge {
            let lies_on = |&(_, other): &([u32; 2], usize)| {
                let (x, y) = (across(h), across(other));
                let sine = (1.0 - cosine(x, y).powi(2)).max(0.0).sqrt();
                other != h && dot(x, y) > 0.0 && sine < SAME_DIRECTION
            };
            if edge.iter().any(lies_on) {
                memory::push(&mut doubled, (h / 3) as u32)?;
            }
        }
    }
    doubled.sort_unstable();
    doubled.dedup();
    Ok(doubled)
}

fn t_junctions(mesh: &Mesh) -> Result<Vec<u32>> {
    let (connectivity, Some(positions)) = (mesh.connectivity(), mesh.positions()) else {
        return Ok(Vec::new());
    };
    let Some(weld) = Weld::of_seams(connectivity, positions, None)? else {
        let found = TJunctions::find(connectivity, positions)?;
        return Ok(found.map_or_else(Vec::new, |found| found.vertices()));
    };
    let welded = Connectivity::new(weld.faces(connectivity.faces())?, weld.first.len())?;
    let found = TJunctions::find(&welded, &weld.firsts(positions)?)?;
    let mut vertices = found.map_or_else(Vec::new, |found| found.vertices());
    vertices.iter_mut().for_each(|v| *v = weld.first[*v as usize]);
    Ok(vertices)
}
