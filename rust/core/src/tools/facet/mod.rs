//! Facets: a mesh as a polyhedron of flat polygons with straight ridges, as a low-poly artist models.
//!
//! Faces are merged into regions, always those that cost least ([`merging`], after Garland, Willmott and
//! Heckbert 2001), as long as the regions can be the facets of a polyhedron ([`regions`]). Where three
//! regions meet is a corner ([`shape`]). Then planes and corners are found together, such that every corner
//! lies on all of its planes and the planes are near the faces ([`mod@solve`]); facets that cross themselves
//! or others ([`faults`], [`crossings`]) are repaired ([`mod@repair`]); faces are given to the nearest facet,
//! and the planes fitted anew, in turns ([`fitting`]), as in variational shape approximation [Cohen-Steiner,
//! Alliez and Desbrun 2004].

mod constants;
mod count;
mod crossings;
mod faces;
mod faults;
mod fitting;
mod merging;
mod moments;
mod options;
mod regions;
mod repair;
mod shape;
mod solve;
mod triangulation;

pub use options::FacetOptions;

use crate::error::MeshError;
use crate::memory::{self, Tool};
use crate::mesh::vector::{add, between, distance, scale, sub, Point};
use crate::mesh::{Mesh, Working};
use crate::progress::{Progress, Report};
use crate::solve::Status;
use crate::Result;
use constants::{CHANGE, COUNTS};
use count::Wanted;
use faces::{Distances, Faces};
use faults::Inspection;
use merging::{merges, Merges};
use moments::Moments;
use regions::{Regions, OUTSIDE};
use shape::Shape;

/// A mesh made of facets.
#[derive(Debug, Clone, PartialEq)]
pub struct Faceted {
    /// The corners of the facets, and the vertices of faces that were to stay.
    pub vertices: Vec<Point>,
    /// The vertex of the mesh where each vertex comes from.
    pub origins: Vec<u32>,
    /// The facets as simple polygons, counterclockwise seen from outside; one with holes is several.
    pub polygons: Vec<Vec<u32>>,
    /// The facet of each polygon.
    pub polygon_facets: Vec<u32>,
    /// The facets as triangles.
    pub faces: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub face_facets: Vec<u32>,
    /// The facet nearest to each face of the mesh; −1 for faces that name a vertex twice.
    pub labels: Vec<i32>,
    /// The plane of each facet: its unit normal and its distance from the origin along that.
    pub planes: Vec<[f64; 4]>,
    /// How many facets were made; further ones are faces that stayed.
    pub n_facets: usize,
    /// Root mean square distance from the faces of the mesh to the facets.
    pub rms: f64,
    /// The largest distance from the middle of a face.
    pub largest: f64,
    /// Pairs of facets that pass through each other, and do not on the mesh.
    pub n_crossings: usize,
    /// `Solved`, or `Stopped` if the caller asked to finish early.
    pub status: Status,
    /// What other numbers of facets start from.
    pub merges: FacetMerges,
}

/// The order in which faces were merged: with it other numbers of facets are quick,
/// and nested where they start.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FacetMerges(Merges);

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
    options.solve().run(|| {
        mesh.demand(Tool::Facet).admit(None)?;
        let working = Working::new(mesh)?;
        let job = Job::new(&working, options)?;
        let merges = match merges {
            Some(merges) => merges.0.clone(),
            None => job.merges(options, progress)?,
        };
        let found = job.found(&merges, options, progress)?;
        Ok(job.given(mesh, found, merges, progress))
    })
}

/// A mesh, moved and scaled to a box of diagonal 1 around the origin, and what of it takes part.
struct Job<'a> {
    working: &'a Working<'a>,
    center: Point,
    diagonal: f64,
    positions: Vec<Point>,
    /// Vertices that stay.
    is_fixed: Vec<bool>,
    /// Faces that name three vertices, in order; the others are none.
    parts: Vec<u32>,
    /// Of those: whether they are not to be merged.
    is_held: Vec<bool>,
}

/// What was made of a number of regions.
struct Found {
    shape: Shape,
    inspection: Inspection,
    labels: Vec<u32>,
    distances: Distances,
    n_facets: usize,
    n_crossings: usize,
}

/// Facets that are flat, with the faces that they stand for.
struct Settled {
    shape: Shape,
    faces: Faces,
    /// Pairs of facets that passed through each other when all corners were on the mesh.
    n_on_mesh: usize,
}

impl Settled {
    fn n_crossings(&self) -> Result<usize> {
        Ok(self.n_more(&Inspection::new(&self.shape, true)?))
    }

