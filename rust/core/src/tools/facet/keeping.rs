//! The mesh's own triangles on the facets: vertices go onto the corners and along the ridges that they are on
//! the mesh, and the others, as a membrane that these stretch, onto the planes of their facets.

use std::collections::HashMap;

use super::job::Job;
use super::regions::{Regions, OUTSIDE};
use super::search::Found;
use super::shape::Shape;
use super::unfolding;
use crate::linear::cholesky::Cholesky;
use crate::linear::pattern::LowerPattern;
use crate::mesh::vector::{add, between, centroid, distance, scale, sub, Point};
use crate::{memory, Progress, Result};

/// The least and the greatest weight of an edge: with the factor of a membrane of slivers still accurate to
/// more than what a file keeps.
const WEIGHTS: [f64; 2] = [1e-3, 1e3];

/// The mesh on its facets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KeptTriangles {
    /// Where each vertex of the mesh is.
    pub vertices: Vec<Point>,
    /// The corner of the mesh, `3 f + i` the `i`th of its face `f`, that each corner of each face was: others
    /// than its own where an edge was flipped.
    pub corners: Vec<[u32; 3]>,
    /// Edges that were flipped since a face would have folded.
    pub n_flipped: usize,
    /// Faces that are folded, no more than a line, or not on their facet, all the same.
    pub n_folded: usize,
}

/// What is known of the vertices of a mesh on its facets.
struct Membrane<'a> {
    regions: &'a Regions<'a>,
    shape: &'a Shape,
    places: Vec<Point>,
    /// The facet that a vertex is inside of; [`OUTSIDE`] where its place is known.
    inside: Vec<u32>,
}

impl Job<'_> {
    /// The mesh's own vertices and faces on the facets that were found, each face on that of its label.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`], or [`crate::Error::Cancelled`].
    pub(super) fn kept(&self, found: &Found, progress: &Progress) -> Result<KeptTriangles> {
        let connectivity = self.working.mesh().connectivity();
        let labels = self.labels(found.labels.iter().copied())?;
        let regions =
            Regions::new(connectivity, &self.positions, memory::twin(&labels)?, found.shape.facets.len())?;
        let mut membrane = Membrane::new(&regions, &found.shape)?;
        membrane.place_ridges()?;
        let mut faces = unfolding::Sheet::new(connectivity, &found.shape, &labels)?;
        let (along, across) = membrane.stretched(progress)?;
        membrane.choose(&faces, &along, &across)?;
        let Membrane { mut places, inside, .. } = membrane;
        let n_flipped = faces.unfold(&mut places, |v| inside[v as usize] != OUTSIDE)?;
        let n_folded = faces.n_folded(&places);
        let here = self.working.mesh().positions().unwrap_or_default();
        let there = |(v, &place): (usize, &Point)| {
            if place == self.positions[v] {
                here[v]
            } else {
                add(self.center, scale(place, self.diagonal))
            }
        };
        let vertices = self.working.positions(&memory::gathered(places.iter().enumerate().map(there))?)?;
        Ok(KeptTriangles { vertices, corners: self.own_corners(faces.corners), n_flipped, n_folded })
    }

    /// Corners of the mesh itself from those here, whose faces may be turned over.
    fn own_corners(&self, mut corners: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        for (f, face) in corners.iter_mut().enumerate() {
            for corner in face.iter_mut().filter(|corner| self.working.is_flipped(**corner as usize / 3)) {
                *corner = *corner / 3 * 3 + (3 - *corner % 3) % 3;
            }
            if self.working.is_flipped(f) {
                face.swap(1, 2);
            }
        }
        corners
    }
}

impl<'a> Membrane<'a> {
    fn new(regions: &'a Regions<'a>, shape: &'a Shape) -> Result<Self> {
        let mut inside = memory::repeated(OUTSIDE, regions.positions.len())?;
        for (face, &label) in regions.connectivity.faces().iter().zip(&regions.labels) {
            if label != OUTSIDE && !shape.facets[label as usize].is_held {
                face.iter().for_each(|&v| inside[v as usize] = label);
            }
        }
        for v in regions.borders.iter().flatten().flat_map(|&h| regions.ends(h)) {
            inside[v as usize] = OUTSIDE;
        }
        Ok(Self { regions, shape, places: memory::twin(regions.positions)?, inside })
    }

    /// Puts the vertices of every border where its corners are, and in between at the same parts of the way.
    fn place_ridges(&mut self) -> Result<()> {
        for (k, facet) in (0..).zip(&self.shape.facets) {
            let corners = memory::mapped(facet.corners().map(|c| {
                let corner = &self.shape.corners[c as usize];
                (corner.vertex, corner.point)
            }))?;
            for walk in self.walks(k)? {
                self.place_walk(&walk, &corners)?;
            }
        }
        Ok(())
    }

    /// The loops around a region, vertex by vertex.
    fn walks(&self, region: u32) -> Result<Vec<Vec<u32>>> {
        let mut left = memory::distinct(self.regions.borders[region as usize].iter().copied())?;
        let mut walks = Vec::new();
        for &start in &self.regions.borders[region as usize] {
            let (mut h, mut walk) = (start, Vec::new());
            while left.remove(&h) {
                memory::push(&mut walk, self.regions.ends(h)[0])?;
                h = self.regions.follow(h, |r| r == region);
            }
            if !walk.is_empty() {
                memory::push(&mut walks, walk)?;
            }
        }
        Ok(walks)
    }

