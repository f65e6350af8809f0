//! The triangles of a sound shape, kept up to date facet by facet.

use std::collections::BTreeSet;

use super::faces::{Faces, Scan};
use super::shape::Shape;
use super::triangulation::{forced, triangles};
use crate::mesh::vector::Point;
use crate::remesh::crossings::cross;
use crate::{memory, Result};

/// The triangles of one facet.
#[derive(Debug, Clone, Default)]
pub(super) struct Patch {
    triangles: Vec<[u32; 3]>,
    places: Vec<[Point; 3]>,
    /// The corners of the bounding box.
    bounds: [Point; 2],
    /// The integral of the squared distance from the mesh.
    off_mesh: f64,
    /// After how many joins they were taken.
    n_joins: u32,
}

/// Facets and the triangles that they are to have.
pub(super) type Fresh = Vec<(u32, Patch)>;

/// The triangles of all facets.
pub(super) struct Skin<'s> {
    scan: &'s Scan,
    patches: Vec<Patch>,
    /// Facets with faces that pass through others on the mesh, and those beside them.
    is_passing: Vec<bool>,
    parts: Vec<u32>,
}

/// The bounds of nothing.
const NOWHERE: [Point; 2] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// The bounds of two boxes.
fn around([low, high]: [Point; 2], other: [Point; 2]) -> [Point; 2] {
    [[0, 1, 2].map(|c| low[c].min(other[0][c])), [0, 1, 2].map(|c| high[c].max(other[1][c]))]
}

fn meet(a: [Point; 2], b: [Point; 2]) -> bool {
    (0..3).all(|c| a[0][c] <= b[1][c] && b[0][c] <= a[1][c])
}

impl Patch {
    fn new(triangles: Vec<[u32; 3]>, point: impl Fn(u32) -> Point) -> Self {
        let places: Vec<[Point; 3]> = triangles.iter().map(|t| t.map(&point)).collect();
        let bounds = places.iter().flatten().fold(NOWHERE, |all, &p| around(all, [p, p]));
        Self { triangles, places, bounds, off_mesh: 0.0, n_joins: 0 }
    }

    fn off_mesh(&self, scan: &Scan) -> f64 {
        self.places.iter().map(|&place| scan.off_mesh(place)).sum()
    }

    /// The sides of its triangles.
    fn sides(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
    }

    fn is_near(&self, other: &Self) -> bool {
        meet(self.bounds, other.bounds)
    }

    fn crosses(&self, other: &Self) -> bool {
        let own = self.triangles.iter().zip(&self.places);
        own.into_iter().any(|of| other.triangles.iter().zip(&other.places).any(|with| cross(of, with)))
    }
}

impl<'s> Skin<'s> {
    pub(super) fn new(shape: &Shape, faces: &Faces<'s>) -> Result<Self> {
        let standing = faces.standing(shape)?;
        let mut skin = Self {
            scan: faces.scan,
            patches: memory::repeated(Patch::default(), shape.facets.len())?,
            is_passing: memory::gathered((0..shape.facets.len() as u32).map(|k| standing.contains(&k)))?,
            parts: memory::gathered(shape.facets.iter().map(|facet| facet.part))?,
        };
        for (facet, patch) in shape.facets.iter().zip(&mut skin.patches) {
            let own = match triangles(shape, facet)? {
                Some(own) => own,
                None => forced(facet)?,
            };
            *patch = Patch::new(own, |c| shape.point(c));
            patch.off_mesh = patch.off_mesh(faces.scan);
        }
        Ok(skin)
    }

    /// Takes other triangles of a facet, after `n_joins` joins.
    pub(super) fn put(&mut self, k: u32, patch: Patch, n_joins: u32) {
        self.patches[k as usize] = Patch { n_joins, ..patch };
    }

    /// A facet that becomes part of another.
    pub(super) fn remove(&mut self, gone: u32, kept: u32) {
        self.patches[gone as usize] = Patch::default();
        self.is_passing[kept as usize] |= self.is_passing[gone as usize];
    }