    /// How many more pairs pass through each other than on the mesh.
    fn n_more(&self, inspection: &Inspection) -> usize {
        inspection.pairs.len().saturating_sub(self.n_on_mesh)
    }

    fn distances(&self) -> Result<Distances> {
        Ok(self.faces.nearest(&self.shape, &Inspection::new(&self.shape, true)?)?.1)
    }
}

impl<'a> Job<'a> {
    fn new(working: &'a Working<'a>, options: &FacetOptions) -> Result<Self> {
        let here = working.mesh();
        let faces = here.connectivity().faces();
        let positions = here.positions().ok_or(MeshError::NoPositions)?;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in faces.iter().flatten().map(|&v| positions[v as usize]) {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
            }
        }
        let (center, diagonal) = (between(low, high, 0.5), distance(low, high));
        let is_sound = |f: &[u32; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
        let parts: Vec<u32> = (0..).zip(faces).filter(|(_, face)| is_sound(face)).map(|(f, _)| f).collect();
        if parts.is_empty() || !(diagonal > 0.0 && diagonal.is_finite()) {
            return Err(MeshError::NoFaces.into());
        }
        let mut is_fixed = vec![false; positions.len()];
        if let Some(mask) = &options.faces {
            let unselected = faces.iter().zip(mask).filter(|(_, &selected)| !selected);
            unselected.flat_map(|(face, _)| face).for_each(|&v| is_fixed[v as usize] = true);
        }
        let is_held = |&f: &u32| faces[f as usize].iter().any(|&v| is_fixed[v as usize]);
        Ok(Self {
            working,
            center,
            diagonal,
            positions: positions.iter().map(|&p| scale(sub(p, center), 1.0 / diagonal)).collect(),
            is_held: parts.iter().map(is_held).collect(),
            is_fixed,
            parts,
        })
    }

    /// Labels of all faces from those of the parts.
    fn labels(&self, of_parts: impl IntoIterator<Item = u32>) -> Vec<u32> {
        let mut labels = vec![OUTSIDE; self.working.mesh().connectivity().n_faces()];
        self.parts.iter().zip(of_parts).for_each(|(&f, label)| labels[f as usize] = label);
        labels
    }

    fn places(&self) -> Vec<[Point; 3]> {
        let faces = self.working.mesh().connectivity().faces();
        self.parts.iter().map(|&f| faces[f as usize].map(|v| self.positions[v as usize])).collect()
    }

    fn merges(&self, options: &FacetOptions, progress: &Progress) -> Result<Merges> {
        let connectivity = self.working.mesh().connectivity();
        let n = self.parts.len();
        let mut regions = Regions::new(connectivity, &self.positions, self.labels(0..n as u32), n);
        let moments = self.places().into_iter().map(Moments::of).collect();
        let rows = options.edge_weights.as_ref().map(|rows| self.working.corner_rows(rows)).transpose()?;
        let weight = |h: u32| {
            let of = |h: usize| rows.as_ref().map_or(1.0, |rows| rows[h / 3][h % 3]);
            connectivity.mate(h as usize).map_or(of(h as usize), |mate| of(h as usize).min(of(mate)))
        };
        merges(&mut regions, moments, &self.is_held, weight, progress)
    }

