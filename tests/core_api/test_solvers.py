"""Two solvers, one problem: objectives differ by no more than the certificates, and these are true."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes
from reference import block_norms


def noisy(shape, size=0.2, seed=0):
    """A shape with noise on its vertices."""
    vertices, faces = shape
    return shapes.add_noise(vertices, faces, size, seed), faces


def mean_value(mesh):
    """One row: the integral of a function."""
    return ridgeform.voronoi_mass(mesh)[None, :]


def problems():
    """Name → (mesh, function, keywords): what a user would ask, on meshes of a few hundred vertices."""
    rng = np.random.default_rng(7)
    sphere, torus = (
        ridgeform.Mesh(*noisy(shapes.icosphere(3), 0.05)),
        ridgeform.Mesh(*noisy(shapes.torus(24, 16), 0.05)),
    )
    cube = ridgeform.Mesh(*noisy(shapes.cube(6, 2.0)))
    flat = ridgeform.Mesh(*shapes.flat_lattice(16, 16))
    points = rng.choice(sphere.n_vertices, 30, replace=False)
    signal = np.sign(torus.vertices[:, 0]) * torus.vertices[:, 1] + 0.1 * rng.standard_normal(
        torus.n_vertices
    )
    roof = np.abs(flat.vertices[:, 0] - 9) + 0.2 * rng.standard_normal(flat.n_vertices)
    weights = rng.uniform(0.2, 3.0, torus.n_faces)
    edge = cube.edge_lengths.max()
    step = ridgeform.Mesh(cube.vertices / edge, cube.faces)
    heights = sphere.vertices[points, 2]
    return {
        "interpolation": (sphere, "interpolate", {"indices": points, "values": heights}),
        "interpolation of three columns": (
            sphere,
            "interpolate",
            {"indices": points, "values": sphere.vertices[points]},
        ),
        "interpolation, separate": (
            sphere,
            "interpolate",
            {"indices": points, "values": sphere.vertices[points], "coupling": "separate"},
        ),
        "interpolation with a given integral": (
            sphere,
            "interpolate",
            {"indices": points, "values": heights, "linear_constraints": (mean_value(sphere), [1.0])},
        ),
        "denoising": (torus, "denoise", {"values": signal, "fidelity": 300.0}),
        "denoising a roof": (flat, "denoise", {"values": roof, "fidelity": 1.0}),
        "denoising, weighted": (
            torus,
            "denoise",
            {"values": signal, "fidelity": 300.0, "face_weights": weights},
        ),
        "denoising, some values fixed": (
            torus,
            "denoise",
            {"values": signal, "fidelity": 300.0, "fixed": [0, 7, 100]},
        ),
        "denoising with a given integral": (
            torus,
            "denoise",
            {"values": signal, "fidelity": 300.0, "linear_constraints": (mean_value(torus), [0.5])},
        ),
        "flow step, joint": (step, "denoise", {"values": step.vertices, "fidelity": 500.0}),
        "flow step, separate": (
            step,
            "denoise",
            {"values": step.vertices, "fidelity": 500.0, "coupling": "separate"},
        ),
        "flow step, circumcentric": (
            step,
            "denoise",
            {"values": step.vertices, "fidelity": 500.0, "dual": "circumcentric"},
        ),
    }


PROBLEMS = problems()


def objective(mesh, function, keywords, values):
    """The objective of (21), from the public operators alone."""
    rows = ridgeform.hessian(mesh, dual=keywords.get("dual", "barycentric")).to_scipy().toarray()
    norms = block_norms(rows, values, joint=keywords.get("coupling") != "separate")
    weights = keywords.get("face_weights", np.ones(mesh.n_faces))
    total = (weights @ norms).sum()
    if function == "denoise":
        difference = (values - keywords["values"]).reshape(mesh.n_vertices, -1)
        total += keywords["fidelity"] * (ridgeform.voronoi_mass(mesh) @ difference**2).sum()
    return total


def solve(name, **more):
    """The solution of a named problem."""
    mesh, function, keywords = PROBLEMS[name]
    return getattr(ridgeform, function)(mesh, **keywords, **more)


@pytest.mark.parametrize("name", PROBLEMS)
def test_solvers_agree_within_their_certificates(name):
    mesh, function, keywords = PROBLEMS[name]
    fast, clarabel = (
        solve(name, solver="fast", tolerance=1e-4),
        solve(name, solver="clarabel", tolerance=1e-7),
    )
    for solution, solver, tolerance in ((fast, "fast", 1e-4), (clarabel, "clarabel-qdldl", 1e-7)):
        assert solution.status == "solved"
        assert solution.solver == solver
        assert -1e-12 <= solution.gap <= tolerance
        assert solution.iterations > 0
        # The objective is that of the values returned.
        expected = objective(mesh, function, keywords, solution.values)
        assert solution.objective == pytest.approx(expected, rel=1e-9)
    # No point lies below the other's certified bound.
    for one, other in ((fast, clarabel), (clarabel, fast)):
        assert one.objective * (1 - one.gap) <= other.objective * (1 + 1e-12)


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("solver", ["fast", "clarabel"])
def test_constraints_hold(name, solver):
    _, function, keywords = PROBLEMS[name]
    values = solve(name, solver=solver).values
    wanted = keywords["values"]
    if function == "interpolate":
        np.testing.assert_array_equal(values[keywords["indices"]], wanted)
    if "fixed" in keywords:
        np.testing.assert_array_equal(values[keywords["fixed"]], wanted[keywords["fixed"]])
    if "linear_constraints" in keywords:
        matrix, right = keywords["linear_constraints"]
        np.testing.assert_allclose(matrix @ values, right, atol=1e-9)


def test_both_factorizations_of_clarabel_solve_the_same():
    qdldl, faer = (
        solve("denoising", solver=f"clarabel-{kind}", tolerance=1e-7) for kind in ("qdldl", "faer")
    )
    assert (qdldl.solver, faer.solver) == ("clarabel-qdldl", "clarabel-faer")
    assert qdldl.objective == pytest.approx(faer.objective, rel=1e-6)


@pytest.mark.parametrize("solver", ["fast", "clarabel"])
def test_too_few_iterations_are_told_with_the_true_gap(solver):
    best = solve("denoising", solver="clarabel", tolerance=1e-7).objective
    poor = solve("denoising", solver=solver, tolerance=1e-9, max_iterations=2)
    assert poor.status == "inaccurate"
    assert poor.gap > 1e-9
    assert poor.objective >= best * (1 - 1e-6)
    assert poor.objective * (1 - poor.gap) <= best * (1 + 1e-9)


def test_without_a_tolerance_the_gap_is_still_computed():
    best = solve("denoising", solver="clarabel", tolerance=1e-7).objective
    quick = solve("denoising", tolerance=None)
    assert quick.status == "solved"
    assert quick.objective * (1 - quick.gap) <= best * (1 + 1e-9)
    assert quick.objective == pytest.approx(best, rel=1e-3)


@pytest.mark.parametrize("name", ["interpolation", "denoising", "flow step, joint"])
def test_threads_and_repetition_change_no_bit(name):
    first = solve(name, threads=1)
    for threads in (1, 2, None):
        np.testing.assert_array_equal(solve(name, threads=threads).values, first.values)


@pytest.mark.parametrize(
    "call",
    [
        lambda mesh, **limit: ridgeform.denoise(mesh, mesh.vertices, fidelity=10.0, **limit),
        lambda mesh, **limit: ridgeform.denoise(
            mesh, mesh.vertices, fidelity=10.0, energy="l2_hessian", **limit
        ),
        lambda mesh, **limit: ridgeform.interpolate(mesh, [0, 5], [0.0, 1.0], **limit),
        lambda mesh, **limit: ridgeform.stylize(mesh, iterations=1, **limit),
        lambda mesh, **limit: ridgeform.vibration_modes(mesh, 2, energy="l2_laplacian", **limit),
    ],
    ids=["denoise", "denoise, L2", "interpolate", "stylize", "modes"],
)
def test_a_factor_beyond_the_memory_limit_is_refused_with_its_size(call):
    vertices, faces = shapes.icosphere(3)
    mesh = ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.1), faces)
    with pytest.raises(
        ridgeform.SolveError, match=r"needs about \d+\.\d\d MB.*limit of 0\.00 MB.*memory_limit"
    ):
        call(mesh, memory_limit=1000)
    call(mesh, memory_limit=50_000_000)
