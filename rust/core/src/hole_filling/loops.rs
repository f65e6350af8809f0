//! Which boundary loops are holes.

use std::collections::HashMap;

use super::islands::refuse_holes_with_islands;
use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{add, area_vector, cross, dot, norm, scale, sub, Point};
use crate::mesh::{boundary_loops, Connectivity, EdgeKind, Mesh};
use crate::Result;

/// A component counts as an open sheet if its mean normal is longer than this (1 on a flat sheet, 0 on a closed surface or
/// a tube). Between a hemisphere at 0.5, which is closed with a lid, and a sheet bent to half a tube at 0.64, which is not.
const OPEN_SHEET: f64 = 0.57;

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
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    let (component_of, components) = components(connectivity, positions);
    let halfedges: HashMap<[u32; 2], usize> = (0..connectivity.n_halfedges())
        .filter(|&h| connectivity.kind(h) == EdgeKind::Boundary)
        .map(|h| ([connectivity.tail(h), connectivity.head(h)], h))
        .collect();
    let mut outer: Vec<Option<(f64, usize)>> = vec![None; components.len()];
    let (mut holes, mut owners) = (Vec::new(), Vec::new());
    for vertices in boundary_loops(connectivity) {
        let along = cycle(&vertices).find_map(|edge| halfedges.get(&edge));
        let against = || cycle(&vertices).find_map(|[a, b]| halfedges.get(&[b, a]));
        let owner = along.or_else(against).map_or(usize::MAX, |&h| component_of[h / 3]);
        owners.push(owner);
        if let Some(component) = components.get(owner) {
            if let Some(normal) = component.sheet_normal() {
                let size = dot(loop_area_vector(&vertices, positions), normal).abs();
                if outer[owner].is_none_or(|(largest, _)| size > largest) {
                    outer[owner] = Some((size, holes.len()));
                }
            }
        }
        let refusal = refusal(&vertices, positions, connectivity, &halfedges);
        holes.push(Hole { vertices, is_outer_border: false, refusal });
    }
    for (_, hole) in outer.into_iter().flatten() {
        holes[hole].is_outer_border = true;
    }
    refuse_holes_with_islands(&mut holes, &owners, positions);
    Ok(holes)
}

/// The loops of [`find_holes`] that are neither an outer border nor refused.
///
/// # Errors
/// [`MeshError::NoPositions`].
pub fn fillable_loops(mesh: &Mesh) -> Result<Vec<Vec<u32>>> {
    let fillable = |hole: &Hole| !hole.is_outer_border && hole.refusal.is_none();
    Ok(find_holes(mesh)?.into_iter().filter(fillable).map(|hole| hole.vertices).collect())
}

/// The edges of a closed loop.
pub(super) fn cycle(vertices: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
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

/// Half the sum of the cross products of successive positions: the area vector of any surface that the loop bounds.
pub(super) fn loop_area_vector(vertices: &[u32], positions: &[Point]) -> Point {
    let Some(&first) = vertices.first() else { return [0.0; 3] };
    let at = |v: u32| sub(positions[v as usize], positions[first as usize]);
    cycle(vertices).fold([0.0; 3], |sum, [a, b]| add(sum, scale(cross(at(a), at(b)), 0.5)))
}

/// A set of faces connected across edges.
struct Component {
    area: f64,
    area_vector: Point,
}

impl Component {
    /// The direction of the mean normal, of length 1, if the component is an open sheet.
    fn sheet_normal(&self) -> Option<Point> {
        let length = norm(self.area_vector);
        (length > OPEN_SHEET * self.area).then(|| scale(self.area_vector, 1.0 / length))
    }
}

/// The component of every face, and the components. A face that disagrees with its neighbours on the orientation counts
/// the other way round.
fn components(connectivity: &Connectivity, positions: &[Point]) -> (Vec<usize>, Vec<Component>) {
    let n_faces = connectivity.n_faces();
    let (mut component_of, mut components) = (vec![usize::MAX; n_faces], Vec::new());
    for seed in 0..n_faces {
        if component_of[seed] != usize::MAX {
            continue;
        }
        let number = components.len();
        let mut component = Component { area: 0.0, area_vector: [0.0; 3] };
        component_of[seed] = number;
        let mut stack = vec![(seed, 1.0)];
        while let Some((f, sign)) = stack.pop() {
            let area = area_vector(connectivity.faces()[f].map(|v| positions[v as usize]));
            component.area += norm(area);
            component.area_vector = add(component.area_vector, scale(area, sign));
            for h in 3 * f..3 * f + 3 {
                let Some(mate) = connectivity.mate(h) else { continue };
                if component_of[mate / 3] == usize::MAX {
                    component_of[mate / 3] = number;
                    stack.push((mate / 3, if connectivity.kind(h) == EdgeKind::Interior { sign } else { -sign }));
                }
            }
        }
        components.push(component);
    }
    (component_of, components)
}
