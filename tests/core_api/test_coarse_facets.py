"""Facets of large meshes are found on coarser ones, and are as good."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


@pytest.fixture(scope="module")
def blob():
    """A dense round shape, and facets of it as by default."""
    vertices, faces = shapes.torus(200, 100)
    mesh = ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.02), faces)
    return mesh, ridgeform.facet(mesh, facets=80)


def test_facets_of_a_dense_shape_are_as_near_as_those_of_all_its_faces(blob):
    mesh, found = blob
    alone = ridgeform.facet(mesh, facets=80, coarse_to_fine=False)
    assert found.n_facets == alone.n_facets == 80
    assert found.n_crossings == 0
    assert found.rms < 1.3 * alone.rms
    assert found.largest < 1.5 * alone.largest


def test_they_are_closed_flat_and_told_of_the_mesh_itself(blob):
    mesh, found = blob
    report = ridgeform.Mesh(found.vertices, found.faces).report
    assert report.n_boundary_loops == 0
    assert len(report.nonmanifold_edges) == len(report.nonmanifold_vertices) == 0
    normals, offsets = found.planes[found.face_facets, :3], found.planes[found.face_facets, 3]
    heights = np.einsum("fcx,fx->fc", found.vertices[found.faces], normals) - offsets[:, None]
    assert np.abs(heights).max() < 1e-6 * np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    assert found.labels.shape == (mesh.n_faces,)
    assert set(np.unique(found.labels)) <= set(range(found.n_facets))
    # Nearest facets are no farther than their planes say, and origins are no farther than the facets.
    centers = mesh.vertices[mesh.faces].mean(axis=1)
    own = found.planes[found.labels]
    off = np.abs(np.einsum("fx,fx->f", centers, own[:, :3]) - own[:, 3])
    assert off.mean() < 2.0 * found.rms
    away = np.linalg.norm(mesh.vertices[found.origins] - found.vertices, axis=1)
    edge = np.linalg.norm(np.diff(mesh.vertices[mesh.faces], axis=1), axis=2).mean()
    assert away.max() < found.largest + 12 * edge


def test_other_numbers_of_facets_start_from_the_same_coarser_mesh(blob):
    mesh, found = blob
    again = found.at(facets=80)
    np.testing.assert_array_equal(again.vertices, found.vertices)
    np.testing.assert_array_equal(again.labels, found.labels)
    fewer = found.at(facets=40)
    np.testing.assert_array_equal(fewer.vertices, ridgeform.facet(mesh, facets=40).vertices)
    # So many that the coarser mesh says too little: all faces are asked.
    assert found.at(facets=700).n_facets == 700


def test_an_error_that_is_allowed_holds_on_the_mesh_itself(blob):
    mesh, _ = blob
    size = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    for error in (0.005 * size, 0.002 * size):
        found = ridgeform.facet(mesh, error=error)
        assert 0.5 * error < found.rms < 1.02 * error


def test_facets_that_are_wished_for_at_once_are_there(blob):
    mesh, _ = blob
    progress = ridgeform.Progress()
    progress.finish()
    found = ridgeform.facet(mesh, facets=80, progress=progress)
    assert found.status == "stopped"
    assert 0 < found.n_facets < 1000


def test_a_dense_polyhedron_keeps_every_plane():
    vertices, faces = boxes(50)
    assert len(vertices) > 18_000
    city = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert city.n_facets == 6 * 50
    assert city.rms < 1e-6


def boxes(count):
    """Boxes of several sizes beside each other."""
    rng = np.random.default_rng(0)
    vertices, faces = shapes.cube(8)
    parts = [vertices * rng.uniform(0.5, 1.0, 3) + [3.0 * i, 0.0, 0.0] for i in range(count)]
    return np.vstack(parts), np.vstack([faces + i * len(vertices) for i in range(count)])
