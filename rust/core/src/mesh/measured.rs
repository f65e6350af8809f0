//! A mesh in its own unit of length.

use std::borrow::Cow;

use super::Mesh;
use crate::memory::{self, Tool};
use crate::unit::Unit;
use crate::Result;

impl Mesh {
    /// The unit of length in which the mesh is computed with: for the coordinates of the vertices that have
    /// faces, or for the edge lengths.
    #[must_use]
    pub fn unit(&self) -> Unit {
        match self.positions() {
            None => Unit::of(self.edge_lengths().iter().flatten().copied()),
            Some(positions) => {
                let corners = self.connectivity().faces().iter().flatten();
                Unit::of(corners.flat_map(|&v| positions[v as usize]))
            }
        }
    }

    /// The mesh measured in `unit`. Vertices without faces are at the origin where they would be no numbers.
    ///
    /// # Errors
    /// [`crate::Error::Memory`] where a copy does not fit; in another unit than the mesh's own [`Mesh::unit`]
    /// those of a mesh whose lengths are no numbers.
    pub fn measured(&self, unit: Unit) -> Result<Cow<'_, Self>> {
        if unit.is_one() {
            return Ok(Cow::Borrowed(self));
        }
        self.demand(Tool::Mesh).admit(None)?;
        let measured = |row: &[f64; 3]| row.map(|x| unit.measure(x));
        let Some(positions) = self.positions() else {
            let lengths = memory::gathered(self.edge_lengths().iter().map(measured))?;
            return Ok(Cow::Owned(Self::from_connectivity(self.connectivity().copied()?, lengths)?));
        };
        let place =
            |p: &[f64; 3]| Some(measured(p)).filter(|p| p.iter().all(|x| x.is_finite())).unwrap_or_default();
        let faces = memory::twin(self.connectivity().faces())?;
        Ok(Cow::Owned(Self::new(memory::gathered(positions.iter().map(place))?, faces)?))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_mesh_of_any_size_is_the_same_in_its_unit() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.25, 1.5, 0.0], [1e30, 0.0, 0.0]];
        let plain = Mesh::new(points.to_vec(), vec![[0, 1, 2]]).unwrap();
        assert!(plain.unit().is_one());
        for size in [2_f64.powi(-1000), 2_f64.powi(900)] {
            let mesh = Mesh::new(points.map(|p| p.map(|x| x * size)).to_vec(), vec![[0, 1, 2]]).unwrap();
            assert_eq!(mesh.unit(), Unit::of_size(size));
            let measured = mesh.measured(mesh.unit()).unwrap();
            assert_eq!(measured.edge_lengths(), plain.edge_lengths());
            let [length, scaled] = [plain.edge_lengths()[0][1], mesh.edge_lengths()[0][1] / size];
            assert!((scaled - length).abs() <= 4.0 * f64::EPSILON * length);
        }
    }
}
