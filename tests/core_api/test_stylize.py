"""`stylize`: what the flow promises, what each keyword does, and what is refused."""

import inspect

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


@pytest.fixture(scope="module")
def bump():
    """A noisy sphere: nothing about it is symmetric."""
    vertices, faces = shapes.icosphere(3)
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.05), faces)


def test_noisy_cubes_are_restored():
    before, after = [], []
    for seed in range(4):
        vertices, faces = shapes.noisy_cube(seed)
        result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=12)
        assert result.status == "finished"
        before.append(shapes.root_mean_square(shapes.distance_to_cube(vertices)))
        after.append(shapes.root_mean_square(shapes.distance_to_cube(result.vertices)))
    # Peers leave 0.0087 to 0.0118 of the same noise.
    assert np.mean(before) == pytest.approx(0.0188, abs=5e-4)
    assert np.mean(after) <= 0.0038
    assert np.max(after) <= 0.0042


def test_a_clean_cube_stays_a_cube():
    vertices, faces = shapes.cube(8, 2.0)
    result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=10)
    assert shapes.distance_to_cube(result.vertices).max() < 0.03


def test_the_result_is_complete_and_consistent(bump):
    result = ridgeform.stylize(bump, iterations=5)
    assert result.vertices.shape == (bump.n_vertices, 3)
    assert np.isfinite(result.vertices).all()
    assert (result.status, result.iterations) == ("finished", 5)
    assert result.energy.shape == (6,)
    assert result.gap.shape == result.solver_iterations.shape == (5,)
    assert (result.gap >= 0).all()
    assert (result.solver_iterations > 0).all()
    assert result.energy[-1] < 0.9 * result.energy[0]
    assert repr(result) == "<ridgeform.Stylized: finished after 5 steps>"


@pytest.mark.parametrize("sharpness", [0.0, 0.5, 1.0])
def test_joint_flows_turn_with_the_mesh(bump, sharpness):
    rotation = shapes.random_rotation(1)
    plain = ridgeform.stylize(bump, iterations=8, sharpness=sharpness)
    turned = ridgeform.stylize(
        ridgeform.Mesh(bump.vertices @ rotation.T, bump.faces), iterations=8, sharpness=sharpness
    )
    np.testing.assert_allclose(turned.vertices, plain.vertices @ rotation.T, atol=1e-9)


def test_separate_flows_do_not(bump):
    rotation = shapes.random_rotation(1)
    plain = ridgeform.stylize(bump, coupling="separate")
    turned = ridgeform.stylize(ridgeform.Mesh(bump.vertices @ rotation.T, bump.faces), coupling="separate")
    assert np.abs(turned.vertices - plain.vertices @ rotation.T).max() > 1e-4


@pytest.mark.parametrize("scale", ["max_edge", "bounding_box"])
@pytest.mark.parametrize("factor", [1e-4, 1e4])
def test_flows_scale_and_move_with_the_mesh(bump, scale, factor):
    shift = np.array([3, -2, 1])
    plain = ridgeform.stylize(bump, iterations=4, scale=scale)
    moved = ridgeform.Mesh(factor * (bump.vertices + shift), bump.faces)
    result = ridgeform.stylize(moved, iterations=4, scale=scale)
    np.testing.assert_allclose(result.vertices / factor - shift, plain.vertices, atol=1e-8)


def test_fidelity_is_in_the_unit_of_the_scale(bump):
    edge = bump.edge_lengths.max()
    side = np.ptp(bump.vertices, axis=0).max()
    # Energy scales with length, fidelity with length to the fourth.
    by_edge = ridgeform.stylize(bump, iterations=3, fidelity=500.0)
    by_box = ridgeform.stylize(bump, iterations=1, fidelity=500.0 * (side / edge) ** 3, scale="bounding_box")
    by_edge = ridgeform.stylize(bump, iterations=1, fidelity=500.0)
    np.testing.assert_allclose(by_box.vertices, by_edge.vertices, atol=1e-6)


def test_more_fidelity_changes_less(bump):
    moves = [
        np.abs(ridgeform.stylize(bump, iterations=3, fidelity=f).vertices - bump.vertices).max()
        for f in (5, 500, 5e4)
    ]
    assert moves == sorted(moves, reverse=True)


