//! Ridges that go on as the ridges around the hole do: straight ones straight, bent ones bent alike.

use super::region::Region;
use super::surface::FaceGeometry;
use crate::memory;
use crate::mesh::vector::{distance, dot, norm, sub};
use crate::remesh::curves::CORNER_COSINE;
use crate::Result;

/// Vertices, their coefficients, and the length that they stand for.
type Row = ([u32; 4], [f64; 4], f64);

/// Rows of the third derivative along the ridges: vertices, their coefficients,
/// and the length that each row stands for.
///
/// Every edge of a ridge that goes on at both ends has one: the third divided difference, by chord length,
/// over its four vertices. It vanishes on straight lines and nearly so on arcs of circles. Edges bent by more
/// than `ridge` radians are ridges.
pub(super) fn third_derivatives(region: &Region, ridge: f64) -> Result<Vec<Row>> {
    let mesh = &region.mesh;
    let surface = FaceGeometry::of(region)?;
    let is_ridge =
        |&[a, b]: &[u32; 2]| mesh.wings(a, b).is_some_and(|wings| surface.dihedral(wings.faces) > ridge);
    let edges = memory::sifted(mesh.edges()?.into_iter().filter(is_ridge))?;
    let mut ends: Vec<Vec<u32>> = memory::repeated(Vec::new(), mesh.n_vertices())?;
    for &[a, b] in &edges {
        ends[a as usize].push(b);
        ends[b as usize].push(a);
    }
    let at = |v: u32| mesh.position(v);
    let beyond = |v: u32, from: u32| match *ends[v as usize].as_slice() {
        [a, b] => {
            let next = if a == from { b } else { a };
            let (before, after) = (sub(at(v), at(from)), sub(at(next), at(v)));
            (dot(before, after) > CORNER_COSINE * norm(before) * norm(after)).then_some(next)
        }
        _ => None,
    };
    let row = |&[b, c]: &[u32; 2]| {
        let vertices = [beyond(b, c)?, b, c, beyond(c, b)?];
        if vertices.iter().all(|&v| region.is_anchor(v)) || vertices[0] == vertices[3] {
            return None;
        }
        let mut places = [0.0; 4];
        for i in 0..3 {
            places[i + 1] = places[i] + distance(at(vertices[i]), at(vertices[i + 1]));
        }
        let others = |i: usize| (0..4).filter(move |&j| j != i);
        let coefficients =
            [0, 1, 2, 3].map(|i| 6.0 / others(i).map(|j| places[i] - places[j]).product::<f64>());
        coefficients.iter().all(|c| c.is_finite()).then_some((vertices, coefficients, places[2] - places[1]))
    };
    Ok(memory::sifted(edges.iter().filter_map(row))?)
}
