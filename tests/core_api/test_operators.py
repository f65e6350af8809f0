"""The operators on shapes with known answers: surface Hessian, mass, Laplacian, Delaunay flips."""

import numpy as np
import pytest
import ridgeform
from hypothesis import given, strategies as st
from known_shapes import shapes
from reference import block_norms, dense_hessian


def bumpy(shape, seed=0, size=0.2):
    """The shape with isotropic noise, so that nothing is symmetric or flat by chance."""
    vertices, faces = shape
    return shapes.add_noise(vertices, faces, size, seed), faces


CLOSED = {"tetrahedron": shapes.tetrahedron(), "icosphere": shapes.icosphere(1), "torus": shapes.torus(8, 6)}
OPEN = {"cone": shapes.open_cone(), "flat": shapes.random_delaunay(30), "grid": shapes.grid(3, 4)}


@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
@pytest.mark.parametrize("dual", ["barycentric", "circumcentric"])
def test_hessian_equals_an_independent_dense_computation(name, dual):
    vertices, faces = bumpy((CLOSED | OPEN)[name])
    ours = ridgeform.hessian(ridgeform.Mesh(vertices, faces), dual=dual).to_scipy().toarray()
    expected = dense_hessian(vertices, faces, dual)
    assert ours.shape == (4 * len(faces), len(vertices))
    assert np.abs(ours - expected).max() <= 1e-12 * np.abs(expected).max()


@given(seed=st.integers(0, 2**31), n=st.integers(4, 24), height=st.floats(0.0, 1.0))
def test_hessian_equals_the_dense_computation_on_random_meshes(seed, n, height):
    vertices, faces = shapes.random_delaunay(n, seed)
    vertices[:, 2] = height * np.random.default_rng(seed).standard_normal(n)
    ours = ridgeform.hessian(ridgeform.Mesh(vertices, faces)).to_scipy().toarray()
    expected = dense_hessian(vertices, faces)
    # Random points make slivers; both computations lose what their angles lose.
    lengths = ridgeform.Mesh(vertices, faces).edge_lengths
    corners = vertices[faces]
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    conditioning = (lengths.max(axis=1) ** 2 / areas).max()
    assert np.abs(ours - expected).max() <= 1e-13 * conditioning * np.abs(expected).max()


@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_constants_have_no_hessian(name):
    vertices, faces = bumpy((CLOSED | OPEN)[name])
    hessian = ridgeform.hessian(ridgeform.Mesh(vertices, faces))
    rounding = 1e-13 * np.abs(hessian.data).max()
    assert np.abs(hessian @ np.full(len(vertices), 7.0)).max() <= 7 * rounding


@given(
    slope=st.tuples(*[st.floats(-10, 10)] * 3),
    dual=st.sampled_from(["barycentric", "circumcentric"]),
    seed=st.integers(0, 50),
)
def test_affine_functions_on_flat_meshes_have_no_hessian(slope, dual, seed):
    vertices, faces = shapes.random_delaunay(25, 3)
    vertices = vertices @ shapes.random_rotation(seed).T
    hessian = ridgeform.hessian(ridgeform.Mesh(vertices, faces), dual=dual)
    values = vertices @ np.array(slope) + 1.0
    assert np.abs(hessian @ values).max() <= 1e-13 * np.abs(hessian.data).max() * (1.0 + np.abs(slope).sum())


@pytest.mark.parametrize(
    ("function", "norm"),
    [(lambda x, y: x * x, 2.0), (lambda x, y: y * y, 2.0), (lambda x, y: x * y, np.sqrt(2.0))],
    ids=["xx", "yy", "xy"],
)
def test_quadratics_on_the_equilateral_lattice_have_one_and_a_half_times_their_hessian(function, norm):
    vertices, faces = shapes.flat_lattice(8, 8)
    mesh = ridgeform.Mesh(vertices, faces)
    boundary = np.concatenate(ridgeform.boundary_loops(mesh))
    inner = ~np.isin(faces, boundary).any(axis=1)
    assert inner.sum() > 50
    norms = ridgeform.hessian_norm(mesh, function(vertices[:, 0], vertices[:, 1]))
    np.testing.assert_allclose(norms[inner], 1.5 * norm, rtol=1e-12)


