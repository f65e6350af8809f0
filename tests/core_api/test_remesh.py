"""`remesh`: even edges on the same surface, what it keeps, and what is refused."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def edge_lengths(result):
    corners = result.vertices[result.faces]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)


def test_a_sphere_gets_even_edges_and_stays_a_sphere():
    vertices, faces = shapes.icosphere(3)
    squeezed = ridgeform.Mesh(vertices * [1.0, 1.0, 3.0], faces)
    result = ridgeform.remesh(squeezed, edge_length=0.15)
    assert (result.status, result.iterations, result.edge_length) == ("finished", 10, 0.15)
    assert result.vertices.dtype == np.float64 and result.faces.dtype == np.int32
    lengths = edge_lengths(result)
    assert abs(lengths.mean() - 0.15) < 0.01
    assert lengths.min() > 0.5 * 0.15 and lengths.max() < 1.6 * 0.15
    radii = np.linalg.norm(result.vertices / [1.0, 1.0, 3.0], axis=1)
    assert abs(radii - 1).max() < 0.02
    report = ridgeform.Mesh(result.vertices, result.faces).report
    assert (report.n_components, report.n_boundary_loops, len(report.nonmanifold_edges)) == (1, 0, 0)


def test_a_cube_keeps_its_edges_and_corners():
    vertices, faces = shapes.cube(2, 2.0)
    result = ridgeform.remesh(ridgeform.Mesh(vertices, faces), edge_length=0.21)
    assert shapes.distance_to_cube(result.vertices).max() < 1e-12
    corners = result.origin >= 0
    assert corners.sum() == 8
    np.testing.assert_array_equal(result.vertices[corners], vertices[result.origin[corners]])
    rounded = ridgeform.remesh(ridgeform.Mesh(vertices, faces), edge_length=0.21, feature_angle=None)
    assert (rounded.origin == -1).all()


def test_fixed_vertices_and_faces_stay_bit_by_bit():
    vertices, faces = shapes.icosphere(2)
    mesh = ridgeform.Mesh(vertices, faces)
    upper = vertices[:, 2] > 0
    for fixed in (upper, np.flatnonzero(upper)):
        result = ridgeform.remesh(mesh, edge_length=0.1, fixed=fixed)
        stayed = result.origin >= 0
        np.testing.assert_array_equal(result.origin[stayed], np.flatnonzero(upper))
        np.testing.assert_array_equal(result.vertices[stayed], vertices[upper])
        number = {old: new for new, old in enumerate(result.origin) if old >= 0}
        kept = {tuple(sorted(number[v] for v in face)) for face in faces if upper[face].all()}
        assert kept <= {tuple(sorted(face)) for face in result.faces.tolist()}
        assert len(result.faces) > len(faces)


def test_no_iterations_change_nothing_and_the_same_input_gives_the_same_bits():
    vertices, faces = shapes.icosphere(2)
    mesh = ridgeform.Mesh(vertices, faces)
    result = ridgeform.remesh(mesh, iterations=0)
    np.testing.assert_array_equal(result.vertices, vertices)
    np.testing.assert_array_equal(result.faces, faces)
    first, second = (ridgeform.remesh(mesh, edge_length=0.2) for _ in range(2))
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.faces, second.faces)
    assert repr(result) == f"<ridgeform.Remeshed: {len(vertices)} vertices, {len(faces)} faces, finished>"


def test_progress_stops_and_cancels(cancelled):
    mesh = ridgeform.Mesh(*shapes.icosphere(2))
    progress = ridgeform.Progress()
    progress.finish()
    result = ridgeform.remesh(mesh, progress=progress)
    assert (result.status, result.iterations) == ("stopped", 0)
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.remesh(mesh, progress=cancelled)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"edge_length": 0.0}, "edge_length"),
        ({"edge_length": float("nan")}, "edge_length"),
        ({"edge_length": 1e-9}, "faces"),
        ({"iterations": -1}, "iterations"),
        ({"iterations": 2**31}, "iterations"),
        ({"feature_angle": 200.0}, "feature_angle"),
        ({"fixed": [99999]}, "fixed"),
    ],
)
def test_wrong_arguments_are_refused(wrong, message):
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.remesh(mesh, **wrong)


def test_meshes_without_a_surface_are_refused():
    with pytest.raises(ridgeform.MeshError, match="positions"):
        ridgeform.remesh(ridgeform.Mesh.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]]))
    with pytest.raises(ridgeform.MeshError, match="area"):
        ridgeform.remesh(ridgeform.Mesh(np.zeros((3, 3)), [[0, 1, 2]]))
