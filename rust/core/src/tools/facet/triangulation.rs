//! Facets as triangles, and as polygons without holes.

use std::collections::{HashMap, HashSet};

use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation, MIN_ALLOWED_VALUE};

use super::constants::COVERED;
use super::shape::{sides, Facet, Shape};
use crate::mesh::vector::{cross, dot, unit, Point};
use crate::{memory, Result};

/// Two unit vectors that span the plane with this normal: seen from its tip,
/// the second is to the left of the first.
pub(super) fn axes(normal: Point) -> [Point; 2] {
    let least = (0..3).fold(0, |least, i| if normal[i].abs() < normal[least].abs() { i } else { least });
    let mut along = [0.0; 3];
    along[least] = 1.0;
    let x = unit(cross(along, normal));
    [x, cross(normal, x)]
}

/// The constrained Delaunay triangulation of a facet's loops in its plane; `None` where the loops cross, run
/// the wrong way around, or enclose nothing.
pub(super) fn triangles(shape: &Shape, facet: &Facet) -> Result<Option<Vec<[u32; 3]>>> {
    let [x, y] = axes(facet.plane.normal);
    // The triangulation takes no smaller number but zero, and rounding leaves any beside an axis.
    let clear = |t: f64| if t.abs() < MIN_ALLOWED_VALUE { 0.0 } else { t };
    let flat = |c: u32| [clear(dot(x, shape.point(c))), clear(dot(y, shape.point(c)))];
    let twice = |[p, q, r]: [[f64; 2]; 3]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let Some(first) = facet.corners().next().map(flat) else { return Ok(None) };
    let area: f64 = facet.sides().map(|[a, b]| twice([first, flat(a), flat(b)])).sum();
    if area.is_nan() || area <= 0.0 {
        return Ok(None);
    }
    if facet.is_triangle() {
        return Ok(Some(vec![[facet.loops[0][0], facet.loops[0][1], facet.loops[0][2]]]));
    }
    let mut delaunay = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut names: Vec<u32> = Vec::new();
    let mut handles: HashMap<u32, FixedVertexHandle> = HashMap::new();
    for c in facet.corners() {
        let [u, v] = flat(c);
        let handle = delaunay.insert(Point2::new(u, v)).ok().filter(|handle| handle.index() == names.len());
        let Some(handle) = handle else { return Ok(None) };
        memory::push(&mut names, c)?;
        memory::extend_map(&mut handles, 1)?;
        handles.insert(c, handle);
    }
    for [a, b] in facet.sides() {
        let (a, b) = (handles[&a], handles[&b]);
        if !delaunay.can_add_constraint(a, b) {
            return Ok(None);
        }
        delaunay.add_constraint(a, b);
    }
    let sides: HashSet<[u32; 2]> = memory::distinct(facet.sides())?;
    let named = |from: FixedVertexHandle, to: FixedVertexHandle| [names[from.index()], names[to.index()]];
    // What lies on the left of a side is inside, and what is next to that.
    let mut inside = memory::repeated(false, delaunay.num_all_faces())?;
    let mut stack = Vec::new();
    for face in delaunay.inner_faces() {
        if face.adjacent_edges().iter().any(|e| sides.contains(&named(e.from().fix(), e.to().fix()))) {
            inside[face.fix().index()] = true;
            memory::push(&mut stack, face.fix())?;
        }
    }
    while let Some(face) = stack.pop() {
        for edge in delaunay.face(face).adjacent_edges() {
            let [a, b] = named(edge.from().fix(), edge.to().fix());
            if sides.contains(&[a, b]) {
                continue;
            }
            let Some(other) = edge.rev().face().as_inner().map(|face| face.fix()) else { return Ok(None) };
            if sides.contains(&[b, a]) {
                return Ok(None);
            }
            if !std::mem::replace(&mut inside[other.index()], true) {
                memory::push(&mut stack, other)?;
            }
        }
    }
    let within = delaunay.inner_faces().filter(|face| inside[face.fix().index()]);
    let triangles: Vec<[u32; 3]> =
        memory::sifted(within.map(|face| face.vertices().map(|v| names[v.fix().index()])))?;
    let covered: f64 = triangles.iter().map(|t| twice(t.map(flat))).sum();
    Ok(((covered - area).abs() <= COVERED * area).then_some(triangles))
}

