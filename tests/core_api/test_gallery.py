"""What the gallery is made of: meshes, distances, the search for a fidelity; its claims on a small case."""

from types import SimpleNamespace

import numpy as np
import pytest
import ridgeform
from gallery import distances, domains, heights, measures
from known_shapes import shapes

SIDE = 18


@pytest.mark.parametrize(
    "shape",
    [
        domains.irregular_square(14),
        domains.stretched_square(14, 8.0),
        domains.catenoid(24, height=1.2),
    ],
    ids=["square", "slivers", "catenoid"],
)
def test_meshes_are_sound(shape):
    report = ridgeform.Mesh(*shape).report
    assert report.n_components == 1
    for flaws in ("nonmanifold_edges", "inconsistent_edges", "degenerate_faces", "unreferenced_vertices"):
        assert len(getattr(report, flaws)) == 0


def test_the_square_is_covered_and_the_stretched_one_is_made_of_the_same_points():
    for vertices, faces in (domains.irregular_square(14), domains.stretched_square(14, 8.0)):
        assert ridgeform.voronoi_mass(ridgeform.Mesh(vertices, faces)).sum() == pytest.approx(1.0)
    flipped = ridgeform.intrinsic_delaunay(ridgeform.Mesh(*domains.stretched_square(14, 8.0))).faces
    expected = domains.irregular_square(14)[1]
    assert {frozenset(face) for face in flipped.tolist()} == {frozenset(face) for face in expected.tolist()}


def test_distances_are_exact_on_the_plane_and_close_on_the_sphere():
    vertices, faces = domains.irregular_square(20)
    (source,) = distances.nearest(vertices, [(0.1, 0.2, 0.0)])
    reached = distances.surface_distance(vertices, faces, [source])
    assert np.abs(reached - np.linalg.norm(vertices - vertices[source], axis=1)).max() < 1e-3
    vertices, faces = shapes.icosphere(4)
    angle = np.arccos(np.clip(vertices @ vertices[0], -1, 1))
    near = angle < 2.5  # beyond, fronts meet
    assert np.abs(distances.surface_distance(vertices, faces, [0]) - angle)[near].max() < 0.02


@pytest.mark.parametrize("best", [3.3125, 7.8, -0.6])
def test_the_search_finds_the_best_fidelity_also_beyond_its_range(best):
    found = measures.best_fit(
        lambda fidelity: SimpleNamespace(values=np.array([np.log10(fidelity)])),
        lambda values: float(abs(values[0] - best)),
        "l1_hessian",
    )
    assert np.log10(found.fidelity) == pytest.approx(best, abs=0.5 * min(measures.STEPS))


def test_ours_restores_ridges_better_than_l2_and_gives_the_same_bits_again():
    problem = heights.Problem.make("ramp", SIDE)
    ours, smooth = (problem.best(energy) for energy in ("l1_hessian", "l2_hessian"))
    assert ours.error < 0.9 * smooth.error
    sharp, soft = (measures.bending_in_tenth(problem.mesh, fit.solution.values) for fit in (ours, smooth))
    assert sharp > 1.5 * soft
    again = heights.Problem.make("ramp", SIDE).best("l1_hessian")
    assert again.fidelity == ours.fidelity
    assert (again.solution.values == ours.solution.values).all()


def test_a_function_folded_once_bends_in_a_tenth_of_the_area():
    vertices, faces = domains.irregular_square(30)
    mesh = ridgeform.Mesh(vertices, faces)
    assert measures.bending_in_tenth(mesh, np.abs(vertices[:, 0] + 0.3 * vertices[:, 1])) > 0.8
    assert measures.bending_in_tenth(mesh, (vertices**2).sum(axis=1)) < 0.3
