"""The shapes with holes are what they promise, and the measures on them give known answers."""

import numpy as np
import pytest
from known_shapes import fill_measures, holed_shapes, shapes

CENTERS = {
    "cube": (1, 0.1, 1),
    "step": (1, 0.5, 1),
    "roof": (0, 0.1, 1.5),
    "cylinder": (0.6, 0.8, 1),
    "sphere": (0.6, 0.8, 0),
}


def solid(name, is_irregular):
    made = getattr(holed_shapes, name)(10)
    return holed_shapes.irregular(made, 3) if is_irregular else made


@pytest.mark.parametrize("is_irregular", [False, True])
@pytest.mark.parametrize("name", CENTERS)
def test_a_holed_shape_is_one_piece_with_one_loop_on_the_true_surface(name, is_irregular):
    one = solid(name, is_irregular)
    holed = holed_shapes.cut(one, [(np.array(CENTERS[name], float), 0.45)], seed=7)
    again = holed_shapes.cut(one, [(np.array(CENTERS[name], float), 0.45)], seed=7)
    assert np.array_equal(holed.vertices, again.vertices)
    border = fill_measures.boundary_edges(holed.faces)
    follower = dict(border.tolist())
    assert len(follower) == len(border)
    start = border[0, 0]
    length, vertex = 1, follower[start]
    while vertex != start:
        length, vertex = length + 1, follower[vertex]
    assert length == len(border)
    assert fill_measures.nonmanifold_edges(holed.faces) == 0
    assert len(fill_measures.nonmanifold_vertices(holed.faces)) == 0
    assert holed.distance(holed.vertices).max() < 1e-12
    assert fill_measures.qualities(*holed.before).min() > 0.1
    assert len(fill_measures.boundary_edges(holed.before[1])) == 0
    assert (len(holed.ridge) > 0) == (name != "sphere")
    # What is missing is what lies near the place where it was cut.
    assert len(holed.before[1]) > len(holed.faces)


def test_irregular_meshes_are_another_triangulation_of_the_same_surface():
    regular, other = solid("cube", False), solid("cube", True)
    assert other.distance(other.vertices).max() < 1e-12
    before = {tuple(sorted(face)) for face in regular.faces.tolist()}
    changed = [tuple(sorted(face)) not in before for face in other.faces.tolist()]
    assert 0.3 < np.mean(changed) < 0.9
    area = [
        np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1).sum()
        for v, f in ((regular.vertices, regular.faces), (other.vertices, other.faces))
    ]
    assert area[0] == pytest.approx(area[1])


def test_the_ridge_in_a_hole_across_an_edge_is_as_long_as_the_hole():
    holed = holed_shapes.cut(solid("cube", False), [(np.array([1.0, 0.1, 1.0]), 0.45)])
    along = np.ptp(holed.ridge[:, 1])
    assert np.allclose(holed.ridge[:, [0, 2]], 1)
    assert 0.6 < along < 1.2
    kept = fill_measures.point_distances(holed.ridge, holed.vertices, holed.faces)
    assert kept.min() > 0


def test_flat_patch_across_an_edge_is_as_far_as_geometry_says():
    # Over a hole with the corners (0, ±1, 0), (±d, 0, -d) on two planes that meet in the y axis, the flat
    # filling of two triangles with the ridge as diagonal is exact, with the other diagonal it is not.
    d = 0.5
    corners = np.array([[0, 1, 0], [d, 0, -d], [0, -1, 0], [-d, 0, -d]], float)
    ridge = np.stack([np.zeros(201), np.linspace(-1, 1, 201), np.zeros(201)], axis=1)
    along = fill_measures.point_distances(ridge, corners, np.array([[0, 2, 1], [0, 3, 2]]))
    assert along.max() < 1e-15
    across = fill_measures.point_distances(ridge, corners, np.array([[0, 3, 1], [1, 3, 2]]))
    # The patch is the roof of planes through (0, ±1, 0) and the line z = -d, y = 0: slope d.
    expected = (1 - np.abs(ridge[:, 1])) * d / np.hypot(1, d)
    assert np.allclose(across, expected)


def test_distances_are_those_to_the_nearest_triangle():
    vertices, faces = shapes.icosphere(2)
    points = np.random.default_rng(0).normal(size=(60, 3)) * 1.5
    found = fill_measures.point_distances(points, vertices, faces)
    dense = fill_measures.samples(*shapes.subdivide(vertices, faces, 2))[0]
    sampled = np.sqrt(((points[:, None] - dense) ** 2).sum(axis=2).min(axis=1))
    assert (found <= sampled + 1e-12).all()
    assert np.allclose(found, sampled, atol=0.01)
    assert np.isinf(fill_measures.point_distances(points, vertices, faces[:0])).all()


def test_new_faces_are_found_whatever_their_order_and_small_errors():
    holed = holed_shapes.cut(solid("cube", True), [(np.array([1.0, 0.1, 1.0]), 0.45)], seed=2)
    vertices, faces = holed.before
    order = np.random.default_rng(1).permutation(len(faces))
    made = fill_measures.new_faces(
        (holed.vertices, holed.faces), (vertices.astype(np.float32).astype(float), faces[order]), 1e-5
    )
    assert made.sum() == len(faces) - len(holed.faces)


def test_unsound_meshes_are_recognized():
    for name, edges, vertices in (
        ("bow_tie", 0, [0]),
        ("three_faces_on_an_edge", 1, []),
        ("open_cone", 0, []),
    ):
        faces = getattr(shapes, name)()[1]
        assert fill_measures.nonmanifold_edges(faces) == edges
        assert fill_measures.nonmanifold_vertices(faces).tolist() == vertices
    sliver = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0.5, np.sqrt(0.75), 0]])
    assert np.allclose(fill_measures.qualities(sliver, np.array([[0, 1, 2], [0, 1, 3]])), [0, 1])
