"""`trace_curves`: lines near a surface as paths along its edges."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def sphere():
    vertices, faces = shapes.icosphere(4)
    return ridgeform.Mesh(vertices, faces), vertices, faces


def edge_set(faces):
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return set(map(tuple, edges.tolist()))


def test_a_circle_over_a_sphere_runs_along_edges_near_it():
    mesh, vertices, faces = sphere()
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    circle = 1.1 * np.column_stack([np.cos(angles), np.sin(angles), 0.2 + 0 * angles])
    found, starts, places = ridgeform.trace_curves(mesh, circle, closed=[True])
    assert starts.tolist() == [0, len(found)]
    edges = edge_set(faces)
    pairs = np.sort(np.column_stack([found, np.roll(found, -1)]), axis=1)
    assert all(tuple(pair) in edges for pair in pairs.tolist())
    edge = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean()
    height = np.sin(np.arctan(0.2))
    assert np.abs(vertices[found][:, 2] - height).max() < 1.5 * edge
    assert (np.diff(places) > 0).all()
    assert 0 <= places[0] < places[-1] < 12
    length = np.linalg.norm(vertices[found] - vertices[np.roll(found, -1)], axis=1).sum()
    assert length < 1.35 * 2 * np.pi


def test_lines_are_traced_one_by_one_and_points_alone_are_vertices():
    mesh, vertices, _ = sphere()
    points = vertices[[3, 100, 7, 7, 50]]
    found, starts, places = ridgeform.trace_curves(mesh, points, starts=[0, 2, 3, 5])
    assert (found[0], found[starts[1] - 1]) == (3, 100)
    assert found[starts[1] : starts[2]].tolist() == [7]
    assert (found[starts[2]], found[-1]) == (7, 50)
    assert places[starts[:-1]].tolist() == [0.0, 0.0, 0.0]
    nothing = ridgeform.trace_curves(mesh, np.zeros((0, 3)), starts=[0])
    assert [array.tolist() for array in nothing] == [[], [0], []]


@pytest.mark.parametrize(
    ("keywords", "name"),
    [
        ({"starts": [0, 3, 2]}, "starts"),
        ({"starts": [1, 2]}, "starts"),
        ({"closed": [True, False]}, "closed"),
        ({"points": [[0.0, 1.0]]}, "points"),
        ({"points": [[0.0, 1.0, np.nan], [0.0, 0.0, 0.0]]}, "points"),
    ],
)
def test_bad_arguments_are_refused_by_name(keywords, name):
    mesh, vertices, _ = sphere()
    with pytest.raises(ridgeform.ArgumentError, match=name):
        ridgeform.trace_curves(mesh, **({"points": vertices[:2]} | keywords))


def test_smooth_curves_are_shorter_and_stay_at_their_vertices():
    vertices, faces = shapes.icosphere(4)
    mesh = ridgeform.Mesh(vertices, faces)
    colors = np.where(vertices @ [[0.6], [0.5], [0.4]] > 0.2, 1.0, 0.0)
    found = ridgeform.diffusion_curves(mesh, colors)
    places = ridgeform.smooth_curves(mesh, found.edges)
    assert places.shape == (len(found.edges), 2, 3)
    length = [
        np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() for ends in (places, vertices[found.edges])
    ]
    assert length[0] < 0.9 * length[1]
    assert np.abs(places - vertices[found.edges]).max() < 0.06
    with pytest.raises(ridgeform.ArgumentError, match="edges"):
        ridgeform.smooth_curves(mesh, [[0, len(vertices)]])
