//! Symmetric facets of a symmetric mesh: those of one half, whose corners on the mirror's plane stay on it,
//! and their images ([`super::doubling`]).

use std::collections::HashMap;

use super::faceted::{FacetMerges, Faceted};
use super::mirror::Mirror;
use super::options::{FacetOptions, Symmetric};
use crate::error::MeshError;
use crate::mesh::vector::{between, distance, dot, sub, Point};
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::remesh::closest::ClosestPoint;
use crate::{memory, Error, Result};

/// A mesh is symmetric if no vertex is farther than this part of its diagonal from the image of its surface:
/// a fifth of what facets are off where nothing is asked for. Spot is off by 1.6 %, and is none.
const ALIKE: f64 = 1e-3;

/// Vertices this near to the plane are put onto it, in parts of the diagonal, rather than that their faces
/// are cut into slivers.
const ON: f64 = 1e-4;

/// How often another number of facets of the half is tried, to end at the number asked for of the whole.
const COUNTS: usize = 4;

/// One half of a mesh.
pub(super) struct Half {
    pub mirror: Mirror,
    pub mesh: Mesh,
    /// The vertex of the whole that each vertex is, or is near to.
    pub origins: Vec<u32>,
    /// Which vertices lie on the plane.
    pub is_on: Vec<bool>,
    /// The face of the whole that each face is a part of.
    parents: Vec<u32>,
}

/// The farthest that a vertex is from the image of the surface, or one that is farther than `reach`.
fn off_image(points: &[Point], tree: &ClosestPoint, mirror: Mirror, reach: f64) -> f64 {
    let mut farthest = 0.0_f64;
    for &p in points {
        let image = mirror.image(p);
        farthest = farthest.max(tree.closest(image, None, |_| true).map_or(0.0, |near| near.squared.sqrt()));
        if farthest > reach {
            break;
        }
    }
    farthest
}

