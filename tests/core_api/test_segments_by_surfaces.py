"""`segment` tells faces by their surfaces where these explain them better than one smooth surface would."""

from functools import cache

import numpy as np
import pytest
import ridgeform
from known_shapes import filleted_shapes as filleted, shapes
from known_shapes.segment_shapes import adjusted_rand_index, cube

SIZE, RADIUS, FACES = (2.0, 1.6, 1.3), 0.3, 26


@cache
def filleted_box(noise):
    return filleted.remeshed(
        filleted.filleted_box(SIZE, RADIUS, 40), filleted.zones_of_box(SIZE, RADIUS), 0.045, noise
    )


def vase(noise):
    """A body of revolution under a profile of sines, which no torus is: one face."""
    turns, rows = 56, 42
    z, angle = np.meshgrid(
        np.linspace(0.0, 3.0, rows + 1), 2.0 * np.pi * np.arange(turns) / turns, indexing="ij"
    )
    radius = 1.0 + 0.35 * np.sin(2.1 * z) + 0.1 * np.sin(4.3 * z + 1.0)
    vertices = np.column_stack(
        [(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel(), z.ravel()]
    )
    ids = np.arange((rows + 1) * turns).reshape(rows + 1, turns)
    a, b = ids[:-1], np.roll(ids[:-1], -1, axis=1)
    d, c = ids[1:], np.roll(ids[1:], -1, axis=1)
    quads = np.stack([a, b, c, d], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, noise, 2), faces)


def segmented(part, **given):
    return ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), threads=1, **given)


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_fillets_of_a_remeshed_part_are_segments_without_being_asked_for(noise):
    part = filleted_box(noise)
    found = segmented(part)
    assert found.n_segments == FACES
    assert adjusted_rand_index(found.labels, part.truth) > 0.93


def test_a_vase_is_one_face_and_in_patches_only_where_asked_for():
    mesh = vase(0.1)
    bent = ridgeform.segment(mesh, threads=1)
    assert bent.n_segments <= 2
    assert ridgeform.segment(mesh, fillets="apart", threads=1).n_segments > bent.n_segments + 2


@pytest.mark.parametrize("radius", [0.15, 0.3])
def test_a_rounded_box_has_the_same_faces_at_any_density(radius):
    for n in (26, 37):
        found = ridgeform.segment(ridgeform.Mesh(*shapes.rounded_box(n, radius)), threads=1)
        assert found.n_segments == FACES


def test_finer_and_coarser_segments_are_nested_with_those_by_surfaces():
    found = segmented(filleted_box(0.1))
    fewest, most = found.range
    assert fewest == 1
    assert most > FACES
    assert np.array_equal(found.labels_at(FACES), found.labels)
    for count in (6, 12, FACES, min(FACES + 20, most)):
        finer, coarser = found.labels_at(count), found.labels_at(max(count // 2, 1))
        assert len(np.unique(finer)) == count
        assert len(set(zip(finer.tolist(), coarser.tolist(), strict=True))) == count


@pytest.mark.parametrize("angle", [0.3, 1.2])
def test_planes_that_meet_at_less_than_the_angle_are_one(angle):
    """A roof of two planes that meet at 0.6."""
    vertices, faces = shapes.grid(40, 24)
    vertices = vertices.copy()
    vertices[:, 2] = -np.tan(0.3) * np.abs(vertices[:, 0] - 0.5 * vertices[:, 0].max())
    mesh = ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.05, 1), faces)
    assert ridgeform.segment(mesh, length_weight=angle / 0.8).n_segments == (2 if angle < 0.6 else 1)


def test_a_cube_is_as_by_bends_and_finer_segments_go_on_to_be_there():
    found = segmented(cube(1).noisy(0.1, 3).turned(1))
    assert found.n_segments == 6
    assert found.range[1] > 6
