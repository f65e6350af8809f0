//! Which boundary loops are holes.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::components::Components;
use super::hole::Hole;
use super::islands::settle_islands;
use super::lids;
use super::polygon::Polygon;
use crate::error::{MeshError, Refusal};
use crate::mesh::vector::{area_vector, distance, dot, norm, place, unit, Point};
use crate::mesh::{boundary_walks, cycle, loop_area_vector, Connectivity, Mesh, Working};
use crate::remesh::closest::closest_on_segment;
use crate::{memory, Result};

/// A loop is the outer border of its surface if the faces along it lie inside it, seen along its area vector:
/// if they show more than this part of their area there, with the sign of the side that they show. A sheet's
/// border has 1, a hole in a sheet −1, the end of a tube 0, the border of a bowl of which a third of the
/// sphere is missing 0.5.
const INSIDE: f64 = 0.5;

/// The sides of a loop lie on each other if its vertices are off its other edges by no more than this part of
/// its length.
const ON_EACH_OTHER: f64 = 1e-5;

/// All boundary loops of `mesh`, in the order of [`crate::mesh::boundary_loops`], then the rims that do not
/// close, and what each is.
///
/// A loop is an outer border if the faces along it lie inside it ([`INSIDE`]). Where these stand too steeply
/// to say so, and the loop is no planar rim that they meet steeply all round, the whole surface decides: an
/// open sheet, whose area vectors add up to more than 0.57 of its area, keeps the loop with the largest area
/// in the projection along its mean normal.
///
/// - Faces are oriented, and seams joined, first ([`Working`]).
/// - Holes that touch at a vertex are separate loops, and so are the loops of a rim that touches itself. A
///   ring around an island that is pinched at a vertex is one.
/// - The two ends of a tube with a ring missing are two holes, and each gets a lid.
/// - A hole in which another open sheet lies is refused ([`Refusal::Island`]);
///   [`super::fill_loops`] fills it all the same.
/// - A rim that ends at a non-manifold edge is no loop and is refused ([`Refusal::OpenRim`]).
///
/// # Errors
/// [`MeshError::NoPositions`].
pub fn find_holes(mesh: &Mesh) -> Result<Vec<Hole>> {
    mesh.positions().ok_or(MeshError::NoPositions)?;
    let measured = mesh.measured(mesh.unit())?;
    let working = Working::new(&measured)?;
    let mut holes = holes_of(working.mesh())?;
    let seams = working.seam_edges()?;
    for hole in &mut holes {
        let own = |edge: [u32; 2]| seams.get(&edge).map_or_else(|| working.original(edge[0]), |own| own[0]);
        hole.vertices = memory::sifted(cycle(&hole.vertices).map(own))?;
    }
    Ok(holes)
}