def test_rows_are_xx_xy_yx_yy_in_the_frame_of_the_first_edge():
    vertices, faces = shapes.flat_lattice(6, 6)
    mesh = ridgeform.Mesh(vertices, faces)
    along_x = np.abs(vertices[faces[:, 1]] - vertices[faces[:, 0]])[:, 1] < 1e-12
    inner = ~np.isin(faces, np.concatenate(ridgeform.boundary_loops(mesh))).any(axis=1)
    rows = (ridgeform.hessian(mesh) @ vertices[:, 0] ** 2).reshape(-1, 4)[along_x & inner]
    area = np.sqrt(3.0) / 4.0
    assert len(rows) > 5
    np.testing.assert_allclose(rows, area * np.array([[3.0, 0.0, 0.0, 0.0]]).repeat(len(rows), 0), atol=1e-12)


def test_bending_along_an_edge_of_a_strip_changes_nothing():
    vertices, faces = shapes.grid(6, 1)
    bent = vertices.copy()
    right = bent[:, 0] > 3
    angle = 0.7
    bent[right, 2] = np.sin(angle) * (bent[right, 0] - 3)
    bent[right, 0] = 3 + np.cos(angle) * (bent[right, 0] - 3)
    flat, folded = (ridgeform.hessian(ridgeform.Mesh(v, faces)).data for v in (vertices, bent))
    np.testing.assert_allclose(folded, flat, atol=1e-13)


@given(seed=st.integers(0, 2**31), scale=st.floats(1e-6, 1e6))
def test_rigid_motions_and_scalings_change_nothing(seed, scale):
    vertices, faces = bumpy(shapes.icosphere(1))
    shift = np.random.default_rng(seed).standard_normal(3)
    moved = scale * (vertices @ shapes.random_rotation(seed).T + shift)
    before, after = (ridgeform.hessian(ridgeform.Mesh(v, faces)) for v in (vertices, moved))
    np.testing.assert_array_equal(before.indices, after.indices)
    np.testing.assert_allclose(after.data, before.data, atol=1e-12 * np.abs(before.data).max())


@given(seed=st.integers(0, 2**31))
def test_renumbering_vertices_and_faces_renumbers_columns_and_blocks(seed):
    vertices, faces = bumpy(shapes.open_cone())
    rng = np.random.default_rng(seed)
    new_of_old, order = rng.permutation(len(vertices)), rng.permutation(len(faces))
    renumbered = np.empty_like(vertices)
    renumbered[new_of_old] = vertices
    before = ridgeform.hessian(ridgeform.Mesh(vertices, faces)).to_scipy().toarray()
    after = ridgeform.hessian(ridgeform.Mesh(renumbered, new_of_old[faces[order]])).to_scipy().toarray()
    blocks = before.reshape(len(faces), 4, -1)[order].reshape(before.shape)
    np.testing.assert_allclose(after[:, new_of_old], blocks, atol=1e-12 * np.abs(before).max())


def test_lengths_and_positions_give_the_same_operators():
    vertices, faces = bumpy(shapes.torus(8, 6))
    placed = ridgeform.Mesh(vertices, faces)
    intrinsic = ridgeform.Mesh.from_edge_lengths(faces, placed.edge_lengths)
    for operator in (ridgeform.hessian, ridgeform.cotangent_laplacian):
        np.testing.assert_array_equal(operator(placed).data, operator(intrinsic).data)
    np.testing.assert_array_equal(ridgeform.voronoi_mass(placed), ridgeform.voronoi_mass(intrinsic))
    assert ridgeform.energy(placed, vertices) == ridgeform.energy(intrinsic, vertices)


def test_norm_and_energy_are_those_of_the_matrix():
    vertices, faces = bumpy(shapes.icosphere(1))
    mesh = ridgeform.Mesh(vertices, faces)
    rows = ridgeform.hessian(mesh).to_scipy().toarray()
    corners = vertices[faces]
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    for values in (vertices[:, 0], vertices):
        norms = block_norms(rows, values)
        np.testing.assert_allclose(ridgeform.hessian_norm(mesh, values) * areas, norms, rtol=1e-11)
        assert ridgeform.energy(mesh, values) == pytest.approx(norms.sum(), rel=1e-12)
    circumcentric = block_norms(ridgeform.hessian(mesh, dual="circumcentric").to_scipy().toarray(), vertices)
    assert ridgeform.energy(mesh, vertices, dual="circumcentric") == pytest.approx(
        circumcentric.sum(), rel=1e-12
    )