    fn place_walk(&mut self, walk: &[u32], corners: &HashMap<u32, Point>) -> Result<()> {
        let marks: Vec<usize> = memory::sifted((0..walk.len()).filter(|&i| corners.contains_key(&walk[i])))?;
        for (j, &from) in marks.iter().enumerate() {
            let to = marks[(j + 1) % marks.len()] + if j + 1 == marks.len() { walk.len() } else { 0 };
            let at = |i: usize| walk[i % walk.len()];
            let step = |i: usize| {
                distance(self.regions.positions[at(i) as usize], self.regions.positions[at(i + 1) as usize])
            };
            let (start, end) = (corners[&at(from)], corners[&at(to)]);
            let whole: f64 = (from..to).map(step).sum();
            let mut passed = 0.0;
            for i in from..to {
                self.places[at(i) as usize] = if i == from {
                    start
                } else {
                    between(start, end, passed / whole.max(f64::MIN_POSITIVE))
                };
                passed += step(i);
            }
        }
        Ok(())
    }

    /// Where a membrane has the vertices that the known ones are the rim of, and how far it moves them if it
    /// carries the moves of the rim: Tutte's embedding (1963), with the barycentric dual edge over the edge
    /// as its weights, which are positive: it folds no triangle in a convex facet.
    fn stretched(&self, progress: &Progress) -> Result<(Vec<Point>, Vec<Point>)> {
        let n = self.places.len();
        let mut number = memory::repeated(usize::MAX, n)?;
        let free: Vec<usize> = memory::sifted((0..n).filter(|&v| self.inside[v] != OUTSIDE))?;
        free.iter().enumerate().for_each(|(i, &v)| number[v] = i);
        let mut entries = memory::room(6 * self.regions.labels.len() + free.len())?;
        let mut right = memory::repeated([0.0; 6], free.len())?;
        let positions = self.regions.positions;
        for face in self.regions.connectivity.faces() {
            let corners = face.map(|v| positions[v as usize]);
            let middle = centroid(corners);
            for i in 0..3 {
                let [a, b] = [face[i] as usize, face[(i + 1) % 3] as usize];
                if a == b || (number[a] == usize::MAX && number[b] == usize::MAX) {
                    continue;
                }
                let [p, q] = [positions[a], positions[b]];
                let dual = distance(middle, between(p, q, 0.5));
                let weight = (dual / distance(p, q).max(f64::MIN_POSITIVE)).clamp(WEIGHTS[0], WEIGHTS[1]);
                for [v, w] in [[a, b], [b, a]].into_iter().filter(|[v, _]| number[*v] != usize::MAX) {
                    entries.push((number[v], number[v], weight));
                    if number[w] == usize::MAX {
                        let (place, moved) = (self.places[w], sub(self.places[w], self.on_plane(v, w)));
                        let row = [place[0], place[1], place[2], moved[0], moved[1], moved[2]];
                        (0..6).for_each(|c| right[number[v]][c] += weight * row[c]);
                    } else if number[w] > number[v] {
                        entries.push((number[v], number[w], -weight));
                    }
                }
            }
        }
        if !free.is_empty() {
            let (pattern, values) = assembled(entries, free.len())?;
            let mut cholesky = Cholesky::analyze(&pattern, None, progress)?;
            cholesky.factorize(&values, progress)?;
            cholesky.solve(&mut right)?;
        }
        let (mut along, mut across) = (memory::twin(&self.places)?, memory::twin(&self.places)?);
        for (&v, row) in free.iter().zip(&right) {
            along[v] = self.projected(self.inside[v], add(self.on_plane(v, v), [row[3], row[4], row[5]]));
            across[v] = self.projected(self.inside[v], [row[0], row[1], row[2]]);
        }
        Ok((along, across))
    }

    fn projected(&self, facet: u32, point: Point) -> Point {
        let plane = &self.shape.facets[facet as usize].plane;
        sub(point, scale(plane.normal, plane.height(point)))
    }

    /// Where vertex `w` of the mesh is nearest to, on the plane that vertex `v` is on.
    fn on_plane(&self, v: usize, w: usize) -> Point {
        self.projected(self.inside[v], self.regions.positions[w])
    }

    /// Of both ways for each facet the first, which leaves what is flat where it is, unless it folds more.
    fn choose(&mut self, faces: &unfolding::Sheet<'_>, along: &[Point], across: &[Point]) -> Result<()> {
        let folded = [faces.folded_of_facets(along)?, faces.folded_of_facets(across)?];
        for v in 0..self.places.len() {
            let facet = self.inside[v];
            if facet != OUTSIDE {
                let is_second = folded[1][facet as usize] < folded[0][facet as usize];
                self.places[v] = if is_second { across[v] } else { along[v] };
            }
        }
        Ok(())
    }
}

/// A matrix of entries by column and row.
fn assembled(mut entries: Vec<(usize, usize, f64)>, n: usize) -> Result<(LowerPattern, Vec<f64>)> {
    entries.sort_by_key(|entry| (entry.0, entry.1));
    let (mut starts, mut rows, mut values) = (memory::repeated(0, n + 1)?, Vec::new(), Vec::new());
    for same in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        memory::push(&mut rows, same[0].1)?;
        memory::push(&mut values, same.iter().map(|entry| entry.2).sum::<f64>())?;
        starts[same[0].0 + 1] = rows.len();
    }
    Ok((LowerPattern { n, starts, rows }, values))
}
