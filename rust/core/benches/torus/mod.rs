//! What the benchmarks of linear systems have in common: a noisy torus, its Hessian,
//! and the weights of the flow.

use ridgeform_core::block_rows::BlockRows;
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::shapes::{self, Shape};
use ridgeform_core::solve::normal_matrix::NormalMatrix;

pub(crate) struct Torus {
    pub(crate) shape: Shape,
    pub(crate) operator: BlockRows,
    pub(crate) fidelity: Vec<f64>,
    pub(crate) normal: NormalMatrix,
}

/// A torus of `around · across` vertices.
pub(crate) fn torus(around: usize, across: usize) -> Torus {
    let shape = shapes::torus(around, across, 3.0, 1.0).noisy(0.01, 1);
    let mesh = shape.mesh().unwrap();
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let operator = HessianPattern::new(connectivity)
        .unwrap()
        .assemble(connectivity, lengths, Dual::Barycentric)
        .unwrap();
    let fidelity = voronoi_mass(connectivity, lengths).unwrap().iter().map(|m| 2e4 * m).collect();
    let normal = NormalMatrix::new(&operator).unwrap();
    Torus { shape, operator, fidelity, normal }
}
