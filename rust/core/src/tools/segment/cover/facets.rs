//! The flat facets of an exact shape, each with its neighbors.

use super::super::exact::Facets;
use super::super::surface::Surface;
use crate::buckets::Buckets;
use crate::mesh::vector::{add, distance, norm, scale, sub, unit, Point};
use crate::surfaces::Surface as Named;
use crate::{memory, Result};

/// An edge between two facets, seen from one of them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Link {
    /// The facet across.
    pub facet: u32,
    /// The vertices of the edge.
    pub ends: [u32; 2],
    /// The distance between the unit normals.
    pub bend: f64,
}

/// Facets: faces in one plane as far as rounding tells.
pub(super) struct Shape<'a> {
    pub positions: &'a [Point],
    /// How far a vertex may be off what it lies on.
    pub rounding: f64,
    /// Facets that bend by more from each other are two sides, unless the surface is curved both ways.
    pub bend: f64,
    /// The facet of each face.
    pub labels: Vec<u32>,
    pub normals: Vec<Point>,
    /// The mean of the vertices of each facet.
    pub centers: Vec<Point>,
    /// About the diameter of each facet.
    pub sizes: Vec<f64>,
    vertices: Buckets<u32>,
    links: Buckets<Link>,
    at: Buckets<u32>,
}

impl<'a> Shape<'a> {
    /// The facets of `surface`, whose vertices are off by `rounding` at most, and whose sides bend by `bend`.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn new(surface: &'a Surface<'_>, rounding: f64, bend: f64) -> Result<Self> {
        let flat = Facets::new(surface, rounding)?;
        let labels = flat.joined(&flat.turns()?, |edge| edge.is_flat)?;
        let n = labels.iter().map(|l| *l as usize + 1).max().unwrap_or(0);
        let mut sums = memory::repeated([0.0; 3], n)?;
        let mut corners: Vec<(u32, u32)> = memory::room(3 * labels.len())?;
        for (f, (&label, face)) in labels.iter().zip(surface.connectivity.faces()).enumerate() {
            sums[label as usize] = add(sums[label as usize], surface.vector_area(f));
            corners.extend(face.map(|v| (label, v)));
        }
        corners.sort_unstable();
        corners.dedup();
        let normals: Vec<Point> = memory::gathered(sums.into_iter().map(unit))?;
        let positions = &surface.positions;
        let vertices = Buckets::new(n, |visit| corners.iter().for_each(|&(f, v)| visit(f as usize, v)))?;
        let center = |f: usize| {
            let own = vertices.of(f);
            scale(
                own.iter().fold([0.0; 3], |sum, &v| add(sum, positions[v as usize])),
                1.0 / own.len() as f64,
            )
        };
        let centers: Vec<Point> = memory::gathered((0..n).map(center))?;
        let radius = |f: usize| {
            let far = vertices.of(f).iter().map(|&v| distance(positions[v as usize], centers[f]));
            far.fold(0.0, f64::max)
        };
        let sizes = memory::gathered((0..n).map(|f| 2.0 * radius(f)))?;
        let links = Buckets::new(n, |visit| {
            for f in 0..labels.len() {
                for (h, g) in surface.around(f) {
                    let (own, other) = (labels[f] as usize, labels[g] as usize);
                    if own != other {
                        let ends = [surface.connectivity.tail(h), surface.connectivity.head(h)];
                        let bend = distance(normals[own], normals[other]);
                        visit(own, Link { facet: other as u32, ends, bend });
                    }
                }
            }
        })?;
        let at = Buckets::new(positions.len(), |visit| {
            corners.iter().for_each(|&(f, v)| visit(v as usize, f));
        })?;
        Ok(Self { positions, rounding, bend, labels, normals, centers, sizes, vertices, links, at })
    }

    /// How many facets there are.
    pub(super) fn len(&self) -> usize {
        self.normals.len()
    }

    /// The vertices of facet `f`.
    pub(super) fn vertices(&self, f: u32) -> &[u32] {
        self.vertices.of(f as usize)
    }

    /// The edges of facet `f`.
    pub(super) fn links(&self, f: u32) -> &[Link] {
        self.links.of(f as usize)
    }

    /// The facets at vertex `v`.
    pub(super) fn at(&self, v: u32) -> &[u32] {
        self.at.of(v as usize)
    }

    /// How many vertices lie inside facets.
    pub(super) fn n_inside(&self, surface: &Surface<'_>) -> Result<usize> {
        let connectivity = surface.connectivity;
        let mut is_inside: Vec<bool> =
            memory::gathered((0..self.positions.len() as u32).map(|v| self.at(v).len() == 1))?;
        for h in connectivity.boundary() {
            for v in [connectivity.tail(h), connectivity.head(h)] {
                is_inside[v as usize] = false;
            }
        }
        Ok(is_inside.into_iter().filter(|inside| *inside).count())
    }

    /// The vertices of some facets, ascending.
    pub(super) fn vertices_of(&self, facets: &[u32]) -> Result<Vec<u32>> {
        let all = facets.iter().flat_map(|&f| self.vertices(f).iter().copied());
        let mut all: Vec<u32> = memory::sifted(all)?;
        all.sort_unstable();
        all.dedup();
        Ok(all)
    }

    /// Where these vertices are.
    pub(super) fn points(&self, vertices: &[u32]) -> Result<Vec<Point>> {
        Ok(memory::gathered(vertices.iter().map(|&v| self.positions[v as usize]))?)
    }

    /// Where the vertices of some facets are.
    pub(super) fn points_of(&self, facets: &[u32]) -> Result<Vec<Point>> {
        self.points(&self.vertices_of(facets)?)
    }

    /// How far vertex `v` is from a surface.
    pub(super) fn off(&self, v: u32, surface: &Named) -> f64 {
        surface.distance(self.positions[v as usize]).0.abs()
    }

    /// Whether the edge from vertex `v` to `w` touches a surface that `v` lies on, as the edges of a tangent
    /// plane do; what goes on over a curve is off by half its turn.
    pub(super) fn touches(&self, v: u32, w: u32, surface: &Named, most: f64) -> bool {
        let [from, to] = [v, w].map(|v| self.positions[v as usize]);
        let along = sub(to, from);
        let rise: f64 = along.iter().zip(surface.distance(from).1).map(|(a, n)| a * n).sum();
        rise.abs() < most * norm(along) + self.rounding
    }
}

/// Facets that a search has seen.
pub(super) struct Marks {
    seen: Vec<u32>,
    now: u32,
}

impl Marks {
    /// None of `n`.
    pub(super) fn new(n: usize) -> Result<Self> {
        Ok(Self { seen: memory::repeated(0, n)?, now: 0 })
    }

    /// None again.
    pub(super) fn begin(&mut self) {
        self.now += 1;
    }

    /// Marks `f`, and says whether it was not.
    pub(super) fn mark(&mut self, f: u32) -> bool {
        let fresh = self.seen[f as usize] != self.now;
        self.seen[f as usize] = self.now;
        fresh
    }

    /// Whether `f` is marked.
    pub(super) fn is_marked(&self, f: u32) -> bool {
        self.seen[f as usize] == self.now
    }
}
