//! The lumped mass matrix.

use crate::error::SolveError;
use crate::mesh::{triangle, Connectivity, Mesh};
use crate::{memory, Result};

/// The mixed Voronoi area of every vertex (Meyer et al. 2003), `n` values that sum to the total area.
///
/// A triangle without an obtuse angle is split by its Voronoi cells; an obtuse one gives half its area to the
/// obtuse corner and a quarter to each of the others. Unreferenced vertices get 0.
///
/// # Errors
/// [`SolveError::Memory`].
pub fn voronoi_mass(
    connectivity: &Connectivity,
    lengths: &[[f64; 3]],
) -> std::result::Result<Vec<f64>, SolveError> {
    let mut mass = memory::repeated(0.0, connectivity.n_vertices())?;
    for (corners, &l) in connectivity.faces().iter().zip(lengths) {
        for (&corner, part) in corners.iter().zip(corner_areas(l)) {
            mass[corner as usize] += part;
        }
    }
    Ok(mass)
}

/// [`voronoi_mass`] of a mesh of any size.
///
/// # Errors
/// [`crate::error::SolveError::NoNumber`] where an area is past the largest number, or all are below the
/// smallest that has all its digits: what is computed with them would be as wrong.
pub fn mass_of(mesh: &Mesh) -> Result<Vec<f64>> {
    let unit = mesh.unit();
    let mut mass = voronoi_mass(mesh.connectivity(), mesh.measured(unit)?.edge_lengths())?;
    let has_area = mass.iter().any(|area| *area > 0.0);
    for area in &mut mass {
        *area = unit.power(2).restore_finite("an area", *area)?;
    }
    if has_area && !unit.is_one() && mass.iter().all(|area| *area < f64::MIN_POSITIVE) {
        return Err(SolveError::NoNumber { what: "an area" }.into());
    }
    Ok(mass)
}

/// The three corners' parts of a triangle's area.
fn corner_areas(l: [f64; 3]) -> [f64; 3] {
    let area = triangle::area(l);
    if area == 0.0 {
        return [0.0; 3];
    }
    let cotangents = triangle::cotangents(l);
    if let Some(obtuse) = cotangents.iter().position(|&c| c < 0.0) {
        let mut parts = [0.25 * area; 3];
        parts[obtuse] = 0.5 * area;
        return parts;
    }
    let opposite = [0, 1, 2].map(|i| 0.125 * l[i] * l[i] * cotangents[i]);
    [opposite[1] + opposite[2], opposite[2] + opposite[0], opposite[0] + opposite[1]]
}
