//! How many faces a refinement may make: the bound that ends what makes no progress.

use crate::mesh::vector::{area_vector, distance, norm, Point};
use crate::remesh::sizing::EQUILATERAL;
use crate::{Error, Result};

/// No edge length may ask for more faces than this: one that is too small by a factor of a thousand would
/// otherwise fill the memory.
const MOST_FACES: f64 = 5e7;

/// Passes that split come to so many times the faces that edges of the wanted length take, before others
/// collapse what is too short: twice as many in a round hole of 4000 edges, four times in one of 8000.
const OVERSHOOT: f64 = 4.0;

/// A patch has at least this many faces for each edge of its rim, when its edges grow as fast as they may.
const FACES_PER_RIM_EDGE: usize = 5;

/// About how many faces triangles are cut into by edges of this length: as many as their area takes, or where
/// they are thin, as their sides.
fn faces_in(corners: [Point; 3], length: f64) -> f64 {
    let [a, b, c] = corners;
    let around = distance(a, b) + distance(b, c) + distance(c, a);
    1.0 + around / length + 0.5 * norm(area_vector(corners)).max(0.0) / (EQUILATERAL * length * length)
}

/// The most faces that a splitting pass may add to `triangles`, each given with the length wanted in it, when
/// the result is to have `most` at most.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(crate) fn faces_to_add(triangles: impl Iterator<Item = ([Point; 3], f64)>, most: usize) -> usize {
    let wanted: f64 = triangles.map(|(corners, length)| faces_in(corners, length)).sum();
    // Not a number counts as too many.
    (OVERSHOOT * wanted).min(OVERSHOOT * most as f64) as usize
}

/// The faces that a patch may have when about `max_faces` were asked for:
/// more where the rim alone takes more.
pub(crate) fn patch_faces(max_faces: usize, n_rim_edges: usize) -> usize {
    max_faces.max(FACES_PER_RIM_EDGE * n_rim_edges)
}

/// Refuses an edge length that is not positive, or asks for more than [`MOST_FACES`] faces.
///
/// # Errors
/// [`Error::Argument`].
pub(crate) fn check_length(triangles: impl Iterator<Item = [Point; 3]>, length: f64) -> Result<()> {
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::argument("edge_length", format!("got {length}; pass a number > 0")));
    }
    let n_faces: f64 = triangles.map(|corners| faces_in(corners, length)).sum();
    if n_faces > MOST_FACES {
        let problem =
            format!("{length} would make {n_faces:.1e} faces, more than {MOST_FACES:.0e}; pass a larger one");
        return Err(Error::argument("edge_length", problem));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_needle_without_area_still_has_a_length_to_cut() {
        let needle = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert!(check_length(std::iter::once(needle), 1e-3).is_ok());
        let error = check_length(std::iter::once(needle), 1e-12).unwrap_err();
        assert!(error.to_string().contains("edge_length: 0.000000000001 would make 4.0e12 faces"), "{error}");
        assert_eq!(faces_to_add(std::iter::once((needle, 0.0)), 100), 400);
        assert_eq!(faces_to_add(std::iter::once((needle, 1.0)), 100), 20);
    }
}
