//! Facets that cannot stay as they are.

use std::collections::{HashMap, HashSet};

use super::constants::{FARTHEST_CORNER, FLAT};
use super::faces::{Faces, Scan};
use super::shape::{self, Shape};
use super::triangulation::{forced, triangles};
use crate::memory;
use crate::mesh::vector::{distance, Point};
use crate::remesh::crossings::crossings_between;
use crate::remesh::editable::HUB;
use crate::Result;

/// The facets of a shape as triangles, and which of them are unsound.
#[derive(Debug, Default)]
pub(super) struct Inspection {
    pub triangles: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub owners: Vec<u32>,
    /// Facets whose loops cross or run the wrong way around, or that look to the other side than their faces.
    pub crossed: Vec<u32>,
    /// Pairs of facets that pass through each other and do not on the mesh; only looked for where no facet is
    /// crossed.
    pub pairs: HashSet<[u32; 2]>,
}

impl Inspection {
    /// Looks at every facet, and at all together where `is_thorough` or all of them are sound.
    pub(super) fn new(shape: &Shape, faces: &Faces<'_>, is_thorough: bool) -> Result<Self> {
        let mut found = Self::default();
        // The triangles of facets of very many corners: they are side by side, whatever boxes they have.
        let mut apart = Vec::new();
        for (k, facet) in (0..).zip(&shape.facets) {
            let is_upright = facet.is_held || facet.moments.faces(facet.plane.normal);
            let is_near = |c: u32| distance(shape.point(c), shape.home(c)) <= FARTHEST_CORNER;
            let is_near = facet.is_held || facet.corners().all(is_near);
            let simple = triangles(shape, facet)?;
            if !is_upright || !is_near || simple.is_none() {
                memory::push(&mut found.crossed, k)?;
            }
            let is_simple = simple.is_some();
            let own = match simple {
                Some(own) => own,
                None => forced(facet)?,
            };
            if is_simple && own.len() > HUB {
                let start = found.triangles.len() as u32;
                memory::push(&mut apart, start..start + own.len() as u32)?;
            }
            memory::extend(&mut found.owners, own.len())?;
            found.owners.extend(own.iter().map(|_| k));
            memory::extend(&mut found.triangles, own.len())?;
            found.triangles.extend(own);
        }
        found.find_doubled(shape, faces.scan)?;
        if is_thorough || found.crossed.is_empty() {
            let pair = |[i, j]: [u32; 2]| {
                let (p, q) = (found.owners[i as usize], found.owners[j as usize]);
                [p.min(q), p.max(q)]
            };
            let all = crossings_between(&found.triangles, &found.places(shape)?, &apart)?;
            let standing = faces.standing(shape)?;
            let of = |k: u32| shape.facets[k as usize].part;
            let is_old = |[p, q]: [u32; 2]| {
                faces.scan.standing.has(of(p), of(q)) || (standing.contains(&p) && standing.contains(&q))
            };
            found.pairs = memory::distinct(all.into_iter().map(pair).filter(|&pair| !is_old(pair)))?;
        }
        Ok(found)
    }

    /// Facets that share two corners may both have the side or the diagonal between them: four triangles meet
    /// there.
    fn find_doubled(&mut self, shape: &Shape, scan: &Scan) -> Result<()> {
        let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
        memory::extend_map(&mut sides, 3 * self.triangles.len())?;
        for (triangle, &owner) in self.triangles.iter().zip(&self.owners) {
            for side in shape::sides(triangle) {
                let Some(other) = sides.insert(side, owner) else { continue };
                if !scan.is_doubled(side.map(|c| shape.corners[c as usize].vertex)) {
                    memory::extend(&mut self.crossed, 2)?;
                    self.crossed.extend([other, owner]);
                }
            }
        }
        self.crossed.sort_unstable();
        self.crossed.dedup();
        Ok(())
    }

    /// The places of the triangles.
    pub(super) fn places(&self, shape: &Shape) -> Result<Vec<[Point; 3]>> {
        Ok(memory::gathered(self.triangles.iter().map(|t| t.map(|c| shape.point(c))))?)
    }

    /// Facets that are crossed or pass through others.
    pub(super) fn faults(&self) -> Result<Vec<u32>> {
        let mut all = memory::sifted(self.crossed.iter().chain(self.pairs.iter().flatten()).copied())?;
        all.sort_unstable();
        all.dedup();
        Ok(all)
    }
}

/// Facets that cannot stay: crossed, passing through others, or not flat.
#[derive(Debug)]
pub(super) struct Unsound {
    pub facets: Vec<u32>,
    pairs: HashSet<[u32; 2]>,
}

impl Unsound {
    pub(super) fn new(shape: &Shape, faces: &Faces<'_>) -> Result<Self> {
        let inspection = Inspection::new(shape, faces, true)?;
        let mut facets = inspection.faults()?;
        for k in (0..shape.facets.len() as u32).filter(|&k| shape.off_plane(k) > FLAT) {
            memory::push(&mut facets, k)?;
        }
        // What stays is as it was on the mesh.
        facets.retain(|&k| !shape.facets[k as usize].is_held);
        facets.sort_unstable();
        facets.dedup();
        Ok(Self { facets, pairs: inspection.pairs })
    }

    /// The nodes, `nodes` of their faces, of unsound facets and of those that share a corner with one.
    pub(super) fn around(&self, shape: &Shape, nodes: &[u32]) -> Result<Vec<u32>> {
        let corners: HashSet<u32> =
            memory::distinct(self.facets.iter().flat_map(|&k| shape.facets[k as usize].corners()))?;
        let touching = shape.facets.iter().filter(|facet| facet.corners().any(|c| corners.contains(&c)));
        let mut found: Vec<u32> = memory::sifted(touching.map(|facet| nodes[facet.part as usize]))?;
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }

    /// Of facets that touch or pass through each other those of highest rank.
    pub(super) fn latest(&self, shape: &Shape, rank: impl Fn(u32) -> u32) -> Result<Vec<u32>> {
        let mut highest: HashMap<u32, u32> = HashMap::new();
        for &k in &self.facets {
            for c in shape.facets[k as usize].corners() {
                memory::extend_map(&mut highest, 1)?;
                let most = highest.entry(c).or_default();
                *most = (*most).max(rank(k));
            }
        }
        let are_made = |pair: &&[u32; 2]| pair.iter().all(|&k| !shape.facets[k as usize].is_held);
        let lower = |&[p, q]: &[u32; 2]| match rank(p).cmp(&rank(q)) {
            std::cmp::Ordering::Less => Some(p),
            std::cmp::Ordering::Greater => Some(q),
            std::cmp::Ordering::Equal => None,
        };
        let beaten: HashSet<u32> = memory::distinct(self.pairs.iter().filter(are_made).filter_map(lower))?;
        let is_highest = |k: u32| shape.facets[k as usize].corners().all(|c| highest[&c] <= rank(k));
        let is_chosen = |&k: &u32| is_highest(k) && !beaten.contains(&k);
        let chosen: Vec<u32> = memory::sifted(self.facets.iter().copied().filter(is_chosen))?;
        // Ranks that beat each other around a circle of touching and passing.
        if chosen.is_empty() {
            return Ok(memory::twin(&self.facets)?);
        }
        Ok(chosen)
    }
}
