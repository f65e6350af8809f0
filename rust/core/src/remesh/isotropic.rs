//! Isotropic remeshing [Botsch and Kobbelt 2004].

use crate::error::{Error, MeshError};
use crate::memory::{self, Demand, Tool};
use crate::mesh::vector::{norm, Point};
use crate::mesh::Mesh;
use crate::progress::Report;
use crate::remesh::budget;
use crate::remesh::collapse::collapse_short_edges;
use crate::remesh::curves::Keep;
use crate::remesh::flips::equalize_valences;
use crate::remesh::relax::relax_and_project;
use crate::remesh::remesher::{Reference, Remesher};
use crate::remesh::repair::remove_slivers;
use crate::remesh::sizing::{Sizing, EQUILATERAL};
use crate::remesh::split::split_long_edges;
use crate::remesh::EditableMesh;
use crate::{Progress, Result};

/// More rounds than these are a slip of the pen: a mesh has settled after some ten.
const MOST_ITERATIONS: usize = 10_000;

/// How a mesh is remeshed.
#[derive(Debug, Clone, PartialEq)]
pub struct RemeshOptions {
    /// The target edge length, > 0; without it, the mean of the mesh's.
    pub edge_length: Option<f64>,
    /// Rounds of all passes, at most 10,000.
    pub iterations: usize,
    /// Vertices that stay, bit by bit, and with them the border and feature edges between two of them and the
    /// faces with three.
    pub fixed: Option<Vec<bool>>,
    /// Edges whose faces turn by more than this, in radians,
    /// are kept as lines on which vertices may slide; without it, none.
    pub feature_angle: Option<f64>,
}

impl Default for RemeshOptions {
    fn default() -> Self {
        Self {
            edge_length: None,
            iterations: 10,
            fixed: None,
            feature_angle: Some(std::f64::consts::FRAC_PI_4),
        }
    }
}

/// A remeshed surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Remeshed {
    /// Positions.
    pub vertices: Vec<Point>,
    /// Vertex triples.
    pub faces: Vec<[u32; 3]>,
    /// For every vertex, which vertex of the input it is if it has not moved: fixed vertices,
    /// corners, non-manifold ones.
    pub origin: Vec<Option<u32>>,
    /// Rounds done.
    pub iterations: usize,
    /// The target edge length.
    pub edge_length: f64,
}

/// Remeshes a surface with edges of about the same length and triangles close to equilateral,
/// without moving it.
///
/// Each round splits edges longer than 4/3 of the target, collapses those shorter than 4/5, flips edges
/// toward valence 6, moves vertices tangentially to the center of their neighbors and projects them back onto
/// the input. Borders and feature lines keep their course and their corners; non-manifold edges stay. No edit
/// is made that folds the surface or makes a sliver; slivers that are left are removed at the end where
/// possible. A face that names a vertex twice is dropped, and so are vertices without faces unless they are
/// fixed.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`]; [`Error::Argument`] for a target length that is not
/// finite and positive or asks for more than 50 million faces, for a mask of the wrong length and an angle
/// outside of 0 to π; [`Error::Cancelled`].
pub fn remesh(mesh: &Mesh, options: &RemeshOptions, progress: &Progress) -> Result<Remeshed> {
    let original = mesh.positions().ok_or(MeshError::NoPositions)?;
    let unit = mesh.unit();
    let edge_length = options.edge_length.map(|length| unit.measure(length));
    let mut found = in_its_unit(mesh.measured(unit)?.as_ref(), edge_length, options, progress)?;
    for (vertex, origin) in found.vertices.iter_mut().zip(&found.origin) {
        *vertex = origin.map_or_else(|| vertex.map(|x| unit.restore(x)), |v| original[v as usize]);
    }
    found.edge_length = options.edge_length.unwrap_or_else(|| unit.restore(found.edge_length));
    Ok(found)
}

