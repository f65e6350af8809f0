//! Normals, areas and dihedral angles of a region as it is now.

use super::region::Region;
use crate::memory;
use crate::mesh::vector::{area_vector, centroid, cross, distance, dot, norm, scale, Point};
use crate::remesh::editable::{key, Wings};
use crate::Result;

/// The angle between two directions of any length, in radians.
pub(super) fn angle(a: Point, b: Point) -> f64 {
    norm(cross(a, b)).atan2(dot(a, b))
}

/// What snapping and the decision look at.
pub(super) struct FaceGeometry {
    /// The unit normal of every face; zero where it has no area.
    pub normals: Vec<Point>,
    /// The area of every face.
    pub areas: Vec<f64>,
    /// The barycenter of every face.
    pub centers: Vec<Point>,
    /// The largest dihedral angle (0 where flat) at the edges of every face.
    pub face_angles: Vec<f64>,
}

impl FaceGeometry {
    pub(super) fn of(region: &Region) -> Result<Self> {
        let mesh = &region.mesh;
        let corners = memory::sifted(mesh.faces().map(|(_, face)| mesh.corners(face)))?;
        let vectors = memory::gathered(corners.iter().map(|&c| area_vector(c)))?;
        let areas = memory::gathered(vectors.iter().map(|&a| norm(a)))?;
        let normal = |(a, &area): (&Point, &f64)| if area > 0.0 { scale(*a, 1.0 / area) } else { [0.0; 3] };
        let mut surface = Self {
            normals: memory::gathered(vectors.iter().zip(&areas).map(normal))?,
            centers: memory::gathered(corners.into_iter().map(centroid))?,
            face_angles: memory::repeated(0.0, areas.len())?,
            areas,
        };
        for [a, b] in mesh.edges()? {
            let Some(Wings { faces, .. }) = mesh.wings(a, b) else { continue };
            let theta = surface.dihedral(faces);
            for f in faces {
                let largest = &mut surface.face_angles[f as usize];
                *largest = largest.max(theta);
            }
        }
        Ok(surface)
    }

    /// The dihedral angle between two faces, 0 where they are coplanar.
    pub(super) fn dihedral(&self, [f, g]: [u32; 2]) -> f64 {
        angle(self.normals[f as usize], self.normals[g as usize])
    }
}

/// How much the patch is bent in all: `Σ length · |dihedral angle|` over its edges and those of its rim.
pub(super) fn total_bend(region: &Region) -> Result<f64> {
    let surface = FaceGeometry::of(region)?;
    let mesh = &region.mesh;
    let bend = |[a, b]: [u32; 2]| {
        let faces = mesh.wings(a, b)?.faces;
        let at_patch = faces.iter().any(|&f| region.is_patch(f));
        at_patch.then(|| distance(mesh.position(a), mesh.position(b)) * surface.dihedral(faces))
    };
    Ok(mesh.edges()?.into_iter().filter_map(bend).sum())
}

/// The edges at the patch that are bent by more than `least` radians, by vertices of the whole mesh,
/// smaller first.
pub(super) fn ridges(region: &Region, least: f64) -> Result<Vec<[u32; 2]>> {
    let surface = FaceGeometry::of(region)?;
    let mesh = &region.mesh;
    let bent = |&[a, b]: &[u32; 2]| {
        let faces = mesh.wings(a, b).map(|wings| wings.faces);
        faces
            .is_some_and(|faces| faces.iter().any(|&f| region.is_patch(f)) && surface.dihedral(faces) > least)
    };
    let edges = mesh.edges()?.into_iter().filter(bent);
    Ok(memory::sifted(edges.map(|[a, b]| key(region.global(a), region.global(b))))?)
}
