//! Vertices that an energy does not touch: with the Hessian of Stein et al. 2018b,
//! the tips of triangles with two boundary edges.

use crate::linear::Columns;
use crate::mesh::Mesh;
use crate::operators::{Dual, Energy, EnergyForm};
use crate::progress::Progress;
use crate::solve::{quadratic, Coupling, Problem, Settings};
use crate::Result;

/// The vertices of faces that no block of the energy touches, if there are any.
pub(super) fn unseen(mesh: &Mesh, form: &EnergyForm) -> Option<Vec<bool>> {
    let mut unseen = vec![false; mesh.connectivity().n_vertices()];
    for &corner in mesh.connectivity().faces().iter().flatten() {
        unseen[corner as usize] = true;
    }
    for (&column, value) in form.operator.columns.iter().zip(&form.operator.values) {
        if value.iter().any(|x| *x != 0.0) {
            unseen[column as usize] = false;
        }
    }
    unseen.contains(&true).then_some(unseen)
}

/// Sets the values of the `unseen` vertices so that the gradient jumps as little as possible there:
/// linear extrapolation.
///
/// # Errors
/// [`crate::Error::Cancelled`], and a factorization that fails.
pub(super) fn extend(mesh: &Mesh, unseen: &[bool], values: &mut Columns, progress: &Progress) -> Result<()> {
    let form = EnergyForm::new(Energy::L1EdgeLaplacian, mesh, None, Dual::default())?;
    let problem = Problem {
        operator: &form.operator,
        weights: form.weights,
        fidelity: vec![0.0; unseen.len()],
        target: values.clone(),
        fixed: unseen.iter().map(|unseen| !unseen).collect(),
        linear_constraints: None,
        coupling: Coupling::Separate,
    };
    *values = quadratic::minimize(&problem, &Settings::default(), &progress.patient())?.values;
    Ok(())
}
