"""Split seams are computed as one surface, and only they."""

import numpy as np
from bl_ext.user_default.ridgeform.blender.welding import weld_seams

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)


def test_a_mesh_without_seams_stays_as_it_is():
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    weld = weld_seams(SQUARE, triangles)
    assert np.array_equal(weld.first, [0, 1, 2, 3])
    assert np.array_equal(weld.vertex, [0, 1, 2, 3])
    assert np.array_equal(weld.triangles, triangles)
    assert weld.rows.tolist() == list(range(len(weld.triangles)))


def test_the_sides_of_a_seam_become_one():
    points = np.concatenate([SQUARE, SQUARE[[0, 2]]])
    points[4, 2] = -0.0
    weld = weld_seams(points, np.array([[0, 1, 2], [4, 5, 3]]))
    assert np.array_equal(weld.vertex, [0, 1, 2, 3, 0, 2])
    assert np.array_equal(weld.triangles, [[0, 1, 2], [0, 2, 3]])
    assert np.array_equal(
        weld.all_of(np.array([True, True, False, True, True, True])), [True, True, False, True]
    )
    assert np.allclose(weld.mean_of(np.array([1.0, 2, 3, 4, 0, 5])), [0.5, 2, 4, 4])


def test_closed_surfaces_that_touch_stay_apart():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    both = weld_seams(np.concatenate([corners, -corners]), np.concatenate([faces, faces[:, ::-1] + 4]))
    assert len(both.first) == 8
    twice = weld_seams(np.concatenate([corners, corners]), np.concatenate([faces, faces + 4]))
    assert len(twice.first) == 8


def test_a_triangle_that_closes_up_is_left_out():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]], np.float32)
    weld = weld_seams(points, np.array([[0, 1, 2], [0, 3, 1]]))
    assert weld.rows.tolist() == [0]
    assert np.array_equal(weld.triangles, [[0, 1, 2]])


def test_no_triangles():
    weld = weld_seams(SQUARE, np.empty((0, 3), np.int32))
    assert np.array_equal(weld.vertex, [0, 1, 2, 3])
    assert weld.triangles.shape == (0, 3)