def test_fixed_vertices_keep_every_bit(bump):
    mask = bump.vertices[:, 0] > 0.5
    for fixed in (mask, np.flatnonzero(mask)):
        result = ridgeform.stylize(bump, iterations=4, fixed=fixed)
        np.testing.assert_array_equal(result.vertices[mask], bump.vertices[mask])
        assert np.abs(result.vertices[~mask] - bump.vertices[~mask]).max() > 1e-3
    everything = ridgeform.stylize(bump, iterations=4, fixed=np.ones(bump.n_vertices, bool))
    np.testing.assert_array_equal(everything.vertices, bump.vertices)


def test_strength_blends_from_nothing_to_the_full_effect(bump):
    n = bump.n_vertices
    none = ridgeform.stylize(bump, iterations=4, strength=np.zeros(n))
    np.testing.assert_array_equal(none.vertices, bump.vertices)
    full = ridgeform.stylize(bump, iterations=4, strength=np.ones(n))
    np.testing.assert_allclose(full.vertices, ridgeform.stylize(bump, iterations=4).vertices, atol=1e-12)
    half = ridgeform.stylize(bump, iterations=4, strength=(bump.vertices[:, 2] > 0).astype(float))
    np.testing.assert_array_equal(
        half.vertices[bump.vertices[:, 2] <= 0], bump.vertices[bump.vertices[:, 2] <= 0]
    )


def test_ridges_go_where_they_are_cheap(bump):
    upper = bump.vertices[bump.faces].mean(axis=1)[:, 2] > 0
    neutral = ridgeform.stylize(bump, iterations=6)
    ones = ridgeform.stylize(bump, iterations=6, ridge_weights=np.ones(bump.n_faces))
    np.testing.assert_allclose(ones.vertices, neutral.vertices, atol=1e-12)
    cheap_above = ridgeform.stylize(bump, iterations=6, ridge_weights=np.where(upper, 0.1, 1.0))

    def curvature_above(result):
        mesh = ridgeform.Mesh(result.vertices, bump.faces)
        rows = ridgeform.hessian_norm(ridgeform.Mesh(bump.vertices, bump.faces), mesh.vertices)
        return rows[upper].sum() / rows.sum()

    assert curvature_above(cheap_above) > curvature_above(neutral) + 0.03


@pytest.mark.parametrize("coupling", ["joint", "separate"])
def test_solvers_take_the_same_steps(coupling):
    vertices, faces = shapes.cube(5, 2.0)
    mesh = ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.15), faces)
    fast, clarabel = (
        ridgeform.stylize(mesh, iterations=2, coupling=coupling, solver=solver, tolerance=1e-5)
        for solver in ("fast", "clarabel")
    )
    assert max(fast.gap.max(), clarabel.gap.max()) <= 1e-5
    np.testing.assert_allclose(fast.energy, clarabel.energy, rtol=5e-3)
    edge = mesh.edge_lengths.max()
    assert shapes.root_mean_square(fast.vertices - clarabel.vertices) < 0.01 * edge


def test_a_tolerance_is_certified_in_every_step(bump):
    loose = ridgeform.stylize(bump, iterations=4, tolerance=1e-2)
    tight = ridgeform.stylize(bump, iterations=4, tolerance=1e-5)
    assert (loose.gap <= 1e-2).all()
    assert (tight.gap <= 1e-5).all()
    assert tight.solver_iterations.sum() > loose.solver_iterations.sum()


def test_threads_and_repetition_change_no_bit(bump):
    first = ridgeform.stylize(bump, iterations=4, threads=1)
    for threads in (1, 2, None):
        again = ridgeform.stylize(bump, iterations=4, threads=threads)
        np.testing.assert_array_equal(again.vertices, first.vertices)
        np.testing.assert_array_equal(again.energy, first.energy)


def test_no_steps_change_nothing(bump):
    result = ridgeform.stylize(bump, iterations=0)
    np.testing.assert_array_equal(result.vertices, bump.vertices)
    assert result.energy.shape == (1,)
    assert result.gap.shape == (0,)


