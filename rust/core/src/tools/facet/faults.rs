//! Facets that cannot stay as they are.

use std::collections::HashSet;

use super::crossings::crossings;
use super::shape::Shape;
use super::triangulation::{forced, triangles};
use crate::memory;
use crate::mesh::vector::Point;
use crate::Result;

/// The facets of a shape as triangles, and which of them are unsound.
#[derive(Debug, Clone, Default)]
pub(super) struct Inspection {
    pub triangles: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub owners: Vec<u32>,
    /// Facets whose loops cross or run the wrong way around.
    pub crossed: Vec<u32>,
    /// Pairs of facets that pass through each other; only looked for where no facet is crossed.
    pub pairs: HashSet<[u32; 2]>,
}

impl Inspection {
    /// Looks at every facet, and at all together where `is_thorough` or all of them are sound.
    pub(super) fn new(shape: &Shape, is_thorough: bool) -> Result<Self> {
        let mut found = Self::default();
        for (k, facet) in (0..).zip(&shape.facets) {
            let own = triangles(shape, facet).unwrap_or_else(|| {
                found.crossed.push(k);
                forced(facet)
            });
            memory::extend(&mut found.owners, own.len())?;
            found.owners.extend(own.iter().map(|_| k));
            memory::extend(&mut found.triangles, own.len())?;
            found.triangles.extend(own);
        }
        if is_thorough || found.crossed.is_empty() {
            let pair = |[i, j]: [u32; 2]| {
                let (p, q) = (found.owners[i as usize], found.owners[j as usize]);
                [p.min(q), p.max(q)]
            };
            found.pairs = crossings(&found.triangles, |c| shape.point(c))?.into_iter().map(pair).collect();
        }
        Ok(found)
    }

    /// The places of the triangles.
    pub(super) fn places(&self, shape: &Shape) -> Result<Vec<[Point; 3]>> {
        Ok(memory::gathered(self.triangles.iter().map(|t| t.map(|c| shape.point(c))))?)
    }

    /// Facets that are crossed, or pass through others as they did not `before`.
    pub(super) fn faults(&self, before: &HashSet<[u32; 2]>) -> Vec<u32> {
        let passing = self.pairs.iter().filter(|pair| !before.contains(*pair)).flatten();
        let mut all: Vec<u32> = self.crossed.iter().chain(passing).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