/// Triangles for a facet whatever its loops do: they close the surface, and may overlap.
pub(super) fn forced(facet: &Facet) -> Result<Vec<[u32; 3]>> {
    let mut ring: Vec<u32> = memory::twin(facet.loops.first().map_or(&[], Vec::as_slice))?;
    for hole in facet.loops.iter().skip(1) {
        // Out to the hole, around it, and back.
        let back = [hole[0], ring[0]];
        memory::extend(&mut ring, hole.len() + 3)?;
        ring.extend([ring[0]]);
        ring.extend(hole);
        ring.extend(back);
        ring.pop();
    }
    let all = (1..ring.len().saturating_sub(1)).map(|i| [ring[0], ring[i], ring[i + 1]]);
    Ok(memory::sifted(all.filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]))?)
}

/// Joins the triangles of one facet to as few polygons as have no holes and meet no corner twice.
pub(super) fn polygons(triangles: &[[u32; 3]]) -> Result<Vec<Vec<u32>>> {
    let mut rings: Vec<Vec<u32>> = memory::gathered(triangles.iter().map(|t| t.to_vec()))?;
    let mut owner: HashMap<[u32; 2], usize> = HashMap::new();
    memory::extend_map(&mut owner, 3 * triangles.len())?;
    for (k, ring) in rings.iter().enumerate() {
        sides(ring).for_each(|side| _ = owner.insert(side, k));
    }
    for side in triangles.iter().flat_map(|t| sides(t)) {
        let [a, b] = side;
        let (Some(&p), Some(&q)) = (owner.get(&[a, b]), owner.get(&[b, a])) else { continue };
        if p == q {
            continue;
        }
        let Some(joined) = joined(&rings[p], &rings[q])? else { continue };
        sides(&rings[p]).chain(sides(&rings[q])).for_each(|side| _ = owner.remove(&side));
        sides(&joined).for_each(|side| _ = owner.insert(side, p));
        rings[p] = joined;
        rings[q] = Vec::new();
    }
    rings.retain(|ring| !ring.is_empty());
    Ok(rings)
}

/// One polygon of two that share one run of sides and no other corner.
fn joined(p: &[u32], q: &[u32]) -> Result<Option<Vec<u32>>> {
    let others: HashSet<[u32; 2]> = memory::distinct(sides(q))?;
    let shared = |[a, b]: [u32; 2]| others.contains(&[b, a]);
    let n = p.len();
    // The first side of `p` after what is shared.
    let is_start = |&i: &usize| shared([p[(i + n - 1) % n], p[i]]) && !shared([p[i], p[(i + 1) % n]]);
    let Some(start) = (0..n).find(is_start) else { return Ok(None) };
    let own: Vec<u32> = memory::gathered((0..n).map(|i| p[(start + i) % n]))?;
    let n_shared = sides(&own).filter(|&side| shared(side)).count();
    let (kept, hidden) = own.split_at(n - n_shared + 1);
    let Some(begin) = q.iter().position(|&c| c == kept[kept.len() - 1]) else { return Ok(None) };
    let rest: Vec<u32> =
        memory::gathered((0..q.len()).map(|i| q[(begin + i) % q.len()]).take(q.len() - n_shared + 1))?;
    // Both are runs from end to end: what they have in common otherwise is met twice.
    if rest[rest.len() - 1] != kept[0] || sides(&own).skip(kept.len() - 1).any(|side| !shared(side)) {
        return Ok(None);
    }
    let met: HashSet<u32> = memory::distinct(kept.iter().chain(hidden).copied())?;
    let inner = &rest[1..rest.len() - 1];
    if inner.iter().any(|c| met.contains(c)) || kept.len() + inner.len() < 3 {
        return Ok(None);
    }
    Ok(Some(memory::sifted(kept.iter().chain(inner).copied())?))
}