def test_strong_flows_stay_finite_and_say_how_they_ended():
    for vertices, faces in (
        shapes.icosphere(2),
        shapes.torus(16, 10),
        shapes.open_cone(),
        shapes.moebius_strip(),
    ):
        result = ridgeform.stylize(
            ridgeform.Mesh(vertices, faces), iterations=200, fidelity=1e-3, scale="bounding_box"
        )
        assert np.isfinite(result.vertices).all()
        assert result.status in ("finished", "converged", "collapsed")
        assert np.isfinite(result.energy).all()


@pytest.mark.parametrize("shape", ["bow_tie", "three_faces_on_an_edge", "moebius_strip", "open_cone"])
def test_meshes_that_are_no_manifolds_work(shape):
    vertices, faces = getattr(shapes, shape)()
    result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=5)
    assert np.isfinite(result.vertices).all()


def test_loose_and_degenerate_parts_do_no_harm(bump):
    n = bump.n_vertices
    vertices = np.concatenate([bump.vertices, [[3, 3, 3], [0, 0, 0]]])
    faces = np.concatenate([bump.faces, [[0, 0, 1], [0, 1, n + 1], [2, 2, 2]], bump.faces[:1]])
    result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=5)
    assert np.isfinite(result.vertices).all()
    np.testing.assert_array_equal(result.vertices[n], [3, 3, 3])


def test_defaults_are_those_of_the_manual():
    defaults = {p.name: p.default for p in inspect.signature(ridgeform.stylize).parameters.values()}
    assert defaults == {
        "mesh": inspect.Parameter.empty,
        "iterations": 20,
        "fidelity": 500.0,
        "movement": None,
        "flat_share": None,
        "sharpness": 0.5,
        "coupling": "joint",
        "scale": "max_edge",
        "fixed": None,
        "strength": None,
        "ridge_weights": None,
        "delaunay": False,
        "dual": "barycentric",
        "coarse_to_fine": None,
        "solver": "auto",
        "tolerance": 1e-3,
        "max_iterations": None,
        "memory_limit": None,
        "threads": None,
        "progress": None,
    }


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"iterations": -1}, "iterations: got -1; .*at least 0"),
        ({"fidelity": 0.0}, "fidelity: "),
        ({"fidelity": np.inf}, "fidelity: "),
        ({"sharpness": 2.0}, "sharpness: "),
        ({"sharpness": np.nan}, "sharpness: "),
        ({"coupling": "x"}, 'coupling: "x" is not known here; use "joint" or "separate"'),
        (
            {"scale": "meters"},
            'scale: "meters" is not known here; use "max_edge" or "bounding_box" or "area"',
        ),
        ({"dual": ""}, "dual: "),
        ({"solver": "scs"}, "solver: "),
        (
            {"strength": [1.0]},
            r"strength: expected one entry for each vertex, shape \(642,\), got shape \(1,\)",
        ),
        ({"strength": np.full(642, 1.5)}, "strength: "),
        ({"strength": np.full(642, np.nan)}, "strength: row 0 holds NaN"),
        (
            {"ridge_weights": np.ones(642)},
            r"ridge_weights: expected one entry for each face, shape \(1280,\)",
        ),
        ({"ridge_weights": np.full(1280, -1.0)}, "ridge_weights: "),
    ],
)
def test_wrong_arguments_are_refused_in_a_sentence(bump, keywords, message):
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.stylize(bump, **keywords)


def test_meshes_without_positions_or_area_are_refused(bump):
    intrinsic = ridgeform.Mesh.from_edge_lengths(bump.faces, bump.edge_lengths)
    with pytest.raises(ridgeform.MeshError, match="edge lengths only"):
        ridgeform.stylize(intrinsic)
    flat = ridgeform.Mesh(np.zeros((3, 3)), [[0, 1, 2]])
    with pytest.raises(ridgeform.MeshError, match="no face with positive area"):
        ridgeform.stylize(flat)


def test_delaunay_flips_keep_the_promises(bump):
    vertices, faces = shapes.noisy_cube()
    flipped = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=12, delaunay=True)
    assert np.isfinite(flipped.vertices).all()
    assert shapes.root_mean_square(shapes.distance_to_cube(flipped.vertices)) < 0.006
    plain = ridgeform.stylize(ridgeform.Mesh(vertices, faces), iterations=12)
    assert np.abs(plain.vertices - flipped.vertices).max() > 1e-6
