//! Facets: a mesh as a polyhedron of flat polygons with straight ridges, as a low-poly artist models.
//!
//! Faces are merged into regions ([`regions`]), always those that cost least ([`merging`], after Garland,
//! Willmott and Heckbert 2001), as long as the regions can be the facets of a polyhedron ([`verdict`]). Where
//! three regions meet is a corner ([`shape`]). Then planes and corners are found together, such that every
//! corner lies on all of its planes and the planes are near the faces ([`mod@solve`]); facets that cross
//! themselves or others ([`faults`], [`crossings`]) are repaired ([`mod@repair`]), or the merges that made
//! them refused ([`refusals`], [`search`]), and what is too many then is joined ([`reducing`]); faces are
//! given to the nearest facet, and the planes fitted anew, in turns ([`fitting`]), as in variational shape
//! approximation [Cohen-Steiner, Alliez and Desbrun 2004]. Facets of a large mesh are found on a coarser one
//! ([`on_coarser`]).

mod borders;
mod coarse;
mod constants;
mod count;
mod crossings;
mod doubling;
mod faces;
mod faceted;
mod faults;
mod fitting;
mod hierarchy;
mod hubs;
mod job;
mod joining;
mod keeping;
mod merging;
mod mirror;
mod moments;
mod nearest;
mod on_coarser;
mod options;
mod planes;
mod reducing;
mod refusals;
mod regions;
mod repair;
mod search;
mod shape;
mod skin;
mod solve;
mod stage;
mod straight;
mod symmetry;
mod triangulation;
mod unfolding;
mod verdict;
mod volume;

pub use faceted::{FacetMerges, Faceted};
pub use keeping::KeptTriangles;
pub use options::{FacetOptions, Symmetric};

use crate::error::MeshError;
use crate::memory::{self, Tool};
use crate::mesh::vector::{add, scale};
use crate::mesh::{CutMesh, Mesh, Working};
use crate::progress::Progress;
use crate::solve::Status;
use crate::tools::answer::{self, Surroundings};
use crate::tools::options::ENOUGH;
use crate::Result;
use job::Job;
use mirror::Mirror;
use regions::OUTSIDE;
use search::Found;

