"""`denoise`: known answers, what each keyword does, and what is refused."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


@pytest.fixture
def sphere():
    """A sphere with noise on its vertices."""
    vertices, faces = shapes.icosphere(2)
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.05), faces)


def test_affine_functions_on_flat_meshes_stay():
    vertices, faces = shapes.random_delaunay(40)
    affine = 3 * vertices[:, 0] - vertices[:, 1] + 2
    solution = ridgeform.denoise(ridgeform.Mesh(vertices, faces), affine, fidelity=1.0)
    np.testing.assert_allclose(solution.values, affine, atol=1e-4)
    assert solution.status == "solved"
    assert solution.objective == pytest.approx(0.0, abs=1e-3)


def test_constants_stay(sphere):
    solution = ridgeform.denoise(sphere, np.full(sphere.n_vertices, 5.0), fidelity=1e-3)
    np.testing.assert_allclose(solution.values, 5.0, atol=1e-4)


def test_fidelity_leads_from_the_smoothest_function_to_the_given_one(sphere):
    values = sphere.vertices[:, 2]
    steps = [ridgeform.denoise(sphere, values, fidelity=f).values for f in (1e-3, 1e1, 1e3, 1e9)]
    distances = [np.abs(step - values).max() for step in steps]
    energies = [ridgeform.energy(sphere, step) for step in steps]
    assert distances == sorted(distances, reverse=True)
    assert energies == sorted(energies)
    assert distances[-1] < 1e-4
    # The sphere has no affine functions but constants: the mean is what is left.
    mass = ridgeform.voronoi_mass(sphere)
    np.testing.assert_allclose(steps[0], mass @ values / mass.sum(), atol=1e-2)


def test_a_creased_signal_is_recovered():
    vertices, faces = shapes.flat_lattice(24, 24)
    roof = np.abs(vertices[:, 1] - 9 * np.sqrt(0.75))
    noisy = roof + 0.2 * np.random.default_rng(3).standard_normal(len(roof))
    mesh = ridgeform.Mesh(vertices, faces)
    mean_square = {
        sharpness: np.mean(
            (ridgeform.denoise(mesh, noisy, fidelity=1.0, sharpness=sharpness).values - roof) ** 2
        )
        for sharpness in (0.0, 0.5)
    }
    assert mean_square[0.0] < 0.2 * np.mean((noisy - roof) ** 2)
    assert mean_square[0.5] < mean_square[0.0]


def test_separate_columns_are_problems_of_their_own(sphere):
    together = ridgeform.denoise(sphere, sphere.vertices, fidelity=50.0, coupling="separate", tolerance=1e-5)
    alone = [
        ridgeform.denoise(sphere, sphere.vertices[:, c], fidelity=50.0, tolerance=1e-5) for c in range(3)
    ]
    np.testing.assert_allclose(together.values, np.column_stack([a.values for a in alone]), atol=1e-3)
    assert together.objective == pytest.approx(sum(a.objective for a in alone), rel=3e-5)


def test_one_column_is_the_same_joint_or_separate(sphere):
    values = sphere.vertices[:, 0]
    joint, separate = (
        ridgeform.denoise(sphere, values, fidelity=50.0, coupling=c) for c in ("joint", "separate")
    )
    np.testing.assert_array_equal(joint.values, separate.values)


def test_joint_columns_turn_with_their_frame(sphere):
    rotation = shapes.random_rotation(4)
    plain = ridgeform.denoise(sphere, sphere.vertices, fidelity=50.0)
    turned = ridgeform.denoise(sphere, sphere.vertices @ rotation.T, fidelity=50.0)
    np.testing.assert_allclose(turned.values, plain.values @ rotation.T, atol=1e-9)
    assert turned.objective == pytest.approx(plain.objective, rel=1e-9)


def test_weights_and_fidelity_scale_together(sphere):
    values = sphere.vertices[:, 1]
    plain = ridgeform.denoise(sphere, values, fidelity=50.0, tolerance=1e-6)
    scaled = ridgeform.denoise(
        sphere, values, fidelity=150.0, face_weights=np.full(sphere.n_faces, 3.0), tolerance=1e-6
    )
    assert scaled.objective == pytest.approx(3 * plain.objective, rel=1e-5)
    np.testing.assert_allclose(scaled.values, plain.values, atol=1e-3)


def test_constraint_matrices_of_every_kind(sphere):
    scipy_sparse = pytest.importorskip("scipy.sparse")
    values = sphere.vertices[:, 0]
    dense = np.zeros((2, sphere.n_vertices))
    dense[0, [1, 4]] = 1, -1
    dense[1] = ridgeform.voronoi_mass(sphere)
    right = [0.25, 1.0]
    results = [
        ridgeform.denoise(sphere, values, fidelity=50.0, linear_constraints=(matrix, right)).values
        for matrix in (dense, dense.tolist(), scipy_sparse.csr_matrix(dense), scipy_sparse.coo_array(dense))
    ]
    np.testing.assert_allclose(dense @ results[0], right, atol=1e-9)
    for other in results[1:]:
        np.testing.assert_array_equal(other, results[0])
    # Two columns take two right-hand sides; the package's own matrices are accepted as well.
    pair = ridgeform.denoise(
        sphere, sphere.vertices[:, :2], fidelity=50.0, linear_constraints=(dense, np.array([right, right]).T)
    )
    np.testing.assert_allclose(dense @ pair.values, np.array([right, right]).T, atol=1e-9)


def test_contradictory_constraints_have_no_answer(sphere):
    row = np.ones((1, sphere.n_vertices))
    for matrix, right in [(np.concatenate([row, row]), [0.0, 1.0]), (0 * row, [1.0])]:
        for solver in ("fast", "clarabel"):
            with pytest.raises(ridgeform.SolveError, match=r"\w+ \w+"):
                ridgeform.denoise(
                    sphere,
                    sphere.vertices[:, 0],
                    fidelity=1.0,
                    linear_constraints=(matrix, right),
                    solver=solver,
                )


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"fidelity": -1.0}, "fidelity: "),
        ({"fidelity": np.nan}, "fidelity: "),
        ({"energy": "h2"}, 'energy: "h2" is not known here; use "l1_hessian"'),
        ({"dual": "voronoi"}, 'dual: "voronoi" .*use "barycentric" or "circumcentric"'),
        ({"coupling": "none"}, 'coupling: .*use "joint" or "separate"'),
        ({"solver": "mosek"}, 'solver: "mosek" .*use "auto" or "fast" or "clarabel"'),
        ({"tolerance": 0.0}, "tolerance: "),
        ({"tolerance": np.nan}, "tolerance: "),
        ({"max_iterations": 0}, "max_iterations: got 0; .*at least 1"),
        ({"threads": -2}, "threads: got -2; .*at least 1"),
        ({"memory_limit": 0}, "memory_limit: got 0; .*at least 1"),
        ({"sharpness": -0.1}, "sharpness: "),
        ({"sharpness": 1.1}, "sharpness: "),
        (
            {"face_weights": np.ones(3)},
            r"face_weights: expected one entry for each face, shape \(320,\), got shape \(3,\)",
        ),
        ({"face_weights": np.full(320, -1.0)}, "face_weights: "),
        ({"face_weights": np.full(320, np.inf)}, "face_weights: row 0 holds inf"),
        ({"linear_constraints": (np.ones((1, 5)), [1.0])}, "linear_constraints: expected 162 columns"),
        (
            {"linear_constraints": (np.ones(162), [1.0])},
            "linear_constraints: expected a matrix with two axes",
        ),
        (
            {"linear_constraints": (np.ones((1, 162)), [1.0, 2.0])},
            "linear_constraints: expected one row for each row of A",
        ),
        ({"linear_constraints": (np.ones((1, 162)), np.ones((1, 2)))}, "linear_constraints: b has 2 columns"),
    ],
)
def test_wrong_arguments_are_refused_in_a_sentence(sphere, keywords, message):
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.denoise(sphere, sphere.vertices[:, 0], **{"fidelity": 1.0, **keywords})


def test_meshes_without_positions_are_enough(sphere):
    intrinsic = ridgeform.Mesh.from_edge_lengths(sphere.faces, sphere.edge_lengths)
    values = sphere.vertices[:, 0]
    np.testing.assert_array_equal(
        ridgeform.denoise(intrinsic, values, fidelity=50.0).values,
        ridgeform.denoise(sphere, values, fidelity=50.0).values,
    )


def test_columns_that_were_not_begun_at_a_wish_to_finish_stay_as_they_came(sphere):
    progress = ridgeform.Progress()
    progress.finish()
    found = ridgeform.denoise(
        sphere, sphere.vertices, fidelity=50.0, coupling="separate", progress=progress, tolerance=1e-6
    )
    assert found.status == "stopped"
    assert found.gap >= 0 and np.isfinite(found.objective)
    assert np.abs(found.values[:, 0] - sphere.vertices[:, 0]).max() > 0
    np.testing.assert_array_equal(found.values[:, 1:], sphere.vertices[:, 1:])
