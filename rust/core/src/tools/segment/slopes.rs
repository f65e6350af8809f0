//! What bends across borders, face by face: gradients of values, or normals of the shape.

use super::constants::{
    BENDS_OF_A_STEP, LEAST_CONTACT, MOST_REACH, MOST_REACH_ON_A_SHAPE, REACH, REACH_OF_NOISE,
    REACH_ON_A_SHAPE,
};
use super::surface::{pieces, Surface};
use crate::linear::Columns;
use crate::mesh::triangle;
use crate::mesh::vector::Point;
use crate::{memory, Result};

/// What bends across borders, face by face: the gradients of a function, or the normals of the surface.
///
/// Normals of a shape and gradients of its coordinates jump by the same length, but vector areas add up to
/// what their outline has and forget the noise inside; unfolded gradients do not know a fold from its mirror
/// image.
pub(super) struct Slopes {
    pub n_columns: usize,
    /// For each face and column, the gradient in the frame of [`triangle::layout`]; for a shape the normal,
    /// as two rows that do not turn with frames.
    pub gradients: Vec<[f64; 2]>,
    pub is_shape: bool,
    /// Means over the faces.
    pub means: Vec<f64>,
    pub layouts: Vec<[[f64; 2]; 3]>,
    /// How far from a border at each face, in the unit of the segmentation, gradients are averaged.
    pub reach: Vec<f64>,
    /// What a step in the values counts per height.
    pub step: f64,
    /// The standard deviation of the noise of a value that one face gives.
    pub noise: f64,
    /// The least contact, see [`LEAST_CONTACT`].
    pub least_contact: f64,
}

impl Slopes {
    /// The shape itself, with `noise` of that standard deviation along the normals.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn of_shape(surface: &Surface<'_>, noise: f64) -> Result<Self> {
        let mut gradients = memory::room(2 * surface.n_faces())?;
        gradients.extend((0..surface.n_faces()).flat_map(|f| {
            let [x, y, z] = surface.vector_area(f).map(|x| x / surface.areas[f].max(f64::MIN_POSITIVE));
            [[x, y], [z, 0.0]]
        }));
        Ok(Self {
            n_columns: 2,
            gradients,
            is_shape: true,
            means: memory::repeated(0.0, 2 * surface.n_faces())?,
            layouts: layouts(surface)?,
            reach: reach_on_shape(surface, noise)?,
            step: 0.0,
            noise,
            least_contact: LEAST_CONTACT,
        })
    }

    /// An exact shape whose faces have the normals of their planes:
    /// one edge tells the angle between two of them.
    pub(super) fn of_planes(surface: &Surface<'_>, normals: &[Point]) -> Result<Self> {
        let mut gradients = memory::room(2 * normals.len())?;
        gradients.extend(normals.iter().flat_map(|&[x, y, z]| [[x, y], [z, 0.0]]));
        let reach = memory::repeated(0.0, normals.len())?;
        Ok(Self { gradients, reach, least_contact: 0.0, ..Self::of_shape(surface, 0.0)? })
    }

    /// `values` on the surface, with `noise` of that standard deviation.
    pub(super) fn of_values(surface: &Surface<'_>, values: &Columns, noise: f64) -> Result<Self> {
        let k = values.n_columns;
        let m = surface.n_faces();
        let layouts = layouts(surface)?;
        let (mut gradients, mut means) = (memory::room(k * m)?, memory::room(k * m)?);
        for (face, p) in surface.connectivity.faces().iter().zip(&layouts) {
            for c in 0..k {
                let [a, b, d] = face.map(|v| values.column(c)[v as usize]);
                let (width, height) = (p[1][0], p[2][1]);
                let x = if width > 0.0 { (b - a) / width } else { 0.0 };
                let y = if height > 0.0 { (d - a - x * p[2][0]) / height } else { 0.0 };
                gradients.push([x, y]);
                means.push((a + b + d) / 3.0);
            }
        }
        let (reach, step) =
            (memory::repeated(reach(surface, noise), m)?, BENDS_OF_A_STEP / surface.mean_edge);
        Ok(Self {
            n_columns: k,
            gradients,
            is_shape: false,
            means,
            layouts,
            reach,
            step,
            noise,
            least_contact: LEAST_CONTACT,
        })
    }
}

fn layouts(surface: &Surface<'_>) -> Result<Vec<[[f64; 2]; 3]>> {
    Ok(memory::gathered(surface.lengths.iter().map(|&l| triangle::layout(l)))?)
}

/// How far gradients are averaged: noise of values of range 1 makes slopes like noise of positions does.
fn reach(surface: &Surface<'_>, noise: f64) -> f64 {
    (REACH + REACH_OF_NOISE * noise / surface.mean_edge).min(MOST_REACH) * surface.mean_edge
}

/// How far normals are averaged on each face of a shape: the same for each of its connected parts however
/// densely that is sampled, and whatever else the mesh has, but for edges that are too long for it, or by far
/// too short.
fn reach_on_shape(surface: &Surface<'_>, noise: f64) -> Result<Vec<f64>> {
    let (piece, count) = pieces(surface, &memory::repeated(0, surface.n_faces())?)?;
    let mut areas = memory::repeated(0.0, count)?;
    piece.iter().zip(&surface.areas).for_each(|(&p, area)| areas[p as usize] += area);
    let (least, most) = (reach(surface, noise), MOST_REACH_ON_A_SHAPE * surface.mean_edge);
    let of_piece = |&p: &u32| (REACH_ON_A_SHAPE * areas[p as usize].sqrt()).min(most).max(least);
    Ok(memory::gathered(piece.iter().map(of_piece))?)
}
