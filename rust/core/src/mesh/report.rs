//! What is unusual about a mesh.

use crate::mesh::connectivity::{next, previous};
use crate::mesh::partition::Partition;
use crate::mesh::{boundary_loops, flipped_faces, triangle, Connectivity, EdgeKind, Mesh};

/// Counts, and the edges, vertices and faces that are not as on a clean surface. All lists are sorted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshReport {
    /// Number of connected components among the faces; faces that share a vertex are connected.
    pub n_components: usize,
    /// Number of [`boundary_loops`].
    pub n_boundary_loops: usize,
    /// Edges with more than two faces, or with two that disagree on their orientation, as vertex pairs, smaller vertex
    /// first. Such edges count as boundary for all operators.
    pub nonmanifold_edges: Vec<[u32; 2]>,
    /// Those of the non-manifold edges that have two faces.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Faces turned against the faces around them ([`crate::mesh::flipped_faces`]); tools take them the other way around.
    pub flipped_faces: Vec<u32>,
    /// Vertices whose faces form more than one fan.
    pub nonmanifold_vertices: Vec<u32>,
    /// Faces that name a vertex twice or have no area ([`triangle::is_degenerate`]).
    pub degenerate_faces: Vec<u32>,
    /// Faces with the three vertices of an earlier face, in any order.
    pub duplicate_faces: Vec<u32>,
    /// Vertices that no face names.
    pub unreferenced_vertices: Vec<u32>,
}

/// The report on `mesh`.
#[must_use]
pub fn report(mesh: &Mesh) -> MeshReport {
    let connectivity = mesh.connectivity();
    let mut referenced = vec![false; connectivity.n_vertices()];
    connectivity.faces().iter().flatten().for_each(|&v| referenced[v as usize] = true);
    MeshReport {
        n_components: n_components(connectivity, &referenced),
        n_boundary_loops: boundary_loops(connectivity).len(),
        nonmanifold_edges: edges(connectivity, |kind| matches!(kind, EdgeKind::NonManifold | EdgeKind::Inconsistent)),
        inconsistent_edges: edges(connectivity, |kind| kind == EdgeKind::Inconsistent),
        flipped_faces: (0..).zip(flipped_faces(connectivity)).filter_map(|(f, flip)| flip.then_some(f)).collect(),
        nonmanifold_vertices: nonmanifold_vertices(connectivity),
        degenerate_faces: degenerate_faces(mesh),
        duplicate_faces: duplicate_faces(connectivity),
        unreferenced_vertices: (0..).zip(&referenced).filter_map(|(v, &named)| (!named).then_some(v)).collect(),
    }
}

fn n_components(connectivity: &Connectivity, referenced: &[bool]) -> usize {
    let mut vertices = Partition::new(connectivity.n_vertices());
    for &[a, b, c] in connectivity.faces() {
        vertices.unite(a, b);
        vertices.unite(b, c);
    }
    (0..).zip(referenced).filter(|&(v, &named)| named && vertices.root(v) == v).count()
}

fn edges(connectivity: &Connectivity, wanted: impl Fn(EdgeKind) -> bool) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> = (0..connectivity.n_halfedges())
        .filter(|&h| wanted(connectivity.kind(h)))
        .map(|h| {
            let (tail, head) = (connectivity.tail(h), connectivity.head(h));
            [tail.min(head), tail.max(head)]
        })
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Corners are united across the edges with two faces; a vertex whose corners stay apart has several fans.
fn nonmanifold_vertices(connectivity: &Connectivity) -> Vec<u32> {
    let mut corners = Partition::new(connectivity.n_halfedges());
    for h in connectivity.edges() {
        if let Some(mate) = connectivity.mate(h) {
            // The corner where a halfedge starts is the index of the next halfedge, that where it ends of the previous.
            let (mut tail, mut head) = (next(mate) as u32, previous(mate) as u32);
            if connectivity.kind(h) == EdgeKind::Interior {
                std::mem::swap(&mut tail, &mut head);
            }
            corners.unite(next(h) as u32, tail);
            corners.unite(previous(h) as u32, head);
        }
    }
    let mut n_fans = vec![0_u32; connectivity.n_vertices()];
    for corner in (0..connectivity.n_halfedges()).filter(|&c| connectivity.kind(c) != EdgeKind::Degenerate) {
        if corners.root(corner as u32) == corner as u32 {
            n_fans[connectivity.opposite(corner) as usize] += 1;
        }
    }
    (0..).zip(n_fans).filter_map(|(v, fans)| (fans > 1).then_some(v)).collect()
}

fn degenerate_faces(mesh: &Mesh) -> Vec<u32> {
    let degenerate = |f: usize| {
        mesh.connectivity().kind(3 * f) == EdgeKind::Degenerate || triangle::is_degenerate(mesh.edge_lengths()[f])
    };
    (0..mesh.connectivity().n_faces()).filter(|&f| degenerate(f)).map(|f| f as u32).collect()
}

fn duplicate_faces(connectivity: &Connectivity) -> Vec<u32> {
    let mut keys: Vec<([u32; 3], u32)> = connectivity
        .faces()
        .iter()
        .zip(0..)
        .map(|(&(mut key), f)| {
            key.sort_unstable();
            (key, f)
        })
        .collect();
    keys.sort_unstable();
    let mut duplicates: Vec<u32> =
        keys.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1].1).collect();
    duplicates.sort_unstable();
    duplicates
}
