//! The four matrices whose product is the Hessian (Rowe et al. 2024, supplement A), one by one: what
//! [`hessian`] assembles in one pass is compared with them.
#![allow(clippy::unwrap_used)]

use sprs::{CsMat, TriMat};

use crate::error::MeshError;
use crate::mesh::{triangle, Mesh};
use crate::operators::dual::DualEdge;
use crate::operators::hinge::{directions, usable_areas, Hinge};
use crate::operators::{hessian, Dual};
use crate::shapes::{self, Random};

/// The gradient `G` (Rowe et al. 2024, eqs. (19) and (28)): `2m × n`, rows `x, y` of every face's gradient in
/// the frame of [`triangle::layout`]. Degenerate faces have zero rows.
fn gradient(mesh: &Mesh) -> CsMat<f64> {
    let connectivity = mesh.connectivity();
    let mut entries = TriMat::new((2 * connectivity.n_faces(), connectivity.n_vertices()));
    for (f, &l) in mesh.edge_lengths().iter().enumerate().filter(|(_, &l)| !triangle::is_degenerate(l)) {
        let [_, [l_ij, _], [x, y]] = triangle::layout(l);
        let [i, j, k] = connectivity.faces()[f].map(|v| v as usize);
        entries.add_triplet(2 * f, i, -1.0 / l_ij);
        entries.add_triplet(2 * f, j, 1.0 / l_ij);
        // l_ki cos θ_i = x and l_ki sin θ_i = y.
        entries.add_triplet(2 * f + 1, i, (x - l_ij) / (l_ij * y));
        entries.add_triplet(2 * f + 1, j, -x / (l_ij * y));
        entries.add_triplet(2 * f + 1, k, 1.0 / y);
    }
    entries.to_csr()
}

/// The hinge map `C` (Rowe et al. 2024, eqs. (15), (20) and (29)): `6m × 2m`, rows `2h, 2h + 1` the
/// difference across halfedge `h` of the neighbor's gradient, turned into the frame of the face, and the
/// face's own. Edges without a usable twin have zero rows.
fn hinge_map(mesh: &Mesh) -> CsMat<f64> {
    let m = mesh.connectivity().n_faces();
    let areas = usable_areas(mesh.edge_lengths());
    let mut entries = TriMat::new((6 * m, 2 * m));
    for (h, twin) in hinges(mesh, &areas) {
        let (f, g) = (h / 3, twin / 3);
        let [x, y] = directions(mesh.edge_lengths()[f], areas[f])[h % 3];
        let [u, v] = directions(mesh.edge_lengths()[g], areas[g])[twin % 3];
        // The rotation that turns the twin's direction (u, v) into the opposite of the halfedge's.
        let (cosine, sine) = (-(x * u + y * v), -(y * u - x * v));
        entries.add_triplet(2 * h, 2 * g, cosine);
        entries.add_triplet(2 * h, 2 * g + 1, -sine);
        entries.add_triplet(2 * h + 1, 2 * g, sine);
        entries.add_triplet(2 * h + 1, 2 * g + 1, cosine);
        entries.add_triplet(2 * h, 2 * f, -1.0);
        entries.add_triplet(2 * h + 1, 2 * f + 1, -1.0);
    }
    entries.to_csr()
}

/// The tensor product `T` (Rowe et al. 2024, supplement A): `4m × 6m`, rows `xx, xy, yx, yy` of
/// `Σ_i (1/l*_i) (c_i · t_i) t_i ⊗ t_i` for the differences `c` of [`hinge_map`] and the dual edges `l* t`.
///
/// # Errors
/// [`MeshError::ZeroDualEdge`] with circumcentric duals where two circumcenters coincide.
fn tensor_product(mesh: &Mesh, dual: Dual) -> Result<CsMat<f64>, MeshError> {
    let m = mesh.connectivity().n_faces();
    let areas = usable_areas(mesh.edge_lengths());
    let mut entries = TriMat::new((4 * m, 6 * m));
    for (h, twin) in hinges(mesh, &areas) {
        let f = h / 3;
        let edge = DualEdge::new(dual, &Hinge::new(mesh.edge_lengths(), &areas, h, twin))
            .ok_or(MeshError::ZeroDualEdge { face: f, neighbor: twin / 3 })?
            .turned(directions(mesh.edge_lengths()[f], areas[f])[h % 3]);
        let length = edge[0].hypot(edge[1]);
        let t = edge.map(|e| e / length);
        for (k, along) in t.into_iter().enumerate() {
            for row in 0..4 {
                entries.add_triplet(4 * f + row, 2 * h + k, along * t[row / 2] * t[row % 2] / length);
            }
        }
    }
    Ok(entries.to_csr())
}

/// The face areas `M_F`: `4m × 4m`, every area four times on the diagonal.
fn face_areas(mesh: &Mesh) -> CsMat<f64> {
    let areas = mesh.edge_lengths().iter().flat_map(|&l| [triangle::area(l); 4]).collect();
    let n = 4 * mesh.connectivity().n_faces();
    CsMat::new((n, n), (0..=n).collect(), (0..n).collect(), areas)
}

/// The halfedges between two faces with an area, with their twins.
fn hinges<'a>(mesh: &'a Mesh, areas: &'a [f64]) -> impl Iterator<Item = (usize, usize)> + 'a {
    let usable = |h: usize| areas[h / 3] > 0.0;
    (0..mesh.connectivity().n_halfedges())
        .filter_map(|h| mesh.connectivity().twin(h).map(|twin| (h, twin)))
        .filter(move |&(h, twin)| usable(h) && usable(twin))
}

/// Equal up to 1e-12 of the largest entry of the rows' face.
fn assert_same(a: &CsMat<f64>, b: &CsMat<f64>) {
    let (a, b) = (a.to_dense(), b.to_dense());
    assert_eq!(a.shape(), b.shape());
    for row in 0..a.shape()[0] {
        let scale = (row / 4 * 4..row / 4 * 4 + 4)
            .flat_map(|r| b.row(r).to_vec())
            .fold(0.0_f64, |s, x| s.max(x.abs()));
        for column in 0..a.shape()[1] {
            let (x, y) = (a[[row, column]], b[[row, column]]);
            assert!((x - y).abs() <= 1e-12 * scale, "({row}, {column}): {x} against {y}");
        }
    }
}

fn product_of_factors(mesh: &Mesh, dual: Dual) -> CsMat<f64> {
    let hinged = &tensor_product(mesh, dual).unwrap() * &hinge_map(mesh);
    &face_areas(mesh) * &(&hinged * &gradient(mesh))
}

#[test]
fn the_assembled_hessian_is_the_product_of_the_factors() {
    let mut random = Random::new(7);
    for seed in 0..24 {
        let amplitude = 0.2 * random.uniform();
        for shape in [shapes::tetrahedron(), shapes::cylinder(6, 3, 1.0, 2.0), shapes::icosphere(1)] {
            let mesh = shape.noisy(amplitude, seed).mesh().unwrap();
            let dual = Dual::Barycentric;
            assert_same(&hessian(&mesh, dual).unwrap(), &product_of_factors(&mesh, dual));
        }
        let mesh = shapes::icosphere(1).noisy(0.3 * amplitude, seed).mesh().unwrap();
        let dual = Dual::Circumcentric;
        assert_same(&hessian(&mesh, dual).unwrap(), &product_of_factors(&mesh, dual));
    }
}
