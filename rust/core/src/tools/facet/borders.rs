//! The borders of facets that are regions of the mesh to the end: faces change sides where no region becomes
//! another shape by that.

use std::collections::HashSet;

use super::job::Job;
use super::options::FacetOptions;
use super::regions::OUTSIDE;
use super::shape::{Facet, Shape};
use crate::{memory, Result};

/// The parts of a mesh and what is next to them.
#[derive(Debug)]
pub(super) struct Borders {
    faces: Vec<[u32; 3]>,
    /// The part behind the side opposite each corner, or [`OUTSIDE`].
    behind: Vec<[u32; 3]>,
    /// What borders cost there.
    weights: Vec<[f64; 3]>,
    n_vertices: usize,
}

impl Job<'_> {
    /// What faces change sides by, if the facets are to be regions of the mesh.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn borders(&self, options: &FacetOptions) -> Result<Option<Borders>> {
        if !options.keep_triangles {
            return Ok(None);
        }
        let connectivity = self.working.mesh().connectivity();
        let weight = self.weight(options)?;
        let mut part = memory::repeated(OUTSIDE, connectivity.n_faces())?;
        (0..).zip(&self.parts).for_each(|(i, &f)| part[f as usize] = i);
        let sides = |f: u32| [3 * f, 3 * f + 1, 3 * f + 2];
        let behind = |h: u32| connectivity.twin(h as usize).map_or(OUTSIDE, |mate| part[mate / 3]);
        let own = || self.parts.iter().copied();
        Ok(Some(Borders {
            faces: memory::gathered(own().map(|f| connectivity.faces()[f as usize]))?,
            behind: memory::gathered(own().map(|f| sides(f).map(behind)))?,
            weights: memory::gathered(own().map(|f| sides(f).map(&weight)))?,
            n_vertices: connectivity.n_vertices(),
        }))
    }
}

/// Regions while faces change sides.
struct Sharing<'a> {
    borders: &'a Borders,
    labels: &'a mut [u32],
    is_held: Vec<bool>,
    /// The vertices that are corners of facets.
    corners: HashSet<u32>,
    /// How many borders meet at each vertex.
    valence: Vec<u32>,
}

impl Borders {
    /// Gives each face to the facet of `wanted`, as far as the regions stay what they are, then straightens
    /// what is between them: a face with two sides against the same facet would be a line on their ridge, and
    /// goes to that one, unless it makes the border dearer.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn share(&self, shape: &Shape, labels: &mut [u32], wanted: Option<&[u32]>) -> Result<()> {
        let vertex = |c: u32| shape.corners[c as usize].vertex;
        let mut sharing = Sharing {
            borders: self,
            labels,
            is_held: memory::gathered(shape.facets.iter().map(|facet| facet.is_held))?,
            corners: memory::distinct(shape.facets.iter().flat_map(Facet::corners).map(vertex))?,
            valence: memory::repeated(0, self.n_vertices)?,
        };
        sharing.count();
        if let Some(wanted) = wanted {
            sharing.each(|sharing, f| {
                (0..3)
                    .find_map(|i| sharing.taker(f, i).filter(|&q| q == wanted[f] && !sharing.is_dearer(f, q)))
            })?;
        }
        sharing
            .each(|sharing, f| (0..3).find_map(|i| sharing.ear(f, i).filter(|&q| !sharing.is_dearer(f, q))))
    }
}

impl Sharing<'_> {
    fn count(&mut self) {
        for (f, face) in self.borders.faces.iter().enumerate() {
            for i in 0..3 {
                let other = self.borders.behind[f][i];
                // Both sides of an edge come by here unless one is outside.
                if other == OUTSIDE || (other as usize > f && self.labels[other as usize] != self.labels[f]) {
                    self.valence[face[(i + 1) % 3] as usize] += 1;
                    self.valence[face[(i + 2) % 3] as usize] += 1;
                }
            }
        }
    }

    fn label(&self, f: usize, i: usize) -> u32 {
        let other = self.borders.behind[f][i % 3];
        if other == OUTSIDE {
            OUTSIDE
        } else {
            self.labels[other as usize]
        }
    }

    fn may_have(&self, f: usize, q: u32) -> bool {
        q != OUTSIDE && !self.is_held[q as usize] && !self.is_held[self.labels[f] as usize]
    }

    /// The facet that has both sides at corner `i` of a face behind it, where that corner is a bend of one
    /// ridge.
    fn ear(&self, f: usize, i: usize) -> Option<u32> {
        let (own, q) = (self.labels[f], self.label(f, i + 1));
        let tip = self.borders.faces[f][i];
        let is_ear = self.label(f, i) == own && self.label(f, i + 2) == q && q != own;
        let is_bend = self.valence[tip as usize] == 2 && !self.corners.contains(&tip);
        (is_ear && is_bend && self.may_have(f, q)).then_some(q)
    }

    /// Whether the border of facet `q` around a face would run where it costs more than along the sides that
    /// it has now.
    fn is_dearer(&self, f: usize, q: u32) -> bool {
        let dearest = |label: u32| {
            let sides = (0..3).filter(|&i| self.label(f, i) == label);
            sides.map(|i| self.borders.weights[f][i]).fold(0.0, f64::max)
        };
        dearest(self.labels[f]) > dearest(q)
    }

    /// The facet behind side `i` of a face that could take it: from a bend of the ridge, or up to a vertex
    /// inside.
    fn taker(&self, f: usize, i: usize) -> Option<u32> {
        let (own, q) = (self.labels[f], self.label(f, i));
        if q == own || !self.may_have(f, q) {
            return None;
        }
        let is_inside = self.valence[self.borders.faces[f][i] as usize] == 0;
        let is_side = is_inside && self.label(f, i + 1) == own && self.label(f, i + 2) == own;
        (is_side || (1..3).any(|j| self.ear(f, (i + j) % 3) == Some(q))).then_some(q)
    }

    /// Gives faces to the facets that `goes` says, until it says none.
    fn each(&mut self, goes: impl Fn(&Self, usize) -> Option<u32>) -> Result<()> {
        let mut stack: Vec<u32> = memory::numbers(self.labels.len())?;
        while let Some(f) = stack.pop() {
            let Some(q) = goes(self, f as usize) else { continue };
            self.give(f as usize, q);
            let around = self.borders.behind[f as usize].into_iter().filter(|&g| g != OUTSIDE);
            memory::extend(&mut stack, 3)?;
            stack.extend(around);
        }
        Ok(())
    }

    fn give(&mut self, f: usize, q: u32) {
        for i in 0..3 {
            let ends = [1, 2].map(|j| self.borders.faces[f][(i + j) % 3] as usize);
            let other = self.label(f, i);
            if other == OUTSIDE {
                continue;
            }
            let (was, is) = (u32::from(other != self.labels[f]), u32::from(other != q));
            ends.into_iter().for_each(|v| self.valence[v] = self.valence[v] + is - was);
        }
        self.labels[f] = q;
    }
}
