//! What the labelling knows of the mesh.

use crate::buckets::Buckets;
use crate::mesh::vector::{add, area_vector, norm, unit, Point};
use crate::mesh::{edge_lengths, Connectivity};
use crate::surfaces::Samples;
use crate::{memory, Result};

/// A mesh with noise.
pub struct Domain<'a> {
    /// Its halfedges.
    pub connectivity: &'a Connectivity,
    /// Its vertices.
    pub positions: &'a [Point],
    /// Its edge lengths, column `i` opposite corner `i`.
    pub lengths: Vec<[f64; 3]>,
    /// The area vector of each face.
    pub areas: Vec<Point>,
    /// Standard deviation of the noise along the normal.
    pub sigma: f64,
    /// Mean length of the edges.
    pub mean_edge: f64,
    /// What a parameter costs.
    pub kappa: f64,
    /// The sum of the areas of the faces at each vertex.
    around: Vec<f64>,
    faces_at: Buckets<u32>,
}

impl<'a> Domain<'a> {
    /// A mesh whose noise has standard deviation `sigma` along the normal, which is not 0.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub fn new(connectivity: &'a Connectivity, positions: &'a [Point], sigma: f64) -> Result<Self> {
        let faces = connectivity.faces();
        let lengths = edge_lengths(faces, positions)?;
        let area = |face: &[u32; 3]| area_vector(face.map(|v| positions[v as usize]));
        let areas: Vec<Point> = memory::gathered(faces.iter().map(area))?;
        let mut around = memory::repeated(0.0, positions.len())?;
        for (face, area) in faces.iter().zip(&areas) {
            face.iter().for_each(|&v| around[v as usize] += norm(*area));
        }
        let (sum, count) =
            connectivity.edges().fold((0.0, 0_usize), |(s, n), h| (s + lengths[h / 3][h % 3], n + 1));
        let faces_at = Buckets::new(positions.len(), |visit| {
            for (f, face) in (0_u32..).zip(faces) {
                face.iter().for_each(|&v| visit(v as usize, f));
            }
        })?;
        let used = around.iter().filter(|area| **area > 0.0).count();
        Ok(Self {
            connectivity,
            positions,
            lengths,
            areas,
            sigma,
            mean_edge: sum / count.max(1) as f64,
            kappa: 0.5 * (used.max(2) as f64).ln(),
            around,
            faces_at,
        })
    }

    /// The part of vertex `v` that is of face `f`, one of its faces.
    #[must_use]
    pub fn share(&self, f: usize, v: u32) -> f64 {
        let around = self.around[v as usize];
        if around > 0.0 {
            norm(self.areas[f]) / around
        } else {
            0.0
        }
    }

    /// The faces at a vertex.
    #[must_use]
    pub fn faces_at(&self, v: u32) -> &[u32] {
        self.faces_at.of(v as usize)
    }

    /// The faces across the edges of `f`, each with the halfedge of `f` there.
    pub fn around(&self, f: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (3 * f..3 * f + 3).filter_map(|h| self.connectivity.mate(h).map(|mate| (h, mate / 3)))
    }

    /// The vertices of some faces as samples: weights are the faces' shares of them,
    /// normals the faces' mean there.
    ///
    /// # Errors
    /// [`crate::Error::Solve`].
    pub fn samples(&self, faces: &[u32]) -> Result<Samples> {
        let mut corners: Vec<(u32, u32)> = memory::room(3 * faces.len())?;
        corners.extend(faces.iter().flat_map(|&f| self.connectivity.faces()[f as usize].map(|v| (v, f))));
        corners.sort_unstable();
        let mut samples = Samples::default();
        for same in corners.chunk_by(|a, b| a.0 == b.0) {
            let v = same[0].0;
            let weight: f64 = same.iter().map(|&(_, f)| self.share(f as usize, v)).sum();
            let normal = same.iter().fold([0.0; 3], |sum, &(_, f)| add(sum, self.areas[f as usize]));
            if weight > 0.0 {
                samples.push(self.positions[v as usize], unit(normal), weight)?;
            }
        }
        Ok(samples)
    }
}
