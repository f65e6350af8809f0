//! Which boundary loops are holes.

use std::collections::{BTreeMap, HashMap};

use super::components::Components;
use super::islands::refuse_holes_with_islands;
use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{dot, Point};
use crate::mesh::{boundary_loops, cycle, loop_area_vector, Connectivity, Mesh};
use crate::Result;

/// A boundary loop and what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The vertices in the order of [`boundary_loops`].
    pub vertices: Vec<u32>,
    /// Whether this is the outer border of an open sheet, which is filled only if asked for.
    pub is_outer_border: bool,
    /// Why it cannot be filled, if so.
    pub refusal: Option<Refusal>,
}

/// All boundary loops of `mesh`, in the order of [`boundary_loops`], and what each is.
///
/// Every edge-connected component that is an open sheet keeps one loop: the one with the largest area in the projection
/// along the component's mean normal. A component is an open sheet if its area vectors add up to more than 0.57 of its area:
/// they cancel on a closed surface and nearly so on one with holes, also on an open tube, whose ends are both holes; they add up
/// fully on a flat sheet, with holes or without.
///
/// - Holes that touch at a vertex are separate loops, and so are the loops of a rim that touches itself.
/// - The two ends of a tube with a ring missing are two holes, and each gets a lid.
/// - A hole in which another open sheet lies is refused ([`Refusal::Island`]); [`super::fill_loops`] fills it all the same.
/// - A rim that ends at a non-manifold edge is no loop and is not listed.
///
/// # Errors
/// [`MeshError::NoPositions`].
pub fn find_holes(mesh: &Mesh) -> Result<Vec<Hole>> {
    let measured = mesh.measured(mesh.unit())?;
    let mesh = measured.as_ref();
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    let halfedges: HashMap<[u32; 2], usize> =
        connectivity.boundary().map(|h| ([connectivity.tail(h), connectivity.head(h)], h)).collect();
    let loops = boundary_loops(connectivity);
    let mut components = Components::new(connectivity, positions, &loops);
    let mut outer: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
    let (mut holes, mut owners) = (Vec::with_capacity(loops.len()), Vec::with_capacity(loops.len()));
    for vertices in loops {
        let along = cycle(&vertices).find_map(|edge| halfedges.get(&edge));
        let against = || cycle(&vertices).find_map(|[a, b]| halfedges.get(&[b, a]));
        let owner = along.or_else(against).map(|&h| components.of_face(h / 3));
        if let Some((owner, normal)) = owner.and_then(|owner| Some((owner, components.sheet_normal(owner)?))) {
            let size = dot(loop_area_vector(&vertices, positions), normal).abs();
            if outer.get(&owner).is_none_or(|&(largest, _)| size > largest) {
                outer.insert(owner, (size, holes.len()));
            }
        }
        owners.push(owner);
        let refusal = refusal(&vertices, positions, connectivity, &halfedges);
        holes.push(Hole { vertices, is_outer_border: false, refusal });
    }
    for (_, hole) in outer.into_values() {
        holes[hole].is_outer_border = true;
    }
    refuse_holes_with_islands(&mut holes, &owners, positions);
    Ok(holes)
}

/// What can be said against a loop at sight.
fn refusal(
    vertices: &[u32],
    positions: &[Point],
    connectivity: &Connectivity,
    halfedges: &HashMap<[u32; 2], usize>,
) -> Option<Refusal> {
    let own = |edge: [u32; 2]| halfedges.get(&edge).copied();
    if !cycle(vertices).all(|edge| own(edge).is_some()) {
        return Some(Refusal::InconsistentOrientation);
    }
    if let &[a, b, _] = vertices {
        if own([a, b]).is_some_and(|h| vertices.contains(&connectivity.opposite(h))) {
            return Some(Refusal::SingleFace);
        }
    }
    is_slit(vertices, positions).then_some(Refusal::NoExtent)
}

/// Whether every vertex but the two at the ends lies where another one does, or all lie on a line.
fn is_slit(vertices: &[u32], positions: &[Point]) -> bool {
    let mut places: Vec<[u64; 3]> =
        vertices.iter().map(|&v| positions[v as usize].map(|x| (x + 0.0).to_bits())).collect();
    places.sort_unstable();
    let alone = places.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).count();
    alone <= 2 && vertices.len() > 3
}
