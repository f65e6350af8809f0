"""`facet` of meshes that were modeled, not scanned: few vertices, exact planes, sides of length 0."""

import numpy as np
import pytest
import ridgeform
from known_shapes import coarse_shapes, shapes
from known_shapes.segment_shapes import Part


def clamped(sides):
    """A prism whose upright edges have a bevel of width 0, as where two bevels leave no room."""
    turn = np.repeat(2 * np.pi * np.arange(sides) / sides, 2)
    outline = np.column_stack([np.cos(turn), np.sin(turn)])
    n = len(outline)
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (0.0, 2.0)])
    ring = np.arange(n)
    after = (ring + 1) % n
    side = np.column_stack([ring, after, after + n, ring + n])
    caps = [[0, i + 1, i] for i in range(1, n - 1)] + [[n, n + i, n + i + 1] for i in range(1, n - 1)]
    faces = np.vstack([side[:, [0, 1, 2]], side[:, [0, 2, 3]], caps])
    return Part(vertices, faces, np.zeros(len(faces), int))


@pytest.mark.parametrize(
    ("part", "n_planes"),
    [
        (coarse_shapes.box(), 6),
        (coarse_shapes.prism(5), 7),
        (coarse_shapes.prism(32), 34),
        (coarse_shapes.l_prism(), 8),
        (coarse_shapes.house(), 7),
        (coarse_shapes.house(chimney=True), 13),
        (coarse_shapes.boss(0.4), 11),
        (coarse_shapes.city(4), 24),
        (clamped(32), 34),
        (clamped(6), 8),
    ],
)
def test_planes_that_a_model_is_made_of_are_its_facets(part, n_planes):
    found = ridgeform.facet(ridgeform.Mesh(part.vertices, part.faces))
    assert found.n_facets == n_planes
    assert found.rms <= 1e-7
    assert found.n_crossings == 0


def test_a_round_shape_of_flat_quads_is_no_polyhedron():
    vertices, faces = shapes.uv_sphere(32, 16)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.n_facets <= 100