    /// The shape with as many facets as are wanted.
    fn found(&self, merges: &Merges, options: &FacetOptions, progress: &Progress) -> Result<Found> {
        let n_held = self.is_held.iter().filter(|held| **held).count();
        let wanted = match (options.facets, options.error) {
            (Some(facets), _) => Wanted::Facets(facets + n_held),
            (None, Some(error)) => Wanted::Error(error / self.diagonal),
            (None, None) => Wanted::Found,
        };
        let n = self.parts.len();
        let area = self.places().into_iter().map(|p| Moments::of(p).area).sum::<f64>().max(f64::MIN_POSITIVE);
        let [fewest, most] = merges.range(n);
        let mut count = merges.count(wanted, n, self.positions.len(), area);
        let aim = count as f64;
        let mut best: Option<(f64, Settled)> = None;
        for round in 0..COUNTS {
            let fraction = 0.5 + 0.5 * round as f64 / COUNTS as f64;
            progress.report(Report { fraction, stage: "fitting planes".into(), ..Report::default() });
            let mut settled = self.settled(merges, merges.whole(n, count), progress)?;
            let (miss, next) = match wanted {
                Wanted::Facets(_) => {
                    let off = aim - settled.shape.facets.len() as f64;
                    let most = CHANGE[0] + CHANGE[1] * count as f64;
                    let further = if off == 0.0 { 1.0 } else { off.clamp(-most, most).round() };
                    (off.abs() + settled.n_crossings()? as f64, count as f64 + further)
                }
                Wanted::Error(error) => {
                    fitting::refine(&mut settled.shape, &mut settled.faces, progress)?;
                    let over = settled.distances()?.rms / error;
                    ((over - 1.0).max(0.0), (count as f64 * over.max(1.05)).ceil())
                }
                Wanted::Found => (0.0, 0.0),
            };
            if best.as_ref().is_none_or(|(least, _)| miss < *least) {
                best = Some((miss, settled));
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let next = (next as usize).clamp(fewest, most);
            if miss == 0.0 || next == count || progress.is_finishing() {
                break;
            }
            count = next;
        }
        let (_, mut settled) = best.ok_or(MeshError::NoFaces)?;
        if !matches!(wanted, Wanted::Error(_)) {
            fitting::refine(&mut settled.shape, &mut settled.faces, progress)?;
        }
        fitting::fold(&mut settled.shape, &mut settled.faces)?;
        let n_facets = fitting::order(&mut settled.shape, &mut settled.faces);
        let inspection = Inspection::new(&settled.shape, true)?;
        let n_crossings = settled.n_more(&inspection);
        let (labels, distances) = settled.faces.nearest(&settled.shape, &inspection)?;
        Ok(Found { shape: settled.shape, inspection, labels, distances, n_facets, n_crossings })
    }

    /// The shape made of `count` regions, sound where that can be had.
    fn settled(&self, merges: &Merges, count: usize, progress: &Progress) -> Result<Settled> {
        let n = self.parts.len();
        let labels = merges.labels(n, count)?;
        let mut faces = Faces::new(self.places(), labels, memory::twin(&self.is_held)?)?;
        let (mut moments, mut is_held) = (vec![Moments::default(); count], vec![false; count]);
        for ((&label, own), &held) in faces.labels.iter().zip(&faces.moments).zip(&self.is_held) {
            moments[label as usize] = moments[label as usize].plus(own);
            is_held[label as usize] |= held;
        }
        let connectivity = self.working.mesh().connectivity();
        let regions =
            Regions::new(connectivity, &self.positions, self.labels(faces.labels.iter().copied()), count);
        let area: f64 = moments.iter().map(|m| m.area).sum();
        let squares: f64 = moments.iter().map(|m| m.fit().squared_distance).sum();
        let tolerance = (squares / area.max(f64::MIN_POSITIVE)).sqrt().max(constants::FLAT);
        let is_fixed = |v: u32| self.is_fixed[v as usize];
        let mut shape = Shape::new(&regions, &moments, &self.positions, &is_held, is_fixed, 2.0 * tolerance);
        let n_on_mesh = Inspection::new(&shape, true)?.pairs.len();
        fitting::settle(&mut shape, &mut faces, progress)?;
        Ok(Settled { shape, faces, n_on_mesh })
    }

    /// The result in the mesh's own coordinates.
    fn given(&self, mesh: &Mesh, found: Found, merges: Merges, progress: &Progress) -> Faceted {
        let Found { shape, inspection, labels, distances, n_facets, n_crossings } = found;
        let original = mesh.positions().unwrap_or_default();
        let mut names = vec![OUTSIDE; shape.corners.len()];
        let (mut vertices, mut origins) = (Vec::new(), Vec::new());
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
        let faces: Vec<[u32; 3]> = inspection.triangles.iter().map(|t| t.map(&mut name)).collect();
        let (mut polygons, mut polygon_facets) = (Vec::new(), Vec::new());
        let mut start = 0;
        for group in inspection.owners.chunk_by(|a, b| a == b) {
            for polygon in triangulation::polygons(&faces[start..start + group.len()]) {
                polygons.push(polygon);
                polygon_facets.push(group[0]);
            }
            start += group.len();
        }
        let mut of_faces = vec![-1; mesh.connectivity().n_faces()];
        self.parts.iter().zip(labels).for_each(|(&f, label)| of_faces[f as usize] = label as i32);
        let plane = |facet: &shape::Facet| {
            let on = self
                .working
                .place(add(self.center, scale(facet.plane.normal, facet.plane.offset * self.diagonal)));
            let normal = facet.plane.normal;
            [normal[0], normal[1], normal[2], crate::mesh::vector::dot(normal, on)]
        };
        Faceted {
            vertices,
            origins,
            polygons,
            polygon_facets,
            face_facets: inspection.owners,
            faces,
            labels: of_faces,
            planes: shape.facets.iter().map(plane).collect(),
            n_facets,
            rms: distances.rms * self.diagonal,
            largest: distances.largest * self.diagonal,
            n_crossings,
            status: if progress.is_finishing() { Status::Stopped } else { Status::Solved },
            merges: FacetMerges(merges),
        }
    }
}
