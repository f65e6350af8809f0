"""The generated shapes are what their names promise: topology, orientation, size."""

import numpy as np
import pytest
from known_shapes import shapes

CLOSED = {  # name: (Euler characteristic, area, volume), None where the shape approximates a curved one
    "cube": (2, 24.0, 8.0),
    "l_shape": (2, 14.0, 3.0),
    "staircase": (2, 24.0, 6.0),
    "house": (2, 21 + 6 * np.sqrt(2) + 2, 12.0),
    "dodecahedron": (2, 10.5146222, 2.7851639),
    "tetrahedron": (2, 8 * np.sqrt(3), 8 / 3),
    "icosphere": (2, None, None),
    "uv_sphere": (2, None, None),
    "cylinder": (2, None, None),
    "torus": (0, None, None),
}
OPEN = {  # name: (Euler characteristic, boundary edges)
    "grid": (1, 32),
    "flat_lattice": (1, 32),
    "open_cone": (1, 8),
    "moebius_strip": (0, 48),
    "bow_tie": (1, 6),
    "three_faces_on_an_edge": (1, 6),
}


def edge_counts(faces):
    """Edges `(k, 2)` and the number of faces on each."""
    halfedges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.unique(np.sort(halfedges, axis=1), axis=0, return_counts=True)


def euler_characteristic(vertices, faces):
    """Vertices minus edges plus faces."""
    return len(vertices) - len(edge_counts(faces)[0]) + len(faces)


def repeated_halfedges(faces):
    """Number of directed edges used by more than one face: 0 when oriented consistently."""
    halfedges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return len(halfedges) - len(np.unique(halfedges, axis=0))


def area_and_volume(vertices, faces):
    """Total area, and the volume enclosed (positive when faces look outwards)."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return area, np.einsum("ij,ij", a, np.cross(b, c)) / 6


@pytest.mark.parametrize("name", CLOSED)
def test_closed_shapes_are_closed_oriented_outwards_and_of_known_size(name):
    vertices, faces = getattr(shapes, name)()
    characteristic, known_area, known_volume = CLOSED[name]
    area, volume = area_and_volume(vertices, faces)
    assert euler_characteristic(vertices, faces) == characteristic
    assert (edge_counts(faces)[1] == 2).all()
    assert repeated_halfedges(faces) == 0
    assert volume > 0
    if known_area is not None:
        assert (area, volume) == pytest.approx((known_area, known_volume), rel=1e-6)


@pytest.mark.parametrize("name", OPEN)
def test_open_shapes_have_their_boundary(name):
    vertices, faces = getattr(shapes, name)()
    counts = edge_counts(faces)[1]
    assert (euler_characteristic(vertices, faces), int((counts == 1).sum())) == OPEN[name]


def test_the_broken_shapes_are_broken_as_promised():
    assert repeated_halfedges(shapes.moebius_strip()[1]) == 1
    assert (edge_counts(shapes.three_faces_on_an_edge()[1])[1] == 3).sum() == 1
    assert (np.bincount(shapes.bow_tie()[1].ravel()) == 2).sum() == 1


def test_sphere_vertices_lie_on_the_unit_sphere():
    for vertices, _ in (shapes.icosphere(), shapes.uv_sphere()):
        assert np.linalg.norm(vertices, axis=1) == pytest.approx(np.ones(len(vertices)))


@pytest.mark.parametrize("seed", range(5))
def test_random_delaunay_covers_the_convex_hull_with_delaunay_edges(seed):
    vertices, faces = shapes.random_delaunay(30, seed)
    edges, counts = edge_counts(faces)
    assert euler_characteristic(vertices, faces) == 1
    a, b, c = (vertices[faces[:, i], :2] for i in range(3))
    signed = np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2]
    assert (signed > 0).all()
    opposite_angles = np.zeros(len(edges))
    index = {tuple(edge): k for k, edge in enumerate(edges.tolist())}
    for face in faces:
        for i in range(3):
            p, q, r = vertices[face[i]], vertices[face[i - 2]], vertices[face[i - 1]]
            cosine = (q - p) @ (r - p) / np.linalg.norm(q - p) / np.linalg.norm(r - p)
            opposite_angles[index[tuple(sorted((face[i - 2], face[i - 1])))]] += np.arccos(cosine)
    assert (opposite_angles[counts == 2] <= np.pi + 1e-9).all()


def test_noisy_cube_has_the_noise_that_the_benchmark_states():
    distances = [shapes.distance_to_cube(shapes.noisy_cube(seed)[0]) for seed in range(6)]
    assert shapes.root_mean_square(distances) == pytest.approx(0.0188, abs=5e-5)


def test_distance_to_cube_inside_outside_and_on_it():
    points = np.array([[0, 0, 0], [0.5, 0, 0], [1, 0.2, -0.3], [2, 0, 0], [2, 2, 1], [2, 2, 2]], dtype=float)
    assert shapes.distance_to_cube(points) == pytest.approx([1, 0.5, 0, 1, np.sqrt(2), np.sqrt(3)])


def test_noise_along_normals_moves_only_along_normals():
    vertices, faces = shapes.icosphere(2)
    moved = shapes.add_noise(vertices, faces, 0.1, seed=1, along_normals=True) - vertices
    assert np.cross(moved, shapes.vertex_normals(vertices, faces)) == pytest.approx(0, abs=1e-12)
    assert shapes.root_mean_square(np.linalg.norm(moved, axis=1)) == pytest.approx(
        0.1 * shapes.mean_edge_length(vertices, faces), rel=0.15
    )


def test_random_rotation_is_a_rotation():
    rotation = shapes.random_rotation(4)
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1)
