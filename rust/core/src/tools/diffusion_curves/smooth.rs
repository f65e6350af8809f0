//! Curves without saw teeth, to be looked at: their colors stay at vertices.

use super::chains::border_edges;
use super::constants::{FARTHEST, SMOOTH_STEPS};
use crate::error::MeshError;
use crate::memory::{self, Tool};
use crate::mesh::vector::{add, distance, scale, sub, Point};
use crate::mesh::{EdgeTable, Mesh};
use crate::remesh::closest::ClosestPoint;
use crate::{Error, Result};

/// A place for each end of each edge of curves on a mesh: near the vertex, on the surface,
/// and on smooth lines.
///
/// The places of one vertex are the same. Ends of curves and vertices on the rim of the mesh stay where they
/// are.
///
/// Source: Taubin 1995 (Laplacian smoothing), with bounded steps.
///
/// # Errors
/// [`MeshError::NoPositions`]; [`Error::Argument`] for vertices that do not exist.
pub fn smooth_curves(mesh: &Mesh, edges: &[[u32; 2]]) -> Result<Vec<[Point; 2]>> {
    let original = mesh.positions().ok_or(MeshError::NoPositions)?;
    let unit = mesh.unit();
    let measured = mesh.measured(unit)?;
    let positions = measured.positions().ok_or(MeshError::NoPositions)?;
    let connectivity = mesh.connectivity();
    if let Some(v) = edges.iter().flatten().find(|&&v| v as usize >= positions.len()) {
        return Err(Error::argument(
            "edges",
            format!("vertex {v} does not exist: there are {}", positions.len()),
        ));
    }
    mesh.demand(Tool::Curves).admit(None)?;
    let mut around = memory::repeated(Vec::new(), positions.len())?;
    for &[a, b] in edges.iter().filter(|[a, b]| a != b) {
        around[a as usize].push(b);
        around[b as usize].push(a);
    }
    let mut fixed = memory::repeated(false, positions.len())?;
    let table = EdgeTable::new(connectivity)?;
    let rims = border_edges(connectivity, &table, &memory::repeated(0, connectivity.n_faces())?, true)?;
    rims.iter().flat_map(|edge| edge.ends).for_each(|v| fixed[v as usize] = true);
    let is_moving = |&v: &u32| around[v as usize].len() > 1 && !fixed[v as usize];
    let moving = memory::sifted((0..positions.len() as u32).filter(is_moving))?;
    let mean = |v: u32, value: &dyn Fn(u32) -> Point| {
        let others = &around[v as usize];
        let sum = others.iter().map(|&u| value(u)).fold([0.0; 3], add);
        scale(sum, 1.0 / others.len() as f64)
    };
    let reach = |v: u32| {
        let lengths =
            around[v as usize].iter().map(|&u| distance(positions[u as usize], positions[v as usize]));
        FARTHEST * lengths.sum::<f64>() / around[v as usize].len() as f64
    };
    let mut places = memory::twin(positions)?;
    for _ in 0..SMOOTH_STEPS {
        let next = memory::gathered(moving.iter().map(|&v| {
            let (here, home) = (places[v as usize], positions[v as usize]);
            let away = sub(scale(add(here, mean(v, &|u| places[u as usize])), 0.5), home);
            let (far, most) = (distance(away, [0.0; 3]), reach(v));
            add(home, scale(away, if far > most { most / far } else { 1.0 }))
        }))?;
        moving.iter().zip(next).for_each(|(&v, place)| places[v as usize] = place);
    }
    if !moving.is_empty() {
        let corners = connectivity.faces().iter().map(|face| face.map(|v| positions[v as usize]));
        let tree = ClosestPoint::new(memory::gathered(corners)?)?;
        for v in moving {
            let place = &mut places[v as usize];
            *place = tree.closest(*place, None, |_| true).map_or(*place, |closest| closest.point);
        }
    }
    unit.restore_points(&mut places, positions, original);
    Ok(memory::gathered(edges.iter().map(|edge| edge.map(|v| places[v as usize])))?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes;

    #[test]
    fn teeth_become_a_straight_line_between_them() {
        // Up and down between two rows of a grid.
        let shape = shapes::grid(30, 4);
        let mesh = shape.mesh().unwrap();
        let vertex = |i: u32| 31 * (1 + i % 2) + i;
        let edges: Vec<[u32; 2]> = (1..29).map(|i| [vertex(i), vertex(i + 1)]).collect();
        let places = smooth_curves(&mesh, &edges).unwrap();
        for pair in &places[9..19] {
            assert!(pair.iter().all(|p| (p[1] - 1.5).abs() < 0.1 && p[2] == 0.0), "{pair:?}");
        }
        assert!(places.windows(2).all(|pair| pair[0][1] == pair[1][0]));
        assert_eq!(places[0][0], shape.vertices[vertex(1) as usize], "ends stay");
    }

    #[test]
    fn places_lie_on_the_surface_near_their_vertices() {
        let shape = shapes::icosphere(3);
        let mesh = shape.mesh().unwrap();
        let labels: Vec<i32> = shape
            .faces
            .iter()
            .map(|face| i32::from(face.iter().map(|&v| shape.vertices[v as usize][2]).sum::<f64>() > 0.3))
            .collect();
        let table = EdgeTable::new(mesh.connectivity()).unwrap();
        let edges: Vec<[u32; 2]> = border_edges(mesh.connectivity(), &table, &labels, false)
            .unwrap()
            .iter()
            .map(|edge| edge.ends)
            .collect();
        let places = smooth_curves(&mesh, &edges).unwrap();
        let length = |at: &dyn Fn(usize, usize) -> Point| {
            (0..edges.len()).map(|e| distance(at(e, 0), at(e, 1))).sum::<f64>()
        };
        let vertex = |e: usize, end: usize| shape.vertices[edges[e][end] as usize];
        assert!(length(&|e, end| places[e][end]) < 0.95 * length(&vertex));
        for (e, pair) in places.iter().enumerate() {
            for (end, &place) in pair.iter().enumerate() {
                assert!(distance(place, [0.0; 3]) > 0.98);
                assert!(distance(place, vertex(e, end)) < 0.15);
            }
        }
        assert!(smooth_curves(&mesh, &[[0, 642]]).is_err());
        assert!(smooth_curves(&mesh, &[]).unwrap().is_empty());
    }
}
