"""`vibration_modes`: against dense eigenvectors, known spectra, and the constraints of the L1 modes."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def assert_orthonormal(mesh, modes):
    """With respect to the Voronoi mass."""
    gram = modes.T @ (ridgeform.voronoi_mass(mesh)[:, None] * modes)
    np.testing.assert_allclose(gram, np.eye(modes.shape[1]), atol=1e-9)


def energies(mesh, modes, kind):
    """The energy of each column."""
    return np.array([ridgeform.energy(mesh, u, kind=kind) for u in modes.T])


def test_quadratic_modes_equal_those_of_dense_matrices():
    vertices, faces = shapes.torus(14, 9)
    vertices = shapes.add_noise(vertices, faces, 0.1, seed=3)
    mesh = ridgeform.Mesh(vertices, faces)
    mass = ridgeform.voronoi_mass(mesh)
    laplacian = ridgeform.cotangent_laplacian(mesh) @ np.eye(len(vertices))
    half = laplacian / np.sqrt(mass)[:, None] / np.sqrt(mass)[None, :]
    expected, vectors = np.linalg.eigh(half @ half)
    modes = ridgeform.vibration_modes(mesh, 7, energy="l2_laplacian")
    np.testing.assert_allclose(2 * energies(mesh, modes, "l2_laplacian"), expected[:7], rtol=1e-6, atol=1e-8)
    # The same space, whatever the basis of equal eigenvalues.
    overlap = vectors[:, :7].T @ (np.sqrt(mass)[:, None] * modes)
    np.testing.assert_allclose(np.linalg.svd(overlap)[1], 1, atol=1e-6)


def test_the_sphere_has_spherical_harmonics():
    mesh = ridgeform.Mesh(*shapes.icosphere(3))
    modes = ridgeform.vibration_modes(mesh, 9, energy="l2_curved_hessian")
    assert_orthonormal(mesh, modes)
    np.testing.assert_allclose(
        energies(mesh, modes, "l2_curved_hessian"), [0, *[2] * 3, *[18] * 5], rtol=0.05, atol=1e-9
    )


def double_cone(n):
    """Two cones on one rim of so many edges, whose triangles are slimmer the more there are."""
    angles = 2 * np.pi * np.arange(n) / n
    rim = np.column_stack([np.cos(angles), np.sin(angles), 0.05 * np.sin(5 * angles)])
    here, after = 2 + np.arange(n), 2 + (np.arange(n) + 1) % n
    faces = [np.column_stack([0 * here, here, after]), np.column_stack([0 * here + 1, after, here])]
    return np.vstack([[[0, 0, 0.3], [0, 0, -0.3]], rim]), np.concatenate(faces)


def ring(n):
    """Two rings of thin squares around a hole of so many edges: very many modes of nearly one energy."""
    angles = 2 * np.pi * np.arange(n) / n
    rows = [
        [(1 + 0.1 * k) * np.cos(a), (1 + 0.1 * k) * np.sin(a), 0.05 * k * k] for k in range(3) for a in angles
    ]
    here = np.arange(n)
    after = (here + 1) % n
    faces = []
    for k in range(0, 2 * n, n):
        faces += [np.column_stack([k + here, k + n + here, k + n + after])]
        faces += [np.column_stack([k + here, k + n + after, k + after])]
    return np.array(rows), np.concatenate(faces)


@pytest.mark.filterwarnings("ignore:a problem between the modes missed")
@pytest.mark.parametrize(("shape", "n"), [(double_cone, 8000), (ring, 2000)])
def test_modes_of_slim_triangles_settle(shape, n):
    # Neither had settled after 300 rounds: rounding held up the cone, modes of nearly one energy the ring.
    mesh = ridgeform.Mesh(*shape(n))
    modes = ridgeform.vibration_modes(mesh, 3, max_iterations=10)
    assert_orthonormal(mesh, modes)
    constant, first, second = energies(mesh, modes, "l1_hessian")
    assert constant < 1e-6 * first
    # Round shapes have modes in pairs, one the other turned.
    np.testing.assert_allclose(first, second, rtol=0.01)


@pytest.mark.parametrize(
    ("shape", "kernel"), [(shapes.icosphere(2), 1), (shapes.random_delaunay(90), 3)], ids=["sphere", "square"]
)
def test_l1_modes_start_with_the_kernel_and_have_sharper_ridges_than_quadratic_ones(shape, kernel):
    mesh = ridgeform.Mesh(*shape)
    modes = ridgeform.vibration_modes(mesh, 5)
    assert modes.shape == (mesh.n_vertices, 5)
    assert modes.flags.c_contiguous
    assert_orthonormal(mesh, modes)
    own = energies(mesh, modes, "l1_hessian")
    assert own[kernel - 1] < 1e-6 * own[kernel]
    assert (np.diff(own) >= -1e-6 * own[-1]).all()
    assert (modes.max(axis=0) >= -(1 - 1e-5) * modes.min(axis=0)).all()
    smooth = ridgeform.vibration_modes(mesh, 5, energy="l2_curved_hessian")
    assert own.sum() < 0.98 * energies(mesh, smooth, "l1_hessian").sum()
    np.testing.assert_array_equal(modes, ridgeform.vibration_modes(mesh, 5, threads=1))


def test_progress_is_told_and_finishing_keeps_what_there_is(cancelled):
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    progress = ridgeform.Progress()
    progress.finish()
    assert ridgeform.vibration_modes(mesh, 3, progress=progress).shape == (42, 1)
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.vibration_modes(mesh, 3, progress=cancelled)
    with pytest.warns(RuntimeWarning, match="missed its tolerance"):
        ridgeform.vibration_modes(mesh, 3, tolerance=1e-12, max_iterations=2)


@pytest.mark.parametrize(
    ("count", "keywords", "message"),
    [
        (0, {}, "count: "),
        (43, {}, "count: is 43; ask for 1 to 42 modes"),
        (2, {"energy": "h2"}, "energy: "),
        (2, {"energy": "l2_laplacian", "solver": "fast"}, "solver: "),
        (2, {"face_weights": np.ones(3)}, "face_weights: "),
    ],
)
def test_wrong_arguments_are_refused(count, keywords, message):
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.vibration_modes(mesh, count, **keywords)
