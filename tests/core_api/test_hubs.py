"""A vertex with hundreds of neighbors: energies with a Hessian or Laplacian at vertices have a dense row."""

import numpy as np
import pytest
import ridgeform


def double_cone(count: int) -> ridgeform.Mesh:
    """Two cones on one rim of so many edges that waves."""
    angles = 2 * np.pi * np.arange(count) / count
    rim = np.column_stack([np.cos(angles), np.sin(angles), 0.05 * np.sin(5 * angles)])
    a, b = np.arange(count), (np.arange(count) + 1) % count
    tips = count, count + 1
    faces = np.concatenate(
        [np.column_stack([np.full(count, tips[0]), a, b]), np.column_stack([np.full(count, tips[1]), b, a])]
    )
    return ridgeform.Mesh(np.vstack([rim, [[0, 0, 0.3], [0, 0, -0.4]]]), faces)


@pytest.fixture(scope="module")
def cones() -> ridgeform.Mesh:
    return double_cone(400)


def laplacian_squares(mesh: ridgeform.Mesh) -> np.ndarray:
    """The dense matrix of the energy `l2_laplacian`, twice."""
    laplacian = ridgeform.cotangent_laplacian(mesh) @ np.eye(mesh.n_vertices)
    return laplacian @ (laplacian / ridgeform.voronoi_mass(mesh)[:, None])


def test_laplacian_interpolation_is_that_of_the_dense_matrix(cones: ridgeform.Mesh) -> None:
    pins = np.arange(0, 400, 40)
    values = np.cos(pins * 1.0)
    found = ridgeform.interpolate(cones, pins, values, energy="l2_laplacian").values
    free = np.setdiff1d(np.arange(cones.n_vertices), pins)
    matrix = laplacian_squares(cones)
    expected = np.linalg.solve(matrix[np.ix_(free, free)], -matrix[np.ix_(free, pins)] @ values)
    np.testing.assert_allclose(found[free], expected, atol=1e-7)


@pytest.mark.parametrize("energy", ["l2_hessian", "l2_laplacian"])
def test_no_direction_lowers_the_energy(cones: ridgeform.Mesh, energy: str) -> None:
    pins = np.arange(0, 400, 40)
    found = ridgeform.interpolate(cones, pins, np.cos(pins * 1.0), energy=energy).values
    random = np.random.default_rng(0)
    least = ridgeform.energy(cones, found, kind=energy)
    for _ in range(20):
        direction = random.normal(size=cones.n_vertices)
        direction[pins] = 0.0
        step = 1e-3 * np.sqrt(least / ridgeform.energy(cones, direction, kind=energy))
        ahead, behind = (
            ridgeform.energy(cones, found + sign * step * direction, kind=energy) for sign in (1, -1)
        )
        assert abs(ahead - behind) < 1e-6 * 1e-3 * least


def test_modes_are_those_of_the_dense_matrix(cones: ridgeform.Mesh) -> None:
    found = ridgeform.vibration_modes(cones, 6, energy="l2_laplacian")
    root = np.sqrt(ridgeform.voronoi_mass(cones))
    values = np.linalg.eigvalsh(laplacian_squares(cones) / root / root[:, None])[:6]
    energies = [ridgeform.energy(cones, mode, kind="l2_laplacian") for mode in found.T]
    np.testing.assert_allclose(2 * np.array(energies), values, rtol=1e-5, atol=1e-6 * values[-1])


@pytest.mark.parametrize("n_columns", [1, 3])
def test_sums_of_absolute_values_are_solved_with_a_gap(cones: ridgeform.Mesh, n_columns: int) -> None:
    values = np.random.default_rng(1).normal(size=(cones.n_vertices, n_columns))
    found = ridgeform.denoise(
        cones, values, fidelity=1.0, energy="l1_hessian_stein2018", coupling="separate", tolerance=1e-3
    )
    assert found.status == "solved"
    assert 0 <= found.gap <= 1e-3


def test_modes_settle_at_thousands_of_neighbors() -> None:
    # Where rows were not cut, rounding in the factor was such that they did not, after half a minute.
    mesh = double_cone(4000)
    found = ridgeform.vibration_modes(mesh, 4, energy="l2_hessian")
    mass = ridgeform.voronoi_mass(mesh)
    np.testing.assert_allclose(found.T @ (mass[:, None] * found), np.eye(4), atol=1e-8)
    assert np.ptp(found[:, 0]) < 1e-5 * np.abs(found[:, 0]).max()
    energies = [ridgeform.energy(mesh, mode, kind="l2_hessian") for mode in found.T]
    assert energies == sorted(energies)
    # Those of a mesh that is half as fine, to what that leaves out.
    half = double_cone(2000)
    others = ridgeform.vibration_modes(half, 4, energy="l2_hessian").T
    coarse = [ridgeform.energy(half, mode, kind="l2_hessian") for mode in others]
    np.testing.assert_allclose(energies[1:], coarse[1:], rtol=0.05)


def test_a_rim_of_thousands_around_one_vertex_is_restored_onto_its_plane() -> None:
    cones = double_cone(4000)
    vertices = cones.vertices[:-1].copy()
    vertices[:, 2] = 0.0
    vertices += np.random.default_rng(1).normal(scale=0.002, size=vertices.shape)
    found = ridgeform.restore(ridgeform.Mesh(vertices, cones.faces[:4000]))
    rim = found.vertices[:-1]
    assert [piece["kind"] for piece in found.surfaces] == ["plane"]
    assert np.abs(rim - vertices[:-1]).max() < 0.01
    spread = np.linalg.svd(rim - rim.mean(0), compute_uv=False)
    assert spread[2] < 1e-9 * spread[0]


def test_a_pyramid_whose_rim_is_in_hundreds_of_pieces_has_its_planes_as_facets() -> None:
    along = np.arange(200) / 100 - 1
    right = np.column_stack([np.ones(200), along, np.zeros(200)])
    quarter = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    rim = np.concatenate([right @ np.linalg.matrix_power(quarter, k) for k in range(4)])
    a, b = np.arange(800), (np.arange(800) + 1) % 800
    top, bottom = np.column_stack([np.full(800, 800), a, b]), np.column_stack([np.full(800, 801), b, a])
    vertices = np.vstack([rim, [[0, 0, 1.0], [0, 0, 0.0]]])
    found = ridgeform.facet(ridgeform.Mesh(vertices, np.concatenate([top, bottom])))
    assert found.n_facets == 5
    assert len(found.vertices) == 5
    assert found.largest < 1e-9
