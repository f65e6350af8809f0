"""Surfaces that touch along edges of four faces: each has facets of its own."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def test_two_cubes_that_touch_along_an_edge_have_twelve_sides():
    vertices, faces = shapes.voxels([(0, 0, 0), (1, 1, 0)], n=4)
    assert len(ridgeform.Mesh(vertices, faces).report.nonmanifold_edges) == 4
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.n_facets == 12 and found.rms < 1e-12
    report = ridgeform.Mesh(found.vertices, found.faces).report
    assert len(report.nonmanifold_edges) == 0 and report.n_boundary_loops == 0 and report.n_components == 2
    # Each corner is where the vertex is that it comes from; those that touch come from one.
    assert np.allclose(found.vertices, vertices[found.origins])
    assert len(found.vertices) - len(np.unique(found.origins)) == 2


def test_three_cubes_that_touch_in_pairs_have_eighteen_sides():
    vertices, faces = shapes.voxels([(0, 0, 0), (1, 1, 0), (1, 0, 1)], n=2)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.n_facets == 18 and found.n_crossings == 0


def test_their_faces_stay_together_where_a_mask_or_the_mesh_keeps_them():
    vertices, faces = shapes.voxels([(0, 0, 0), (1, 1, 0)], n=4)
    mask = vertices[faces].mean(axis=1)[:, 0] < np.median(vertices[:, 0])
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), faces=mask)
    assert len(np.unique(found.origins)) == len(found.vertices)
    kept = ridgeform.facet(ridgeform.Mesh(vertices, faces), keep_triangles=True)
    assert kept.kept_vertices.shape == vertices.shape and np.isfinite(kept.kept_vertices).all()


@pytest.mark.parametrize("turned", [False, True])
def test_faces_that_disagree_on_the_outside_do_not_fail(turned):
    vertices, faces = shapes.voxels([(0, 0, 0), (1, 1, 0)], n=2)
    if turned:
        half = len(faces) // 2
        faces[half:] = faces[half:, ::-1]
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.n_facets >= 12 and np.isfinite(found.vertices).all()


@pytest.mark.parametrize("density", [1, 2, 4])
def test_corners_in_the_middle_of_all_are_corners_as_others_are(density):
    """In the middle of the box, where all begins to count, coordinates are no more than rounding."""
    boxes = [shapes.voxels([cell], n=density) for cell in ((0, 0, 0), (1, 1, 0), (1, 0, 1))]
    counts = np.cumsum([0, *(len(vertices) for vertices, _ in boxes)])
    moved = [
        vertices - vertices.min(axis=0) + cell
        for (vertices, _), cell in zip(boxes, ((0, 0, 0), (1, 1, 0), (1, 0, 1)), strict=True)
    ]
    faces = np.concatenate([faces + count for (_, faces), count in zip(boxes, counts[:-1], strict=True)])
    mesh = ridgeform.Mesh(np.concatenate(moved), faces)
    for found in (ridgeform.facet(mesh), ridgeform.facet(mesh, facets=18)):
        assert found.n_facets == 18 and found.rms < 1e-12


@pytest.mark.parametrize("density", [1, 3])
def test_a_board_of_cubes_has_the_sides_of_all(density):
    cells = [(i, j, 0) for i in range(4) for j in range(4) if (i + j) % 2 == 0]
    found = ridgeform.facet(ridgeform.Mesh(*shapes.voxels(cells, n=density)), facets=48)
    assert found.n_facets == 48 and found.rms < 1e-12 and found.n_crossings == 0