    /// The triangles of `changed` facets of `shape` in the place of those of `facets` and of one that is
    /// `gone`, and how much farther from the mesh they are; `None` where one of them is not sound.
    pub(super) fn tried(
        &self,
        (shape, facets, corners): (&Shape, &[u32], &[u32]),
        changed: &[u32],
        gone: u32,
    ) -> Result<Option<(Fresh, f64)>> {
        let mut fresh: Fresh = Vec::with_capacity(changed.len());
        for &i in changed {
            let facet = &shape.facets[i as usize];
            let is_upright = facet.is_held || facet.moments.faces(facet.plane.normal);
            let Some(own) = triangles(shape, facet)?.filter(|_| is_upright) else { return Ok(None) };
            let mut patch = Patch::new(own, |c| shape.point(c));
            patch.triangles.iter_mut().flatten().for_each(|c| *c = corners[*c as usize]);
            fresh.push((facets[i as usize], patch));
        }
        let is_apart = (1..fresh.len()).all(|i| {
            let (before, (k, patch)) = (fresh[..i].iter().map(|(j, other)| (*j, other)), &fresh[i]);
            !self.is_crossed(*k, patch, before)
        });
        let has_side_twice = sides(&fresh)?.windows(2).any(|pair| pair[0] == pair[1]);
        if !is_apart || has_side_twice || !self.is_clear(&fresh, gone, 0)? {
            return Ok(None);
        }
        fresh.iter_mut().for_each(|(_, patch)| patch.off_mesh = patch.off_mesh(self.scan));
        let replaced: BTreeSet<u32> = fresh.iter().map(|(k, _)| *k).chain([gone]).collect();
        let before: f64 = replaced.iter().map(|&k| self.patches[k as usize].off_mesh).sum();
        let off_mesh = fresh.iter().map(|(_, patch)| patch.off_mesh).sum::<f64>() - before;
        Ok(Some((fresh, off_mesh)))
    }

    /// Whether fresh triangles neither cross others that were taken after `n_joins` joins or more, nor have a
    /// side with them where they should not. What is far from all of them is not looked at.
    pub(super) fn is_clear(&self, fresh: &[(u32, Patch)], gone: u32, n_joins: u32) -> Result<bool> {
        let replaced: BTreeSet<u32> = fresh.iter().map(|(k, _)| *k).chain([gone]).collect();
        let all = fresh.iter().fold(NOWHERE, |all, (_, patch)| around(all, patch.bounds));
        let is_other = |(k, patch): &(u32, &Patch)| {
            patch.n_joins >= n_joins && meet(patch.bounds, all) && !replaced.contains(k)
        };
        let others: Vec<(u32, &Patch)> = memory::sifted((0..).zip(&self.patches).filter(is_other))?;
        let sides = sides(fresh)?;
        let beside = others.iter().filter(|(_, patch)| fresh.iter().any(|(_, new)| new.is_near(patch)));
        Ok(!beside.flat_map(|(_, patch)| patch.sides()).any(|side| sides.binary_search(&side).is_ok())
            && !fresh.iter().any(|(k, patch)| self.is_crossed(*k, patch, others.iter().copied())))
    }

    /// Whether the triangles of facet `k` cross those of others, and did not on the mesh.
    fn is_crossed<'p>(
        &self,
        k: u32,
        patch: &Patch,
        mut others: impl Iterator<Item = (u32, &'p Patch)>,
    ) -> bool {
        let is_old = |j: u32| {
            self.scan.standing.has(self.parts[k as usize], self.parts[j as usize])
                || (self.is_passing[k as usize] && self.is_passing[j as usize])
        };
        others.any(|(j, other)| patch.is_near(other) && !is_old(j) && patch.crosses(other))
    }
}

/// The sides of triangles, sorted. None may be there twice: facets that share two corners may both have the
/// diagonal.
fn sides(fresh: &[(u32, Patch)]) -> Result<Vec<[u32; 2]>> {
    let mut all: Vec<[u32; 2]> = memory::sifted(fresh.iter().flat_map(|(_, patch)| patch.sides()))?;
    all.sort_unstable();
    Ok(all)
}