impl Half {
    /// The half of a mesh on the positive side of the plane that is asked for.
    ///
    /// # Errors
    /// [`Error::Argument`] where the mesh is not symmetric.
    pub(super) fn new(mesh: &Mesh, wanted: Symmetric) -> Result<Self> {
        let positions = mesh.positions().unwrap_or_default();
        let faces = mesh.connectivity().faces();
        let mut points = memory::repeated(false, positions.len())?;
        faces.iter().flatten().for_each(|&v| points[v as usize] = true);
        let points: Vec<Point> =
            memory::sifted(positions.iter().zip(&points).filter(|(_, &used)| used).map(|(&p, _)| p))?;
        let corner = |of: fn(f64, f64) -> f64, start: f64| {
            points.iter().fold([start; 3], |all, p| [0, 1, 2].map(|c| of(all[c], p[c])))
        };
        let (low, high) = (corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY));
        let size = distance(low, high);
        let places = memory::gathered(faces.iter().map(|f| f.map(|v| positions[v as usize])))?;
        let tree = ClosestPoint::new(places)?;
        let axes = match wanted {
            Symmetric::Across(axis) => axis..axis + 1,
            Symmetric::Found => 0..3,
        };
        for axis in axes.clone() {
            // The origin of the object, as a modeler mirrors; else the middle.
            for at in [0.0, 0.5 * (low[axis] + high[axis])] {
                let mirror = Mirror { axis, at };
                if off_image(&points, &tree, mirror, ALIKE * size) <= ALIKE * size {
                    return Self::cut(mesh, mirror, size);
                }
            }
        }
        let across = match wanted {
            Symmetric::Across(axis) => ["x", "y", "z"][axis],
            Symmetric::Found => "x, y, or z",
        };
        Err(Error::argument(
            "symmetric",
            format!(
                "needs a mesh that is symmetric across {across}, to a thousandth of its size: this is not"
            ),
        ))
    }

    fn cut(mesh: &Mesh, mirror: Mirror, size: f64) -> Result<Self> {
        let axis = mirror.axis;
        let mut positions = memory::twin(mesh.positions().unwrap_or_default())?;
        let mut is_on = memory::repeated(false, positions.len())?;
        for (p, is_on) in positions.iter_mut().zip(&mut is_on) {
            if (p[axis] - mirror.at).abs() <= ON * size {
                p[axis] = mirror.at;
                *is_on = true;
            }
        }
        let mut origins = memory::numbers(positions.len())?;
        let (mut faces, mut parents, mut cuts) = (Vec::new(), Vec::new(), HashMap::new());
        for (f, face) in (0..).zip(mesh.connectivity().faces()) {
            let side = |v: u32| positions[v as usize][axis] - mirror.at;
            if !face.iter().any(|&v| side(v) > 0.0) {
                continue;
            }
            let sides = face.map(side);
            let mut ring = Vec::with_capacity(4);
            for i in 0..3 {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                let (x, y) = (sides[i], sides[(i + 1) % 3]);
                if x >= 0.0 {
                    ring.push(a);
                }
                if x * y < 0.0 {
                    memory::extend_map(&mut cuts, 1)?;
                    let fresh = positions.len() as u32;
                    let v = *cuts.entry([a.min(b), a.max(b)]).or_insert(fresh);
                    if v == fresh {
                        let mut p = between(positions[a as usize], positions[b as usize], x / (x - y));
                        p[axis] = mirror.at;
                        memory::push(&mut positions, p)?;
                        memory::push(&mut is_on, true)?;
                        memory::push(&mut origins, if x.abs() < y.abs() { a } else { b })?;
                    }
                    ring.push(v);
                }
            }
            for i in 1..ring.len() - 1 {
                memory::push(&mut faces, [ring[0], ring[i], ring[i + 1]])?;
                memory::push(&mut parents, f)?;
            }
        }
        Ok(Self { mirror, mesh: Mesh::new(positions, faces)?, origins, is_on, parents })
    }

    /// What is asked for of the half.
    pub(super) fn options(&self, options: &FacetOptions, facets: Option<usize>) -> Result<FacetOptions> {
        let rows = |rows: &Vec<[f64; 3]>| memory::gathered(self.parents.iter().map(|&f| rows[f as usize]));
        Ok(FacetOptions {
            facets,
            error: options.error,
            edge_weights: options.edge_weights.as_ref().map(rows).transpose()?,
            threads: options.threads,
            ..FacetOptions::default()
        })
    }

    /// The facets of the whole `mesh`, such that they come near the number asked for, from those that
    /// `of_half` makes of this.
    ///
    /// # Errors
    /// Those of `of_half`.
    pub(super) fn facets(
        &self,
        mesh: &Mesh,
        merges: Option<&FacetMerges>,
        options: &FacetOptions,
        progress: &Progress,
        of_half: impl Fn(Option<&FacetMerges>, &FacetOptions, &Progress) -> Result<Faceted>,
    ) -> Result<Faceted> {
        // All of them may be one with their images, as on a box: then there are as many on the half.
        let mut count = options.facets;
        let mut best: Option<(usize, Faceted)> = None;
        let mut known: Option<FacetMerges> = None;
        for turn in 0..COUNTS {
            let said = if turn == 0 { progress.clone() } else { progress.quiet() };
            let found = of_half(known.as_ref().or(merges), &self.options(options, count)?, &said)?;
            // With more than asked for on the half, it cannot have fewer.
            let has_no_fewer = count.is_some_and(|count| found.n_facets > count);
            let found = self.doubled(mesh, found)?;
            known = Some(found.merges.twin()?);
            let n = found.n_facets;
            let (Some(asked), Some(before)) = (options.facets, count) else { return Ok(found) };
            let off = asked.abs_diff(n);
            if best.as_ref().is_none_or(|(least, _)| off < *least) {
                best = Some((off, found));
            }
            let by = off.div_ceil(2);
            let next = if n < asked { before + by } else { before.saturating_sub(by).max(1) };
            // With fewer at first, it has no more planes.
            let has_no_more = turn == 0 && n < asked;
            if off == 0 || has_no_more || has_no_fewer || next == before || progress.is_finishing() {
                break;
            }
            count = Some(next);
        }
        best.map(|(_, found)| found).ok_or(MeshError::NoFaces.into())
    }
}

/// The corner of a face that is nearest to a point of it.
pub(super) fn nearest_corner(face: [u32; 3], positions: &[Point], point: Point) -> u32 {
    let off = |v: u32| {
        let d = sub(positions[v as usize], point);
        dot(d, d)
    };
    face.into_iter().min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(face[0])
}