/// [`find_holes`] on a mesh as it is.
pub(crate) fn holes_of(mesh: &Mesh) -> Result<Vec<Hole>> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    let ends = |h: usize| ([connectivity.tail(h), connectivity.head(h)], h);
    let halfedges: HashMap<[u32; 2], usize> = memory::mapped(connectivity.boundary().map(ends))?;
    let walks = boundary_walks(connectivity, Some(positions))?;
    let mut components = Components::new(connectivity, positions, &walks.loops);
    let mut holes: Vec<Hole> = memory::room(walks.loops.len() + walks.chains.len())?;
    let mut undecided = Vec::new();
    for vertices in walks.loops {
        let refusal = refusal(&vertices, positions, connectivity, &halfedges);
        let side = if refusal.is_none() {
            side(&vertices, positions, connectivity, &halfedges)
        } else {
            Side::Unknown
        };
        if side == Side::Unknown {
            memory::push(&mut undecided, holes.len())?;
        }
        holes.push(Hole { vertices, is_outer_border: side == Side::Inside, refusal });
    }
    let face = |hole: &Hole| {
        let along = cycle(&hole.vertices).find_map(|edge| halfedges.get(&edge));
        along.or_else(|| cycle(&hole.vertices).find_map(|[a, b]| halfedges.get(&[b, a]))).map(|&h| h / 3)
    };
    let several = holes.len() > 1;
    let mut owner = |hole: &Hole| face(hole).map(|face| components.of_face(face));
    let mut owners = memory::repeated(None, holes.len())?;
    if !undecided.is_empty() || several && holes.iter().any(|hole| hole.is_outer_border) {
        owners = memory::gathered(holes.iter().map(&mut owner))?;
    }
    let mut outer: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
    let decided: HashSet<Option<usize>> =
        holes.iter().zip(&owners).filter(|(hole, _)| hole.is_outer_border).map(|(_, &owner)| owner).collect();
    for i in undecided {
        let Some(number) = owners[i] else { continue };
        let is_open = |_: &Point| !decided.contains(&owners[i]);
        let Some(normal) = components.sheet_normal(number).filter(is_open) else { continue };
        let size = dot(loop_area_vector(&holes[i].vertices, positions), normal).abs();
        if outer.get(&number).is_none_or(|&(largest, _)| size > largest) {
            outer.insert(number, (size, i));
        }
    }
    for (_, hole) in outer.into_values() {
        holes[hole].is_outer_border = true;
    }
    settle_islands(&mut holes, &mut owners, positions);
    let open = |vertices| Hole { vertices, is_outer_border: false, refusal: Some(Refusal::OpenRim) };
    holes.extend(walks.chains.into_iter().map(open));
    Ok(holes)
}

/// On which side of a loop the faces along it lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Inside,
    /// Or under it, all round.
    Outside,
    Unknown,
}

fn side(
    vertices: &[u32],
    positions: &[Point],
    connectivity: &Connectivity,
    halfedges: &HashMap<[u32; 2], usize>,
) -> Side {
    let along = unit(loop_area_vector(vertices, positions));
    let (mut shown, mut area) = (0.0, 0.0);
    let mut outside = Vec::with_capacity(vertices.len());
    for edge in cycle(vertices) {
        let Some(&h) = halfedges.get(&edge) else { return Side::Unknown };
        let vector = area_vector(connectivity.faces()[h / 3].map(|v| positions[v as usize]));
        shown += dot(vector, along);
        area += norm(vector);
        outside.push(unit(vector));
    }
    if shown > INSIDE * area {
        return Side::Inside;
    }
    if shown < -INSIDE * area || lids::normal(&Polygon::around(vertices, positions, outside)).is_some() {
        return Side::Outside;
    }
    Side::Unknown
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
    if is_slit(vertices, positions) {
        return Some(Refusal::NoExtent);
    }
    has_no_width(vertices, positions).then_some(Refusal::TJunction)
}

/// Whether the two sides of a loop lie on each other: all vertices, but two where the sides meet,
/// on edges that they do not end.
fn has_no_width(vertices: &[u32], positions: &[Point]) -> bool {
    let points: Vec<Point> = vertices.iter().map(|&v| positions[v as usize]).collect();
    let n = points.len();
    let length: f64 = (0..n).map(|i| distance(points[i], points[(i + 1) % n])).sum();
    let off = ON_EACH_OTHER * length;
    if n < 3 || norm(loop_area_vector(vertices, positions)) > off * length {
        return false;
    }
    let is_on = |i: usize| {
        (0..n).any(|j| {
            let near = closest_on_segment(points[i], points[j], points[(j + 1) % n]);
            j != i && (j + 1) % n != i && distance(near, points[i]) <= off
        })
    };
    (0..n).filter(|&i| !is_on(i)).count() <= 2
}

/// Whether every vertex but the two at the ends lies where another one does, or all lie on a line.
fn is_slit(vertices: &[u32], positions: &[Point]) -> bool {
    let mut places: Vec<[u64; 3]> = vertices.iter().map(|&v| place(positions[v as usize])).collect();
    places.sort_unstable();
    let alone = places.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).count();
    alone <= 2 && vertices.len() > 3
}
