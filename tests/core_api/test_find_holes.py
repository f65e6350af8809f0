"""Which boundary loops are holes."""

import numpy as np
import pytest
import ridgeform


def grid(n, without=()):
    """A flat grid of n by n squares, each two triangles, but for some squares."""
    vertices = np.array([(x, y, 0.0) for x in range(n + 1) for y in range(n + 1)])
    squares = [(x, y) for x in range(n) for y in range(n) if (x, y) not in without]
    corners = [(x * (n + 1) + y, (x + 1) * (n + 1) + y) for x, y in squares]
    return vertices, np.array([face for a, b in corners for face in ((a, b, b + 1), (a, b + 1, a + 1))])


def test_a_sheet_has_an_outer_border_and_holes():
    mesh = ridgeform.Mesh(*grid(6, without={(1, 1), (3, 3), (3, 4)}))
    holes = ridgeform.find_holes(mesh)
    loops = ridgeform.boundary_loops(mesh)
    assert [list(hole.vertices) for hole in holes] == [list(loop) for loop in loops]
    assert sorted(len(hole.vertices) for hole in holes if not hole.is_outer_border) == [4, 6]
    assert [len(hole.vertices) for hole in holes if hole.is_outer_border] == [24]
    assert all(hole.refusal is None for hole in holes)


def test_a_box_without_lid_has_one_hole():
    vertices = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    (hole,) = ridgeform.find_holes(ridgeform.Mesh(vertices, np.array(faces)))
    assert sorted(hole.vertices) == [4, 5, 6, 7]
    assert not hole.is_outer_border


def test_what_cannot_be_filled_says_why():
    (hole,) = ridgeform.find_holes(ridgeform.Mesh(np.eye(3), [[0, 1, 2]]))
    assert "single triangle" in hole.refusal
    assert "not fillable" in repr(hole)


def test_lengths_alone_are_refused():
    mesh = ridgeform.Mesh.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]])
    with pytest.raises(ridgeform.MeshError):
        ridgeform.find_holes(mesh)


def test_there_is_no_surface_before_a_call_made_one():
    assert ridgeform.Progress().snapshot_surface() is None
