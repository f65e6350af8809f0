"""`interpolate`: known answers and what is refused."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def test_three_points_span_the_plane():
    vertices, faces = shapes.random_delaunay(40)
    mesh = ridgeform.Mesh(vertices, faces)
    affine = np.column_stack([2 * vertices[:, 0] + 1, vertices[:, 1] - vertices[:, 0]])
    given = [int(np.argmin(vertices[:, 0])), int(np.argmax(vertices[:, 0])), int(np.argmax(vertices[:, 1]))]
    for solver in ("fast", "clarabel"):
        solution = ridgeform.interpolate(mesh, given, affine[given], solver=solver)
        np.testing.assert_allclose(solution.values, affine, atol=1e-5)
        assert solution.values.shape == (40, 2)


def test_equal_values_give_a_constant():
    mesh = ridgeform.Mesh(*shapes.torus())
    solution = ridgeform.interpolate(mesh, [0, 100, 200], [3, 3, 3])
    np.testing.assert_allclose(solution.values, 3.0, atol=1e-8)
    assert solution.status == "solved"


def test_a_solution_beats_every_other_interpolant():
    vertices, faces = shapes.icosphere(3)
    mesh = ridgeform.Mesh(vertices, faces)
    rng = np.random.default_rng(2)
    given = rng.choice(len(vertices), 20, replace=False)
    solution = ridgeform.interpolate(mesh, given, vertices[given, 2])
    assert solution.objective == pytest.approx(ridgeform.energy(mesh, solution.values), rel=1e-9)
    assert solution.objective <= ridgeform.energy(mesh, vertices[:, 2])
    for size in (1e-3, 1e-1):
        other = solution.values + size * rng.standard_normal(len(vertices))
        other[given] = vertices[given, 2]
        assert ridgeform.energy(mesh, other) >= solution.objective * (1 - solution.gap)


def test_all_values_given_are_returned():
    mesh = ridgeform.Mesh(*shapes.tetrahedron())
    solution = ridgeform.interpolate(mesh, range(4), [1, 2, 3, 4])
    np.testing.assert_array_equal(solution.values, [1, 2, 3, 4])


@pytest.mark.parametrize(
    ("indices", "values", "message"),
    [
        ([], [], "indices: "),
        ([0, 99], [1, 2], "indices: index 99 is out of range: there are 4 entries"),
        ([0, -1], [1, 2], "indices: index -1 is out of range"),
        ([0, 1], [1], r"values: expected one row for each index, shape \(2,\) or \(2, k\), got shape \(1,\)"),
        ([0, 1], [1, np.nan], "values: row 1 holds NaN"),
        ([0, 0], [1, 2], "indices: "),
        ([[0], [1]], [1, 2], r"indices: expected vertex indices of shape \(k,\)"),
    ],
)
def test_wrong_points_are_refused(indices, values, message):
    mesh = ridgeform.Mesh(*shapes.tetrahedron())
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.interpolate(mesh, indices, values)


def test_unknown_energies_are_refused_by_name():
    mesh = ridgeform.Mesh(*shapes.tetrahedron())
    with pytest.raises(
        ridgeform.ArgumentError, match='energy: "h2" is not known here; use "l1_hessian" or "l2_hessian"'
    ):
        ridgeform.interpolate(mesh, [0], [1], energy="h2")
    with pytest.raises(ridgeform.ArgumentError, match='kind: "h2" is not known here; use "l1_hessian"'):
        ridgeform.energy(mesh, mesh.vertices, kind="h2")


def test_constraints_work_with_interpolation():
    vertices, faces = shapes.flat_lattice(8, 8)
    mesh = ridgeform.Mesh(vertices, faces)
    row = np.zeros((1, mesh.n_vertices))
    row[0, [5, 40]] = 1, 1
    solution = ridgeform.interpolate(mesh, [0, 80], [0.0, 1.0], linear_constraints=(row, [3.0]))
    assert solution.values[5] + solution.values[40] == pytest.approx(3.0, abs=1e-9)
    assert (solution.values[0], solution.values[80]) == (0.0, 1.0)
