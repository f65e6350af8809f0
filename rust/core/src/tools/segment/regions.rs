//! Regions between clear ridges: sides of a few rows of faces, as the reveals of windows, which the Hessian
//! cannot see and which hold parallel sides apart.
//!
//! Where the noise is a small part of an edge, the normals of faces, averaged over neighbors that are alike,
//! tell on which edges the surface turns sharply. What closed lines of such edges enclose is segmented by
//! itself: a plane, a curved side, or more of them. That a shape is made of such sides is a hypothesis, and
//! is tested for each connected part: its clear ridges must close. Those of characters end in smooth places.

use super::constants::{
    ALIKE_NORMALS, CLEAR_RIDGE, MOST_OPEN_RIDGES, MOST_REGION_NOISE, NORMAL_ROUNDS, ONE_SIDE,
};
use super::crease::Border;
use super::explain::Explain;
use super::merge::{greedy, rename};
use super::surface::{pieces, Surface};
use crate::mesh::partition::contiguous;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, distance, norm, scale, unit, Point};
use crate::{memory, Result};

/// The regions, and how sharply the surface turns between them.
pub(super) struct Regions {
    /// The region of each face, from 0.
    pub labels: Vec<u32>,
    /// Unit normals averaged over neighbors that are alike.
    normals: Vec<Point>,
}

impl Regions {
    /// The regions of a shape whose noise has this standard deviation; nothing where that hides ridges, or
    /// where there is only one region for each connected part. `explain` says which are noise on a neighbor.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn between_clear_ridges(
        surface: &Surface<'_>,
        noise: f64,
        explain: &Explain<'_>,
    ) -> Result<Option<Self>> {
        if noise > MOST_REGION_NOISE * surface.mean_edge {
            return Ok(None);
        }
        let normals = averaged(surface)?;
        let mut partition = Partition::new(surface.n_faces())?;
        for f in 0..surface.n_faces() {
            for (_, g) in
                surface.around(f).filter(|&(_, g)| g > f && distance(normals[f], normals[g]) < ONE_SIDE)
            {
                partition.unite(f as u32, g as u32);
            }
        }
        let roots = (0..surface.n_faces() as u32).map(|f| partition.root(f));
        let mut regions = Self { labels: contiguous(&memory::gathered(roots)?)?.0, normals };
        let mut labels = std::mem::take(&mut regions.labels);
        regions.join(surface, &mut labels, CLEAR_RIDGE)?;
        explain.run(&mut labels)?;
        let (parts, n_parts) = pieces(surface, &memory::repeated(0, labels.len())?)?;
        let closes = regions.closed_parts(surface, &labels, &parts, n_parts)?;
        for (label, &part) in labels.iter_mut().zip(&parts) {
            if !closes[part as usize] {
                *label = u32::MAX - 1;
            }
        }
        let (labels, count) = pieces(surface, &labels)?;
        regions.labels = labels;
        Ok((count > n_parts).then_some(regions))
    }

    /// Of each connected part whether nearly all of its clear ridges are borders of regions.
    fn closed_parts(
        &self,
        surface: &Surface<'_>,
        labels: &[u32],
        parts: &[u32],
        n_parts: usize,
    ) -> Result<Vec<bool>> {
        let (mut open, mut total) = (memory::repeated(0.0, n_parts)?, memory::repeated(0.0, n_parts)?);
        for f in 0..labels.len() {
            for (h, g) in surface.around(f).filter(|&(_, g)| g > f) {
                if distance(self.normals[f], self.normals[g]) > CLEAR_RIDGE {
                    let (length, part) = (surface.lengths[f][h % 3], parts[f] as usize);
                    total[part] += length;
                    open[part] += if labels[f] == labels[g] { length } else { 0.0 };
                }
            }
        }
        let closes = open.iter().zip(&total).map(|(open, total)| *open <= MOST_OPEN_RIDGES * total);
        Ok(memory::gathered(closes)?)
    }

    /// Joins segments where the surface turns by less than `bend` on average along their border,
    /// the least turn first.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn join(&self, surface: &Surface<'_>, labels: &mut [u32], bend: f64) -> Result<()> {
        let merges = greedy(&self.borders(surface, labels)?, bend)?;
        rename(labels, &merges);
        Ok(())
    }

    /// The borders between segments with the mean turn along them, over what a border costs there.
    fn borders(&self, surface: &Surface<'_>, labels: &[u32]) -> Result<Vec<Border>> {
        let mut edges: Vec<Edge> = Vec::new();
        for f in 0..labels.len() {
            for (h, g) in surface.around(f).filter(|&(_, g)| g > f && labels[g] != labels[f]) {
                let turn = distance(self.normals[f], self.normals[g]) / surface.costs[f][h % 3].max(1e-3);
                let pair = [labels[f].min(labels[g]), labels[f].max(labels[g])];
                memory::push(&mut edges, ((pair, h), surface.lengths[f][h % 3], turn))?;
            }
        }
        edges.sort_unstable_by_key(|edge| edge.0);
        let border = |edges: &[Edge]| {
            let length: f64 = edges.iter().map(|edge| edge.1).sum();
            let sum: f64 = edges.iter().map(|edge| edge.1 * edge.2).sum();
            Border { labels: edges[0].0 .0, length, strength: sum / length.max(f64::MIN_POSITIVE) }
        };
        Ok(memory::sifted(edges.chunk_by(|a, b| a.0 .0 == b.0 .0).map(border))?)
    }
}

