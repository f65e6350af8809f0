//! Parts: limbs, heads and handles, as people name them.
//!
//! People cut where a closed curve is short against what it cuts off, runs through hollows, or where the
//! thickness changes. The faces become a graph whose edges cost that ([`surface`], [`hollows`],
//! [`thickness`]), pieces that nothing joins are joined to what is near ([`stitch`]), large meshes become
//! a few thousand [`clusters`]. Then the part with the cheapest [`cut`] is divided, over and over
//! ([`division`]); the borders are drawn on the faces ([`borders`]), the count is chosen ([`choice`]), and
//! the parts are put in the order in which they become one where fewer are wanted ([`merging`]).

mod borders;
mod choice;
mod clusters;
mod constants;
mod cut;
mod diffusion;
mod division;
mod graph;
mod hollows;
mod merging;
mod options;
mod stitch;
mod surface;
mod thickness;
mod tighten;

pub use options::PartsOptions;

use crate::memory::{self, Tool};
use crate::mesh::partition::Partition;
use crate::mesh::Mesh;
use crate::progress::{Progress, Report};
use crate::solve::Status;
use crate::tools::segment::{boundary_edges, Hierarchy};
use crate::Result;
use borders::Drawn;
use graph::Graph;
use merging::{Beyond, Merging};
use surface::Surface;

/// What came out of a division into parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// The part of each face, from 0 in the order of their first faces; −1 for faces that took no part.
    pub labels: Vec<i32>,
    /// How many parts there are.
    pub n_parts: usize,
    /// The vertices of the edges between parts.
    pub boundary_edges: Vec<[u32; 2]>,
    /// Coarser and finer divisions, nested, in the order of what they are worth; the strength of a border is
    /// one over what its cut costs.
    pub hierarchy: Hierarchy,
    /// `Solved`, or `Stopped` if the caller asked to finish early: then with fewer parts at most.
    pub status: Status,
}

/// Divides the faces of `mesh` into the parts that people would name.
///
/// Meshes of any kind: the sides of seams are joined, as in other tools, and vertices at the very same place
/// count as one; normals are turned to agree, pieces are joined to what is near.
///
/// # Errors
/// [`crate::error::MeshError::NoPositions`], [`crate::error::MeshError::NoFaces`], arguments of the wrong
/// shape or range, [`crate::Error::Cancelled`], and the errors of the eigenproblems.
pub fn parts(mesh: &Mesh, options: &PartsOptions, progress: &Progress) -> Result<Parts> {
    options.check(mesh)?;
    options.solve().run(|| {
        mesh.demand(Tool::Parts).admit(None)?;
        found(mesh, options, progress)
    })
}

fn found(mesh: &Mesh, options: &PartsOptions, progress: &Progress) -> Result<Parts> {
    let n_faces = mesh.connectivity().n_faces();
    let is_chosen = |&f: &u32| options.faces.as_ref().is_none_or(|mask| mask[f as usize]);
    let faces = memory::sifted((0..n_faces as u32).filter(is_chosen))?;
    say(progress, "measuring");
    let surface = Surface::new(mesh, &faces, |h| options.weight(h))?;
    let graph = hollows::border_graph(&surface, progress)?;
    let usual = hollows::usual_part(&surface, &graph);
    let (graph, pieces) = stitch::stitched(&surface, graph)?;
    let (clusters, n_clusters) = clusters::clusters(&graph, progress)?;
    let coarse = graph.quotient(&clusters, n_clusters)?;
    say(progress, "dividing");
    let divisions = division::divisions(&coarse, options.n_parts, progress)?;
    say(progress, "drawing borders");
    let drawn = borders::drawn(&graph, &clusters, n_clusters, &divisions, progress)?;
    let (hierarchy, found) = nested(&graph, &pieces, drawn, options, usual)?;
    let hierarchy = hierarchy.spread(&faces, n_faces)?;
    let n_parts = options.n_parts.unwrap_or(found).min(hierarchy.range()[0]);
    let labels = hierarchy.labels_at(n_parts)?;
    let status = if progress.is_finishing() { Status::Stopped } else { Status::Solved };
    Ok(Parts { boundary_edges: boundary_edges(mesh, &labels)?, labels, n_parts, hierarchy, status })
}

/// Divisions of every count, and how many parts people would see: what is divided cheaply stays longest, and
/// what is found stays longer than all others. `usual` is the part of its length that a border costs at an
/// average place.
fn nested(
    graph: &Graph,
    pieces: &[u32],
    drawn: Drawn,
    options: &PartsOptions,
    usual: f64,
) -> Result<(Hierarchy, usize)> {
    let count = drawn.divisions.len() + 1;
    let first = drawn.divisions.partition_point(|(_, cost)| *cost <= options.most_cost());
    let mut origin: Vec<u32> = (0..=first as u32).collect();
    drawn.divisions.iter().skip(first).for_each(|([part, _], _)| origin.push(origin[*part as usize]));
    let (labels, limit) = (&drawn.labels, options.even_cost(usual));
    let merges = Merging::new(graph, pieces, labels, origin, limit, Beyond::Pairs)?.merges();
    let found = choice::count(&merges, limit);
    let mut origin = Partition::new(count)?;
    merges[..count - found].iter().for_each(|merge| origin.unite(merge.pair[0], merge.pair[1]));
    let origin = (0..count as u32).map(|part| origin.root(part)).collect();
    let merges = Merging::new(graph, pieces, labels, origin, limit, Beyond::Shape)?.merges();
    let strengths = merges.iter().map(|merge| (merge.pair, 1.0 / merge.price.max(f64::MIN_POSITIVE)));
    Ok((Hierarchy::new(drawn.labels, count, strengths), found))
}

fn say(progress: &Progress, stage: &str) {
    progress.report(Report { stage: stage.into(), ..Report::default() });
}
