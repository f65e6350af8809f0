//! The triangles of a sound shape, kept up to date facet by facet.

use std::collections::{BTreeSet, HashMap};

use super::faces::{Faces, Scan};
use super::shape::{sides, Shape};
use super::triangulation::{forced, triangles};
use crate::mesh::vector::Point;
use crate::remesh::crossings::cross;
use crate::{memory, Result};

/// The triangles of one facet.
#[derive(Debug, Clone, Default)]
struct Patch {
    triangles: Vec<[u32; 3]>,
    places: Vec<[Point; 3]>,
    /// The corners of the bounding box.
    bounds: [Point; 2],
    /// The integral of the squared distance from the mesh.
    off_mesh: f64,
}

/// The triangles of all facets.
pub(super) struct Skin<'s> {
    scan: &'s Scan,
    patches: Vec<Patch>,
    /// Facets with faces that pass through others on the mesh.
    is_passing: Vec<bool>,
    parts: Vec<u32>,
}

impl Patch {
    fn new(triangles: Vec<[u32; 3]>, point: impl Fn(u32) -> Point) -> Self {
        let places: Vec<[Point; 3]> = triangles.iter().map(|t| t.map(&point)).collect();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in places.iter().flatten() {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
            }
        }
        Self { triangles, places, bounds: [low, high], off_mesh: 0.0 }
    }

    fn off_mesh(&self, scan: &Scan) -> f64 {
        self.places.iter().map(|&place| scan.off_mesh(place)).sum()
    }

    fn is_near(&self, other: &Self) -> bool {
        (0..3).all(|c| self.bounds[0][c] <= other.bounds[1][c] && other.bounds[0][c] <= self.bounds[1][c])
    }

    fn crosses(&self, other: &Self) -> bool {
        let own = self.triangles.iter().zip(&self.places);
        self.is_near(other)
            && own.into_iter().any(|of| other.triangles.iter().zip(&other.places).any(|with| cross(of, with)))
    }
}

impl<'s> Skin<'s> {
    pub(super) fn new(shape: &Shape, faces: &Faces<'s>) -> Result<Self> {
        let standing = faces.standing()?;
        let mut skin = Self {
            scan: faces.scan,
            patches: memory::repeated(Patch::default(), shape.facets.len())?,
            is_passing: memory::gathered((0..shape.facets.len() as u32).map(|k| standing.contains(&k)))?,
            parts: memory::gathered(shape.facets.iter().map(|facet| facet.part))?,
        };
        for k in 0..shape.facets.len() as u32 {
            skin.set(shape, k)?;
        }
        Ok(skin)
    }

    /// Takes the triangles of a facet anew.
    pub(super) fn set(&mut self, shape: &Shape, k: u32) -> Result<()> {
        let facet = &shape.facets[k as usize];
        let own = match triangles(shape, facet)? {
            Some(own) => own,
            None => forced(facet)?,
        };
        let mut patch = Patch::new(own, |c| shape.point(c));
        patch.off_mesh = patch.off_mesh(self.scan);
        self.patches[k as usize] = patch;
        Ok(())
    }

    /// A facet that becomes part of another.
    pub(super) fn remove(&mut self, gone: u32, kept: u32) {
        self.patches[gone as usize] = Patch::default();
        self.is_passing[kept as usize] |= self.is_passing[gone as usize];
    }

    /// How much farther from the mesh the facets are with those of `shape`, `changed` ones of it, in the
    /// place of `facets` and of one that is `gone`; `None` where one of them is not sound.
    pub(super) fn tried(
        &self,
        shape: &Shape,
        facets: &[u32],
        corners: &[u32],
        changed: &[u32],
        gone: u32,
    ) -> Result<Option<f64>> {
        let mut fresh: Vec<(u32, Patch)> = Vec::with_capacity(changed.len());
        for &i in changed {
            let facet = &shape.facets[i as usize];
            let is_upright = facet.is_held || facet.moments.faces(facet.plane.normal);
            let Some(own) = triangles(shape, facet)?.filter(|_| is_upright) else { return Ok(None) };
            let mut patch = Patch::new(own, |c| shape.point(c));
            patch.triangles.iter_mut().flatten().for_each(|c| *c = corners[*c as usize]);
            fresh.push((facets[i as usize], patch));
        }
        let replaced: BTreeSet<u32> = fresh.iter().map(|(k, _)| *k).chain([gone]).collect();
        let others = || (0..).zip(&self.patches).filter(|(k, _)| !replaced.contains(k));
        // No side of a triangle twice: facets that share two corners may both have the diagonal.
        let own: BTreeSet<u32> =
            fresh.iter().flat_map(|(_, patch)| patch.triangles.iter().flatten().copied()).collect();
        let mut met: HashMap<[u32; 2], u32> = HashMap::new();
        let beside = others().filter(|(_, patch)| fresh.iter().any(|(_, new)| new.is_near(patch)));
        let all = fresh.iter().map(|(_, patch)| patch).chain(beside.map(|(_, patch)| patch));
        for side in all.flat_map(|patch| &patch.triangles).flat_map(|t| sides(t).collect::<Vec<_>>()) {
            if side.iter().all(|c| own.contains(c)) {
                *met.entry(side).or_default() += 1;
            }
        }
        let fresh_sides =
            fresh.iter().flat_map(|(_, patch)| &patch.triangles).flat_map(|t| sides(t).collect::<Vec<_>>());
        for side in fresh_sides {
            if met.get(&side).is_some_and(|n| *n > 1) {
                return Ok(None);
            }
        }
        for (i, (k, patch)) in fresh.iter().enumerate() {
            let later = fresh[i + 1..].iter().map(|(j, other)| (*j, other));
            for (j, other) in later.chain(others()) {
                let is_old = self.scan.standing.has(self.parts[*k as usize], self.parts[j as usize])
                    || (self.is_passing[*k as usize] && self.is_passing[j as usize]);
                if !is_old && patch.crosses(other) {
                    return Ok(None);
                }
            }
        }
        let before: f64 = replaced.iter().map(|&k| self.patches[k as usize].off_mesh).sum();
        Ok(Some(fresh.iter().map(|(_, patch)| patch.off_mesh(self.scan)).sum::<f64>() - before))
    }
}
