"""`segment` on shapes modeled by hand, whose sides are a few triangles."""

import numpy as np
import pytest
import ridgeform
from known_shapes import coarse_shapes, segment_shapes

SHAPES = {
    "cube": (coarse_shapes.box(), 6),
    "plank": (coarse_shapes.box((10.0, 1.0, 0.2)), 6),
    "triangular prism": (coarse_shapes.prism(3), 5),
    "prism of 12 sides": (coarse_shapes.prism(12), 14),
    "tall prism of 12 sides": (coarse_shapes.prism(12, 10.0), 14),
    "cylinder of 32 sides": (coarse_shapes.prism(32), 3),
    "coin of 64 sides": (coarse_shapes.prism(64, 0.05), 3),
    "L": (coarse_shapes.l_prism(), 8),
    "house": (coarse_shapes.house(), 7),
    "house with a chimney": (coarse_shapes.house(chimney=True), 13),
    "small boss": (coarse_shapes.boss(0.1), 11),
    "city": (coarse_shapes.city(40), 240),
}


def segmented(part, **keywords):
    return ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), **keywords)


def agreement(found, part):
    return segment_shapes.adjusted_rand_index(found.labels, part.truth)


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("name", SHAPES)
def test_sides_of_two_triangles_are_found_at_any_angle(name, seed):
    part, count = SHAPES[name]
    assert part.n_parts == count
    found = segmented(part.turned(seed))
    assert found.n_segments == count
    assert agreement(found, part) == 1.0
    assert found.noise == 0.0
    assert np.array_equal(found.values, part.turned(seed).vertices)
    assert ((found.indicator >= 0) & (found.indicator <= 1)).all()


@pytest.mark.parametrize("name", ["house", "small boss", "cylinder of 32 sides"])
def test_single_precision_and_a_far_origin_change_nothing(name):
    part, count = SHAPES[name]
    points = (part.turned(4).vertices + np.array([300.0, -200.0, 50.0])).astype(np.float32).astype(float)
    found = ridgeform.segment(ridgeform.Mesh(points, part.faces))
    assert (found.n_segments, agreement(found, part)) == (count, 1.0)


def test_slivers_of_a_polygon_belong_to_its_plane():
    """A side of a box whose edge has further vertices on it, up to rounding: triangles without height."""
    part = coarse_shapes.box()
    side = np.flatnonzero(part.truth == part.truth[0])
    a, b, c = part.faces[side[0]]
    points, faces = list(part.vertices), [f for i, f in enumerate(part.faces) if i != side[0]]
    for t in (0.25, 0.5, 0.75):
        points.append((1 - t) * points[a] + t * points[b] + np.array([0.0, 0.0, 1e-9]))
    chain = [a, *range(len(points) - 3, len(points)), b]
    faces += [(chain[i], chain[i + 1], c) for i in range(4)]
    # The neighbor at the edge keeps it whole, so a fan of slivers closes the gap.
    faces += [(a, chain[i + 1], chain[i]) for i in range(1, 4)]
    found = ridgeform.segment(ridgeform.Mesh(np.array(points), np.array(faces)))
    assert found.n_segments == 6
    assert len(np.unique(found.labels[-7:-3])) == 1


def test_the_angle_of_a_border_is_the_border_cost():
    """Sides of a 12-gon meet at 30 degrees, 0.52."""
    part = coarse_shapes.prism(12)
    assert segmented(part, length_weight=0.6).n_segments == 14
    assert segmented(part, length_weight=0.7).n_segments == 3
    assert segmented(coarse_shapes.box(), length_weight=2.5).n_segments == 1


def test_the_strongest_borders_stay_when_fewer_segments_are_asked_for():
    part = coarse_shapes.prism(12)
    found = segmented(part, n_segments=3)
    caps = np.abs(np.diff(part.vertices[part.faces][:, :, 2], axis=1)).sum(axis=1) == 0
    assert found.n_segments == 3
    assert len(np.unique(found.labels[~caps])) == 1
    assert found.range == (1, 14)


def test_small_sides_go_only_if_that_is_asked_for():
    part = coarse_shapes.boss(0.1)
    assert segmented(part, min_faces=2).n_segments == 11
    assert segmented(part, min_faces=5).n_segments < 8


def test_the_functional_is_used_where_its_fidelity_is_given():
    assert segmented(coarse_shapes.box(), fidelity=1000.0).alternations > 1
