//! What a call is about: the mesh in the unit of the calculation, and which of its faces take part.

use super::mirror::Mirror;
use super::options::FacetOptions;
use super::regions::OUTSIDE;
use crate::error::MeshError;
use crate::memory;
use crate::mesh::vector::{between, distance, scale, sub, Point};
use crate::mesh::Working;
use crate::Result;

/// A mesh, moved and scaled to a box of diagonal 1 around the origin, and what of it takes part.
pub(super) struct Job<'a> {
    pub(super) working: &'a Working<'a>,
    pub(super) center: Point,
    pub(super) diagonal: f64,
    pub(super) positions: Vec<Point>,
    /// Vertices that stay.
    pub(super) is_fixed: Vec<bool>,
    /// Faces that name three vertices, in order; the others are none.
    pub(super) parts: Vec<u32>,
    /// Of those: whether they are not to be merged.
    pub(super) is_held: Vec<bool>,
    /// Whether facets are to be regions of the mesh to the end, on which its triangles can be put.
    pub(super) keeps: bool,
    /// The plane that the vertices on it stay on, in the unit of the calculation.
    pub(super) mirror: Option<Mirror>,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        working: &'a Working<'a>,
        options: &FacetOptions,
        mirror: Option<Mirror>,
    ) -> Result<Self> {
        let here = working.mesh();
        let faces = here.connectivity().faces();
        let positions = here.positions().ok_or(MeshError::NoPositions)?;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in faces.iter().flatten().map(|&v| positions[v as usize]) {
            for c in 0..3 {
                (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
            }
        }
        Self::within(working, options, mirror, (between(low, high, 0.5), distance(low, high)))
    }

    /// The same in the unit of calculation of a box with this middle and diagonal.
    pub(super) fn within(
        working: &'a Working<'a>,
        options: &FacetOptions,
        mirror: Option<Mirror>,
        (center, diagonal): (Point, f64),
    ) -> Result<Self> {
        let here = working.mesh();
        let faces = here.connectivity().faces();
        let positions = here.positions().ok_or(MeshError::NoPositions)?;
        let is_sound = |f: &[u32; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
        let sound = (0..).zip(faces).filter(|(_, face)| is_sound(face));
        let parts: Vec<u32> = memory::sifted(sound.map(|(f, _)| f))?;
        if parts.is_empty() || !(diagonal > 0.0 && diagonal.is_finite()) {
            return Err(MeshError::NoFaces.into());
        }
        let mut is_fixed = memory::repeated(false, positions.len())?;
        if let Some(mask) = &options.faces {
            let unselected = faces.iter().zip(mask).filter(|(_, &selected)| !selected);
            unselected.flat_map(|(face, _)| face).for_each(|&v| is_fixed[v as usize] = true);
        }
        let is_held = |&f: &u32| faces[f as usize].iter().any(|&v| is_fixed[v as usize]);
        let mirror = mirror.map(|Mirror { axis, at }| {
            let here = at - working.place([0.0; 3])[axis];
            Mirror { axis, at: (here - center[axis]) * (1.0 / diagonal) }
        });
        Ok(Self {
            mirror,
            working,
            center,
            diagonal,
            positions: memory::gathered(positions.iter().map(|&p| scale(sub(p, center), 1.0 / diagonal)))?,
            is_held: memory::gathered(parts.iter().map(is_held))?,
            is_fixed,
            parts,
            keeps: options.keep_triangles,
        })
    }

    /// Labels of all faces from those of the parts.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn labels(&self, of_parts: impl IntoIterator<Item = u32>) -> Result<Vec<u32>> {
        let mut labels = memory::repeated(OUTSIDE, self.working.mesh().connectivity().n_faces())?;
        self.parts.iter().zip(of_parts).for_each(|(&f, label)| labels[f as usize] = label);
        Ok(labels)
    }

    /// The places of the parts.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn places(&self) -> Result<Vec<[Point; 3]>> {
        let faces = self.working.mesh().connectivity().faces();
        let place = |&f: &u32| faces[f as usize].map(|v| self.positions[v as usize]);
        Ok(memory::gathered(self.parts.iter().map(place))?)
    }
}
