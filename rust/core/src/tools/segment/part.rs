//! Segmenting some faces only.

use super::options::SegmentOptions;
use super::segmentation::Segmentation;
use crate::error::MeshError;
use crate::linear::Columns;
use crate::mesh::Mesh;
use crate::{memory, Result};

/// Runs `segment` on the mesh of the faces in `mask` and puts its result into the whole one: other faces have
/// the label −1 and the indicator 1, other vertices keep their values.
///
/// # Errors
/// [`MeshError::NoPositions`], and what `segment` returns.
pub(super) fn segment_part(
    mesh: &Mesh,
    values: Option<&Columns>,
    mask: &[bool],
    options: &SegmentOptions,
    segment: impl FnOnce(&Mesh, Option<&Columns>, &SegmentOptions) -> Result<Segmentation>,
) -> Result<Segmentation> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let all = mesh.connectivity().faces();
    let faces: Vec<u32> = memory::sifted((0..all.len() as u32).filter(|&f| mask[f as usize]))?;
    let mut place = memory::repeated(u32::MAX, positions.len())?;
    let mut vertices = Vec::new();
    for &v in faces.iter().flat_map(|&f| &all[f as usize]) {
        if place[v as usize] == u32::MAX {
            place[v as usize] = vertices.len() as u32;
            memory::push(&mut vertices, v)?;
        }
    }
    let part = Mesh::new(
        memory::gathered(vertices.iter().map(|&v| positions[v as usize]))?,
        memory::gathered(faces.iter().map(|&f| all[f as usize].map(|v| place[v as usize])))?,
    )?;
    let whole = match values {
        Some(values) => values.copied()?,
        None => Columns::from_points(positions)?,
    };
    let some = |columns: &Columns| -> Result<Columns> {
        let mut data = memory::room(vertices.len() * columns.n_columns)?;
        for c in 0..columns.n_columns {
            data.extend(vertices.iter().map(|&v| columns.column(c)[v as usize]));
        }
        Ok(Columns { n_rows: vertices.len(), n_columns: columns.n_columns, data })
    };
    let of_faces = |w: &Vec<f64>| memory::gathered(faces.iter().map(|&f| w[f as usize]));
    let of_edges = |w: &Vec<[f64; 3]>| memory::gathered(faces.iter().map(|&f| w[f as usize]));
    let options = SegmentOptions {
        face_weights: options.face_weights.as_ref().map(of_faces).transpose()?,
        edge_weights: options.edge_weights.as_ref().map(of_edges).transpose()?,
        ..options.without_arrays()
    };
    let found = segment(&part, values.map(some).transpose()?.as_ref(), &options)?;
    let mut labels = memory::repeated(-1, all.len())?;
    let mut indicator = memory::repeated(1.0, all.len())?;
    for (i, &f) in faces.iter().enumerate() {
        labels[f as usize] = found.labels[i];
        indicator[f as usize] = found.indicator[i];
    }
    let mut filled = whole;
    for c in 0..filled.n_columns {
        let column = filled.column_mut(c);
        vertices.iter().zip(found.values.column(c)).for_each(|(&v, x)| column[v as usize] = *x);
    }
    let edges = found.boundary_edges.iter();
    Ok(Segmentation {
        labels,
        indicator,
        values: filled,
        boundary_edges: memory::gathered(edges.map(|edge| edge.map(|v| vertices[v as usize])))?,
        hierarchy: found.hierarchy.spread(&faces, all.len())?,
        ..found
    })
}