/// Makes facets of `mesh`. With the `merges` of an earlier call, of the same mesh, mask and weights,
/// that part is not done again.
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`], arguments of the wrong shape or range,
/// [`crate::Error::Cancelled`], [`crate::Error::Memory`].
pub fn facet(
    mesh: &Mesh,
    merges: Option<&FacetMerges>,
    options: &FacetOptions,
    progress: &Progress,
) -> Result<Faceted> {
    options.check(mesh)?;
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    // Where faces stay, so does what they share.
    let may_part = !options.keep_triangles && options.faces.is_none();
    let touching = if may_part { CutMesh::of_touching(mesh.connectivity(), positions)? } else { None };
    let Some(CutMesh { faces, vertices }) = touching else { return of(mesh, merges, options, progress) };
    let points = memory::gathered(vertices.iter().map(|&v| positions[v as usize]))?;
    let mut found = of(&Mesh::new(points, faces)?, merges, options, progress)?;
    found.origins.iter_mut().for_each(|origin| *origin = vertices[*origin as usize]);
    Ok(found)
}

/// The same of a mesh whose surfaces touch along no edge, or stay together there.
fn of(
    mesh: &Mesh,
    merges: Option<&FacetMerges>,
    options: &FacetOptions,
    progress: &Progress,
) -> Result<Faceted> {
    match options.symmetric {
        Some(symmetric) => {
            let half = symmetry::Half::new(mesh, symmetric)?;
            half.facets(mesh, merges, options, progress, |merges, options, progress| {
                run(&half.mesh, merges, options, Some(half.mirror), progress)
            })
        }
        None => run(mesh, merges, options, None, progress),
    }
}

/// The facets of a mesh that ends at a mirror's plane, if there is one.
fn run(
    mesh: &Mesh,
    merges: Option<&FacetMerges>,
    options: &FacetOptions,
    mirror: Option<Mirror>,
    progress: &Progress,
) -> Result<Faceted> {
    options.solve().run(|| {
        let by_levels = options.use_levels(mesh.connectivity().n_vertices(), ENOUGH);
        mesh.demand(if by_levels { Tool::FacetByLevels } else { Tool::Facet }).admit(None)?;
        let working = Working::contracted(mesh)?;
        let job = Job::new(&working, options, mirror)?;
        let scan = job.scan(options)?;
        if scan.area.is_nan() || scan.area <= 0.0 {
            return Err(MeshError::NoFaces.into());
        }
        if options.keep_volume {
            // Before the work, so that a mesh that is open costs nothing.
            job.volume(&scan.places)?;
        }
        let (found, merges) = match job.found_on_coarser(&scan, merges, options, progress)? {
            Some(found) => found,
            None => {
                if by_levels {
                    mesh.demand(Tool::Facet).admit(None)?;
                }
                let merges = match merges.filter(|known| known.coarse.is_none()) {
                    Some(known) if known.merges.are_all => known.merges.twin()?,
                    _ => job.merges(&scan, options, progress)?,
                };
                let found = if merges.are_all {
                    job.found(&merges, &scan, options, progress)?
                } else {
                    // Half of the merges are no facets yet, and to make them sound takes as long as the rest
                    // would.
                    job.as_it_is(&merges, &scan, progress)?
                };
                (found, FacetMerges { merges, coarse: None })
            }
        };
        let found = job.given(mesh, found, merges, progress)?;
        let (positions, corners) = (mesh.positions().unwrap_or_default(), mesh.connectivity().faces());
        let around = Surroundings::of(corners.iter().flatten().map(|&v| &positions[v as usize]));
        if found.faces.iter().flatten().all(|&v| around.hold([&found.vertices[v as usize]])) {
            Ok(found)
        } else {
            Err(answer::refused())
        }
    })
}

impl Job<'_> {
    /// The result in the mesh's own coordinates.
    fn given(&self, mesh: &Mesh, found: Found, merges: FacetMerges, progress: &Progress) -> Result<Faceted> {
        let kept = self.keeps.then(|| self.kept(&found, progress)).transpose()?;
        let Found { shape, inspection, labels, distances, n_facets, n_crossings } = found;
        let original = mesh.positions().unwrap_or_default();
        let n_corners = shape.corners.len();
        let mut names = memory::repeated(OUTSIDE, n_corners)?;
        let (mut vertices, mut origins) = (memory::room(n_corners)?, memory::room(n_corners)?);
        let mut name = |c: u32| {
            if names[c as usize] == OUTSIDE {
                names[c as usize] = vertices.len() as u32;
                let corner = &shape.corners[c as usize];
                let origin = self.working.original(corner.vertex);
                let is_there = corner.point == self.positions[corner.vertex as usize];
                let place = || self.working.place(add(self.center, scale(corner.point, self.diagonal)));
                vertices.push(if is_there { original[origin as usize] } else { place() });
                origins.push(origin);
            }
            names[c as usize]
        };
        let faces: Vec<[u32; 3]> = memory::gathered(inspection.triangles.iter().map(|t| t.map(&mut name)))?;
        let (mut polygons, mut polygon_facets) = (Vec::new(), Vec::new());
        let mut start = 0;
        for group in inspection.owners.chunk_by(|a, b| a == b) {
            for polygon in triangulation::polygons(&faces[start..start + group.len()])? {
                memory::push(&mut polygons, polygon)?;
                memory::push(&mut polygon_facets, group[0])?;
            }
            start += group.len();
        }
        let mut of_faces = memory::repeated(-1, mesh.connectivity().n_faces())?;
        self.parts.iter().zip(labels).for_each(|(&f, label)| of_faces[f as usize] = label as i32);
        let plane = |facet: &shape::Facet| {
            let on = self
                .working
                .place(add(self.center, scale(facet.plane.normal, facet.plane.offset * self.diagonal)));
            let normal = facet.plane.normal;
            [normal[0], normal[1], normal[2], crate::mesh::vector::dot(normal, on)]
        };
        Ok(Faceted {
            vertices,
            origins,
            polygons,
            polygon_facets,
            face_facets: inspection.owners,
            faces,
            labels: of_faces,
            planes: memory::gathered(shape.facets.iter().map(plane))?,
            n_facets,
            rms: distances.rms * self.diagonal,
            largest: distances.largest * self.diagonal,
            n_crossings,
            kept,
            status: if progress.is_finishing() { Status::Stopped } else { Status::Solved },
            merges,
        })
    }
}
