//! From the triangulation of a hole to a patch at the resolution of its rim.

use super::long_loops::Triangulation;
use super::options::FillOptions;
use super::polygon::Polygon;
use super::refinement::refine;
use super::rims::Rims;
use crate::memory;
use crate::mesh::vector::{distance, norm, Point};
use crate::remesh::curves::Keep;
use crate::remesh::isotropic::run;
use crate::remesh::remesher::{Reference, Remesher};
use crate::remesh::sizing::{length_and_growth, Sizing};
use crate::remesh::{budget, guard, EditableMesh};
use crate::{Progress, Result};

/// A patch with a bend beyond this (120 degrees) that was not there before it was remeshed is taken as it
/// was: narrow tongues of surface that reach into a hole can make the passes lay faces back against them.
const LAID_BACK: f64 = -0.5;

/// Refines and remeshes a triangulation. Returns the new points, and the faces as places in the polygon;
/// places from its length on are the new points.
///
/// Edges are as long as those of the rim, interpolated smoothly where these differ, or `edge_length`. If that
/// would take more faces than `max_faces` they grow with their distance from the rim, or are as short as they
/// can be ([`length_and_growth`]); a rim that needs more even so gets them.
pub(super) fn refined(
    polygon: &Polygon,
    flat: &Triangulation,
    rims: &Rims,
    options: &FillOptions,
    progress: &Progress,
) -> Result<(Vec<Point>, Vec<[u32; 3]>)> {
    let n = polygon.len();
    let points = memory::sifted(polygon.points.iter().chain(&flat.extra).copied())?;
    let mut mesh = EditableMesh::new(points, memory::twin(&flat.faces)?)?;
    for [a, b] in rims.chords(&polygon.vertices) {
        mesh.forbid_edge(a, b);
    }
    for (i, &normal) in polygon.outside.iter().enumerate() {
        mesh.set_beyond(i as u32, ((i + 1) % n) as u32, normal);
    }
    let surface = Reference::of(&mesh)?;
    let rim_edges =
        memory::gathered((0..n).map(|i| distance(polygon.points[i], polygon.points[(i + 1) % n])))?;
    let rim_length: f64 = rim_edges.iter().sum();
    let rim_size = |i: usize| 0.5 * (rim_edges[i] + rim_edges[(i + n - 1) % n]);
    let area: f64 = mesh.faces().map(|(f, _)| norm(mesh.area_vector(f))).sum();
    if let Some(length) = options.edge_length {
        budget::check_length(mesh.faces().map(|(_, face)| mesh.corners(face)), length)?;
    }
    let (typical, growth) =
        length_and_growth(area, rim_length, rim_length / n as f64, options.edge_length, options.max_faces);
    let size_at = |i: usize| options.edge_length.map_or(rim_size(i), |_| typical.max(rim_size(i)));
    let mut sizes = memory::sifted((0..n).map(size_at).chain(flat.extra.iter().map(|_| typical)))?;
    // Sizes that grow by as much for every unit of distance, from the nearest corner as from any other: means
    // of them would be those of the middle of the hole a third of the way from there to the rim, and leave
    // needles all around.
    let grown = |sizes: [f64; 3], far: [f64; 3]| {
        sizes.iter().zip(far).map(|(size, far)| size + growth * far).fold(f64::INFINITY, f64::min)
    };
    let size_between = |sizes: [f64; 3], far: [f64; 3]| match options.edge_length {
        _ if growth > 0.0 => grown(sizes, far),
        Some(_) => typical,
        None => sizes.iter().sum::<f64>() / 3.0,
    };
    let most = budget::patch_faces(options.max_faces, n);
    refine(&mut mesh, &mut sizes, size_between, most, progress)?;
    let refined = (mesh.twin()?, guard::worst_bend(&mesh));
    let fixed = memory::gathered((0..mesh.n_vertices()).map(|v| v < n))?;
    let keep = Keep { fixed: &fixed, fixed_faces: false, feature_cosine: -2.0, features: None };
    let remeshed = |mesh: EditableMesh| {
        let mut remesher = Remesher::new(mesh, &surface, &keep, |mesh, curves| match options.edge_length {
            Some(_) => Sizing::uniform(typical, growth, mesh, curves),
            None => Sizing::graded(memory::twin(&sizes)?, growth, mesh, curves),
        })?;
        run(&mut remesher, options.remesh_iterations, most, progress)?;
        let bend = guard::worst_bend(&remesher.mesh);
        Ok::<_, crate::Error>((remesher.mesh, bend < LAID_BACK && bend < refined.1))
    };
    let (mut mesh, mut is_folded) = remeshed(mesh)?;
    if is_folded && options.edge_length.is_some() {
        // Short edges beside long ones of the rim take many small moves.
        let mut again = refined.0.twin()?;
        again.look_at_every_bend();
        (mesh, is_folded) = remeshed(again)?;
    }
    let mesh = if is_folded { refined.0 } else { mesh };
    let (points, faces, _) = mesh.into_parts(|v| (v as usize) < n)?;
    Ok((memory::twin(&points[n..])?, faces))
}
