//! Scattered data interpolation (Rowe et al. 2024, eq. (22)).

use super::scalar::{ScalarOptions, ScalarProblem};
use crate::linear::Columns;
use crate::mesh::partition::Partition;
use crate::mesh::{Connectivity, Mesh};
use crate::progress::Progress;
use crate::solve::Solution;
use crate::unit::Unit;
use crate::{memory, Error, Result};

/// `min_u E(u)` with `u` given at the vertices `indices`: row `r` of `values` belongs to `indices[r]`, `E` is
/// the energy of the options. Vertices that no face uses get the mean of the given values.
///
/// Source: Rowe et al. 2024, eq. (22).
///
/// # Errors
/// Indices out of range, repeated or none, a connected part of the mesh without any given value, and the
/// errors of [`super::denoise`].
pub fn interpolate(
    mesh: &Mesh,
    indices: &[usize],
    values: &Columns,
    options: &ScalarOptions,
    progress: &Progress,
) -> Result<Solution> {
    let connectivity = mesh.connectivity();
    let n = connectivity.n_vertices();
    if indices.is_empty() {
        return Err(Error::argument("indices", "is empty; give the value of at least one vertex"));
    }
    values.check("values", indices.len())?;
    let mut fixed = vec![false; n];
    let k = values.n_columns;
    let mut target = Columns::try_zeros(n, k)?;
    for c in 0..k {
        // In the values' own unit: a sum of the largest numbers is none.
        let unit = Unit::of(values.column(c).iter().copied());
        let mean = values.column(c).iter().map(|x| unit.measure(*x)).sum::<f64>() / indices.len() as f64;
        target.column_mut(c).fill(unit.restore(mean));
    }
    for (row, &i) in indices.iter().enumerate() {
        if i >= n {
            return Err(Error::argument(
                "indices",
                format!("entry {row} is {i}, but there are only {n} vertices"),
            ));
        }
        if std::mem::replace(&mut fixed[i], true) {
            return Err(Error::argument("indices", format!("names vertex {i} twice; give each value once")));
        }
        for c in 0..k {
            target.column_mut(c)[i] = values.column(c)[row];
        }
    }
    if options.linear_constraints.is_none() {
        refuse_unknown_component(connectivity, &fixed)?;
    }
    let problem = ScalarProblem { mesh, options, fidelity: 0.0, target, fixed };
    problem.run(progress)
}

/// Refuses a connected part with faces but without a known vertex: nothing would determine its values.
fn refuse_unknown_component(connectivity: &Connectivity, known: &[bool]) -> Result<()> {
    let mut parts = Partition::new(connectivity.n_vertices())?;
    for &[a, b, c] in connectivity.faces() {
        parts.unite(a, b);
        parts.unite(a, c);
    }
    let mut has_value = memory::repeated(false, connectivity.n_vertices())?;
    for (v, _) in known.iter().enumerate().filter(|(_, known)| **known) {
        has_value[parts.root(v as u32) as usize] = true;
    }
    for (f, &[a, _, _]) in connectivity.faces().iter().enumerate() {
        if !has_value[parts.root(a) as usize] {
            return Err(Error::argument(
                "indices",
                format!(
                    "gives no value on the connected part of the mesh with face {f}; give at least one there"
                ),
            ));
        }
    }
    Ok(())
}