/// [`remesh`] of a mesh whose size is sane, with a target in its unit.
fn in_its_unit(
    mesh: &Mesh,
    edge_length: Option<f64>,
    options: &RemeshOptions,
    progress: &Progress,
) -> Result<Remeshed> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let n_given = options.fixed.as_ref().map_or(positions.len(), Vec::len);
    if n_given != positions.len() {
        let problem = format!("expected one entry for each of {} vertices, got {n_given}", positions.len());
        return Err(Error::argument("fixed", problem));
    }
    if options.iterations > MOST_ITERATIONS {
        let problem = format!("got {}; pass at most {MOST_ITERATIONS}", options.iterations);
        return Err(Error::argument("iterations", problem));
    }
    mesh.demand(Tool::Remesh).admit(None)?;
    let fixed = match &options.fixed {
        Some(fixed) => memory::twin(fixed)?,
        None => memory::repeated(false, positions.len())?,
    };
    let faces = memory::twin(mesh.connectivity().faces())?;
    let editable = EditableMesh::new(memory::twin(positions)?, faces)?;
    let area: f64 = editable.faces().map(|(f, _)| norm(editable.area_vector(f))).sum();
    if area <= 0.0 {
        return Err(MeshError::NoFaces.into());
    }
    let edge_length = match edge_length {
        Some(length) => length,
        None => mean_edge_length(&editable)?,
    };
    budget::check_length(editable.faces().map(|(_, face)| editable.corners(face)), edge_length)?;
    admit(mesh, area, edge_length)?;
    let feature_cosine = match options.feature_angle {
        None => -2.0,
        Some(angle) if (0.0..=std::f64::consts::PI).contains(&angle) => angle.cos(),
        Some(angle) => {
            return Err(Error::argument("feature_angle", format!("got {angle}; pass 0 to 180 degrees")))
        }
    };
    let keep = Keep { fixed: &fixed, fixed_faces: true, feature_cosine, features: None };
    let surface = Reference::of(&editable)?;
    let mut remesher = Remesher::new(editable, &surface, &keep, |mesh, curves| {
        Sizing::uniform(edge_length, 0.0, mesh, curves)
    })?;
    let iterations = run(&mut remesher, options.iterations, usize::MAX, progress)?;
    let moved = |v: u32| remesher.is_movable(v);
    let movable = memory::sifted((0..remesher.mesh.n_vertices() as u32).map(moved))?;
    let (vertices, faces, kept) =
        remesher.mesh.into_parts(|v| fixed.get(v as usize).copied().unwrap_or(false))?;
    let origin = memory::gathered(kept.into_iter().map(|v| (!movable[v as usize]).then_some(v)))?;
    Ok(Remeshed { vertices, faces, origin, iterations, edge_length })
}

/// Refuses what does not fit into memory where the length asks for more faces than the mesh has.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn admit(mesh: &Mesh, area: f64, edge_length: f64) -> Result<()> {
    let wanted = (area / (EQUILATERAL * edge_length * edge_length)) as usize;
    // As many as there are were asked for before anything was taken.
    if wanted > mesh.connectivity().n_faces() {
        Demand { n_faces: wanted, ..mesh.demand(Tool::Remesh) }.admit(None)?;
    }
    Ok(())
}

/// The passes, `iterations` times, then the removal of slivers. Returns the number of whole rounds done;
/// every pass leaves a mesh at every moment, and stops in the middle when the caller wishes to. The mesh is
/// to have about `most` faces at most.
pub(crate) fn run(
    remesher: &mut Remesher,
    iterations: usize,
    most: usize,
    progress: &Progress,
) -> Result<usize> {
    progress.check()?;
    for iteration in 0..iterations {
        if progress.is_finishing() {
            return Ok(iteration);
        }
        let fraction = iteration as f64 / iterations as f64;
        progress.report(Report { fraction, stage: "remesh".into(), iteration, ..Report::default() });
        remesher.sizing.update(&remesher.mesh)?;
        let wanted = |(_, face): (u32, [u32; 3])| {
            (remesher.mesh.corners(face), face.iter().map(|&v| remesher.sizing.at(v)).sum::<f64>() / 3.0)
        };
        let to_add = budget::faces_to_add(remesher.mesh.faces().map(wanted), most);
        split_long_edges(remesher, to_add, progress)?;
        collapse_short_edges(remesher, progress)?;
        equalize_valences(remesher, progress)?;
        relax_and_project(remesher, progress)?;
        progress.check()?;
        if progress.is_finishing() {
            return Ok(iteration);
        }
    }
    if iterations > 0 {
        remove_slivers(remesher, progress)?;
    }
    progress.check()?;
    Ok(iterations)
}

fn mean_edge_length(mesh: &EditableMesh) -> Result<f64> {
    let edges = mesh.edges()?;
    let sum: f64 =
        edges.iter().map(|&[a, b]| crate::mesh::vector::distance(mesh.position(a), mesh.position(b))).sum();
    Ok(sum / edges.len().max(1) as f64)
}
