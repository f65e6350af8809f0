//! A coarser mesh, whose faces are merged in the place of a large mesh's own.

use super::job::Job;
use super::regions::OUTSIDE;
use crate::error::MeshError;
use crate::levels::level;
use crate::mesh::vector::distance;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::{memory, Result};

/// A coarser mesh, and what its parts stand for.
#[derive(Debug, PartialEq)]
pub(super) struct Coarse {
    pub mesh: Mesh,
    /// For each vertex the nearest of those that it stands for.
    pub origins: Vec<u32>,
    /// The face that each face of the finer mesh lies on.
    pub homes: Vec<u32>,
}

impl Coarse {
    /// The mesh of a job with about so many vertices; nothing where its edges do not collapse as far.
    pub(super) fn of(job: &Job<'_>, n_vertices: usize, progress: &Progress) -> Result<Option<Self>> {
        let fine = job.working.mesh();
        let positions = fine.positions().ok_or(MeshError::NoPositions)?;
        let level = level(fine, None, None, n_vertices, progress)?;
        let points = level.mesh.positions().ok_or(MeshError::NoPositions)?;
        if 2 * points.len() > positions.len() {
            return Ok(None);
        }
        let mut origins = memory::repeated(OUTSIDE, points.len())?;
        let mut nearest = memory::repeated(f64::INFINITY, points.len())?;
        let standing =
            (0..).zip(&level.parents).zip(positions).filter(|((_, &parent), _)| parent != u32::MAX);
        for ((v, &parent), &position) in standing {
            let away = distance(position, points[parent as usize]);
            if away < nearest[parent as usize] {
                (nearest[parent as usize], origins[parent as usize]) = (away, v);
            }
        }
        let homes = level.carry.faces(fine, &level.mesh)?;
        Ok(Some(Self {
            origins,
            homes: memory::gathered(homes.into_iter().map(|home| home.unwrap_or(0)))?,
            mesh: level.mesh,
        }))
    }
}