def test_mass_is_the_area():
    for vertices, faces, area in [(*shapes.cube(4), 24.0), (*shapes.flat_lattice(4, 3), 24 * np.sqrt(3) / 4)]:
        mass = ridgeform.voronoi_mass(ridgeform.Mesh(vertices, faces))
        assert mass.dtype == np.float64
        assert mass.shape == (len(vertices),)
        assert mass.sum() == pytest.approx(area, rel=1e-13)
        assert (mass > 0).all()
    # A right triangle gives half to the right angle's corner; an obtuse one too.
    right = ridgeform.Mesh([[0, 0, 0], [2, 0, 0], [0, 2, 0]], [[0, 1, 2]])
    np.testing.assert_allclose(ridgeform.voronoi_mass(right), [1.0, 0.5, 0.5], rtol=1e-14)


def test_laplacian_measures_the_gradient():
    vertices, faces = shapes.random_delaunay(30)
    mesh = ridgeform.Mesh(vertices, faces)
    laplacian = ridgeform.cotangent_laplacian(mesh).to_scipy().toarray()
    assert laplacian.shape == (30, 30)
    np.testing.assert_allclose(laplacian, laplacian.T, atol=1e-13)
    np.testing.assert_allclose(laplacian.sum(axis=1), 0.0, atol=1e-11)
    area = ridgeform.voronoi_mass(mesh).sum()
    for axis in (0, 1):
        assert vertices[:, axis] @ laplacian @ vertices[:, axis] == pytest.approx(area, rel=1e-12)
    assert np.linalg.eigvalsh(laplacian).min() >= -1e-12


def opposite_cotangents(mesh):
    """The sum of the cotangents opposite every interior edge: negative where it is not Delaunay."""
    lengths, faces = mesh.edge_lengths, mesh.faces
    sums = {}
    for corners, row in zip(faces.tolist(), lengths, strict=True):
        for i in range(3):
            a, b, c = row[i], row[i - 1], row[i - 2]
            cosine = np.clip((b * b + c * c - a * a) / (2 * b * c), -1, 1)
            edge = (min(corners[i - 1], corners[i - 2]), max(corners[i - 1], corners[i - 2]), round(a, 9))
            sums.setdefault(edge, []).append(cosine / max(np.sqrt(1 - cosine * cosine), 1e-12))
    return np.array([sum(pair) for pair in sums.values() if len(pair) == 2])


def test_delaunay_flips_make_every_edge_delaunay():
    vertices, faces = shapes.random_delaunay(40, 5)
    sheared = vertices.copy()
    sheared[:, 0] += 3 * sheared[:, 1]
    before = ridgeform.Mesh(sheared, faces)
    after = ridgeform.intrinsic_delaunay(before)
    assert opposite_cotangents(before).min() < -0.5
    assert opposite_cotangents(after).min() >= -1e-7
    assert after.vertices is None
    assert (after.n_vertices, after.n_faces) == (before.n_vertices, before.n_faces)
    # On a flat mesh the intrinsic lengths are the distances.
    ends = sheared[after.faces]
    distances = np.linalg.norm(np.roll(ends, -1, axis=1) - np.roll(ends, -2, axis=1), axis=2)
    np.testing.assert_allclose(after.edge_lengths, distances, rtol=1e-9)


def test_a_delaunay_mesh_stays_as_it_is():
    mesh = ridgeform.Mesh(*shapes.random_delaunay(40))
    after = ridgeform.intrinsic_delaunay(mesh)
    np.testing.assert_array_equal(after.faces, mesh.faces)
    np.testing.assert_array_equal(after.edge_lengths, mesh.edge_lengths)


def test_coinciding_circumcenters_are_refused_by_name():
    square = ridgeform.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    assert ridgeform.hessian(square).shape == (8, 4)
    with pytest.raises(ridgeform.MeshError, match=r"faces 0 and 1 .*barycentric"):
        ridgeform.hessian(square, dual="circumcentric")
