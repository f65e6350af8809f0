"""`segment` on walls and houses whose windows, plinths, and roofs are set back by an edge or more."""

import numpy as np
import pytest
import ridgeform
from known_shapes import segment_shapes, shapes, stepped_shapes
from known_shapes.segment_shapes import Part

DENSEST = 10_000
"""Vertices: above that a segmentation takes seconds."""


def check(part, least=0.99, extra=0):
    found = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces))
    assert part.n_parts <= found.n_segments <= part.n_parts + extra
    assert segment_shapes.adjusted_rand_index(found.labels, part.truth) >= least


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02, 0.05])
@pytest.mark.parametrize("depth", [1, 2, 3])
@pytest.mark.parametrize("name", stepped_shapes.SHAPES)
def test_parallel_sides_are_segments_of_their_own(name, depth, noise):
    part = stepped_shapes.SHAPES[name](16, depth)
    check(part.noisy(noise, 10 + depth).turned(depth))


@pytest.mark.parametrize("noise", [0.01, 0.05])
@pytest.mark.parametrize("name", ["house", "round wall"])
def test_irregular_triangles_change_nothing(name, noise):
    check(stepped_shapes.irregular(stepped_shapes.SHAPES[name](16, 1), 3).noisy(noise, 20).turned(5))


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_a_finer_wall_has_the_same_sides(noise):
    check(stepped_shapes.round_wall(32, 1).noisy(noise, 4).turned(2))


def test_a_house_in_a_mesh_with_a_character_is_told_as_well():
    """A part whose ridges close beside one without ridges."""
    wall = stepped_shapes.round_wall(16, 1)
    vertices, faces = shapes.icosphere(3)
    both = Part(
        np.vstack([wall.vertices, 8.0 * vertices + [60.0, 0.0, 0.0]]),
        np.vstack([wall.faces, faces + len(wall.vertices)]),
        np.concatenate([wall.truth, np.full(len(faces), wall.n_parts)]),
    )
    check(both.noisy(0.03, 1))


def test_borders_between_regions_fall_to_a_larger_length_weight_and_to_fewer_segments():
    part = stepped_shapes.round_wall(16, 1).noisy(0.03, 1)
    mesh = ridgeform.Mesh(part.vertices, part.faces)
    assert ridgeform.segment(mesh, length_weight=4.0).n_segments == 1
    found = ridgeform.segment(mesh)
    assert found.range[0] == 1
    assert len(np.unique(found.labels_at(5))) == 5
    # Reveals have eight faces.
    assert ridgeform.segment(mesh, min_faces=10).n_segments < part.n_parts


@pytest.mark.parametrize("name", ["cylinder with caps", "fan part", "gabled house"])
def test_curved_sides_and_blunt_ridges_are_as_they_were(name):
    check(segment_shapes.SHAPES[name](0).noisy(0.03, 2).turned(1))


@pytest.mark.parametrize("name", ["gabled house", "fan part", "cylinder with caps", "L-shape", "staircase"])
def test_a_shape_has_the_same_faces_at_every_density(name):
    shares = []
    for level in (0, 1, 2):
        part = segment_shapes.SHAPES[name](level)
        if len(part.vertices) > DENSEST:
            break
        corners = part.vertices[part.faces]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        labels = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces)).labels
        shares.append(np.sort(np.bincount(labels, weights=areas / areas.sum())))
        assert len(shares[-1]) == part.n_parts
    assert len(shares) > 1
    for other in shares[1:]:
        np.testing.assert_allclose(other, shares[0], atol=0.003)