/// A border edge: its labels and halfedge, its length, and how far the surface turns there.
type Edge = (([u32; 2], usize), f64, f64);

/// Unit normals averaged over neighbors, by areas and by how alike they are:
/// bilateral filtering (Zheng et al. 2011).
fn averaged(surface: &Surface<'_>) -> Result<Vec<Point>> {
    let own = (0..surface.n_faces()).map(|f| unit(surface.vector_area(f)));
    let mut normals: Vec<Point> = memory::gathered(own)?;
    for _ in 0..NORMAL_ROUNDS {
        let mean = |f: usize| {
            let near = surface.around(f).map(|(_, g)| {
                let apart = distance(normals[f], normals[g]) / ALIKE_NORMALS;
                scale(normals[g], surface.areas[g] * (-apart * apart).exp())
            });
            let sum = near.fold(scale(normals[f], surface.areas[f]), add);
            if norm(sum) > 0.0 {
                unit(sum)
            } else {
                normals[f]
            }
        };
        normals = memory::gathered((0..surface.n_faces()).map(mean))?;
    }
    Ok(normals)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mesh::Mesh;
    use crate::progress::Progress;
    use crate::shapes;

    /// How many regions there are, of a mesh with noise of that share of the mean edge.
    fn count(mesh: &Mesh, noise: f64) -> usize {
        let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
        let costs = vec![[1.0; 3]; connectivity.n_faces()];
        let surface = Surface::new(connectivity, positions, 1.0, costs).unwrap();
        let (noise, least) = (noise * surface.mean_edge, 0.02 * surface.mean_edge);
        let explain = Explain {
            surface: &surface,
            deviation: noise.max(least),
            flat: (1.5 * noise).max(least),
            most_faces: 20,
            curved: true,
            regions: None,
            progress: &Progress::new(),
        };
        let found = Regions::between_clear_ridges(&surface, noise, &explain).unwrap();
        found.map_or(1, |regions| contiguous(&regions.labels).unwrap().1)
    }

    #[test]
    fn a_noisy_cube_has_six() {
        for n in [6, 16] {
            // Uniform noise of that amplitude has 0.58 of it as its standard deviation.
            let cube = shapes::cube(n).noisy(0.08 * 2.0 / n as f64, 3);
            assert_eq!(count(&cube.mesh().unwrap(), 0.045), 6, "{n}");
        }
    }

    #[test]
    fn ridges_that_end_make_no_region() {
        // A fold in a sheet that fades away, beside a cube.
        let sheet = shapes::grid(24, 24).map(|[x, y, _]| {
            let steep = (1.0 - y / 16.0).clamp(0.0, 1.0);
            [x, y, steep * (x - 12.0).abs()]
        });
        assert_eq!(count(&sheet.mesh().unwrap(), 0.02), 1);
        let cube = shapes::cube(8).map(|p| [4.0 * p[0] + 40.0, 4.0 * p[1], 4.0 * p[2]]);
        assert_eq!(count(&sheet.and(&cube).mesh().unwrap(), 0.02), 7);
    }

    #[test]
    fn curved_shapes_have_one() {
        assert_eq!(count(&shapes::icosphere(3).mesh().unwrap(), 0.02), 1);
        assert_eq!(count(&shapes::icosphere(1).mesh().unwrap(), 0.05), 1);
        assert_eq!(count(&shapes::cylinder(12, 12, 1.0, 3.0).mesh().unwrap(), 0.02), 1);
    }
}
