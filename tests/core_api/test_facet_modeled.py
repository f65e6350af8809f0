"""`facet` of meshes that were modeled, not scanned: few vertices, exact planes, sides of length 0."""

import numpy as np
import pytest
import ridgeform
from known_shapes import coarse_shapes, shapes


@pytest.mark.parametrize(
    ("part", "n_planes"),
    [
        (coarse_shapes.box(), 6),
        (coarse_shapes.prism(5), 7),
        (coarse_shapes.prism(16), 18),
        (coarse_shapes.l_prism(), 8),
        (coarse_shapes.house(), 7),
        (coarse_shapes.house(chimney=True), 13),
        (coarse_shapes.boss(0.4), 11),
        (coarse_shapes.city(4), 24),
        (coarse_shapes.clamped_prism(16), 18),
        (coarse_shapes.clamped_prism(6), 8),
    ],
)
def test_planes_that_a_model_is_made_of_are_its_facets(part, n_planes):
    found = ridgeform.facet(ridgeform.Mesh(part.vertices, part.faces))
    assert found.n_facets == n_planes
    assert found.rms <= 1e-7
    assert found.n_crossings == 0


def test_boxes_in_a_row_that_touch_keep_their_sides():
    box = coarse_shapes.box((2.0, 2.0, 2.0))
    row = np.vstack([box.vertices + np.array([2.0 * i, 0.0, 0.0]) for i in range(4)])
    faces = np.vstack([box.faces + 8 * i for i in range(4)])
    found = ridgeform.facet(ridgeform.Mesh(row, faces))
    assert (found.n_facets, len(found.polygon_starts) - 1) == (24, 24)


def rounded_box(size, center, radius):
    vertices, faces = shapes.cube(16)
    half = np.array(size) / 2.0
    outer = vertices / np.abs(vertices).max() * half
    inner = np.clip(outer, radius - half, half - radius)
    away = outer - inner
    lengths = np.linalg.norm(away, axis=1, keepdims=True)
    return inner + radius * away / np.where(lengths > 0.0, lengths, 1.0) + center, faces


def joined(pieces):
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in pieces])
    faces = np.vstack([faces + n for n, (_, faces) in zip(counts, pieces, strict=False)])
    return ridgeform.Mesh(np.vstack([vertices for vertices, _ in pieces]), faces)


@pytest.mark.parametrize("n_steps", [6, 12, 16])
def test_the_steps_of_a_spiral_stair_keep_their_sides(n_steps):
    steps = []
    for k in range(n_steps):
        c, s = np.cos(0.3 * k), np.sin(0.3 * k)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        vertices, faces = rounded_box((1.0, 0.35, 0.06), (0.8, 0.0, 0.18 * k), 0.005)
        steps.append((vertices @ turn, faces))
    found = ridgeform.facet(joined(steps))
    # Faces were near the planes of wedges, but far from the wedges.
    assert found.n_facets == 6 * n_steps
    assert found.rms <= 1e-3


@pytest.mark.parametrize("radius", [0.005, 0.01])
def test_the_legs_of_a_stool_keep_their_sides(radius):
    boxes = [rounded_box((1.0, 1.0, 0.1), (0.0, 0.0, 0.5), radius)]
    for x, y in ((-0.4, -0.4), (-0.4, 0.4), (0.4, -0.4), (0.4, 0.4)):
        boxes.append(rounded_box((0.08, 0.08, 0.9), (x, y, 0.0), radius))
    found = ridgeform.facet(joined(boxes))
    # They hardly show in the mean of all: two sides less of each leg were within half a percent.
    assert found.n_facets == 30
    assert found.n_crossings == 0


@pytest.mark.parametrize("name", ["sphere", "cylinder", "coin"])
def test_a_round_shape_in_many_flat_sides_is_no_polyhedron(name):
    cylinder, coin = coarse_shapes.prism(200), coarse_shapes.prism(200, height=0.01)
    vertices, faces = {
        "sphere": shapes.uv_sphere(32, 16),
        "cylinder": (cylinder.vertices, cylinder.faces),
        "coin": (coin.vertices, coin.faces),
    }[name]
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.n_facets <= 60


def test_a_tube_that_passes_through_itself_has_the_facets_that_are_asked_for():
    t, s = 2.0 * np.pi * np.arange(96) / 96, 2.0 * np.pi * np.arange(16) / 16
    center = np.stack([np.sin(t), np.sin(2.0 * t) / 1.5, 0.05 * np.cos(t)], axis=1)
    along = np.roll(center, -1, axis=0) - np.roll(center, 1, axis=0)
    side = np.cross(along, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, along / np.linalg.norm(along, axis=1, keepdims=True))
    around = np.cos(s)[:, None] * side[:, None] + np.sin(s)[:, None] * up[:, None]
    here = np.arange(96 * 16).reshape(96, 16)
    right, above = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
    beyond = np.roll(right, -1, axis=1)
    faces = np.stack([here, right, beyond, here, beyond, above], axis=-1).reshape(-1, 3)
    mesh = ridgeform.Mesh((center[:, None] + 0.15 * around).reshape(-1, 3), faces)
    # Three pairs beside where the faces pass were kept apart by facets of single faces.
    found = ridgeform.facet(mesh, facets=40)
    assert (found.n_facets, found.n_crossings) == (40, 0)
    assert found.rms <= 0.02
