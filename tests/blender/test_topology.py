"""Seams that rounding moved apart, turned faces, and missing lids: computed as one surface, and said."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job
from known_shapes import shapes


def halves(rounding, seed=2):
    """A noisy cube in two halves, one off by `rounding` in every coordinate, and the pairs at the seam."""
    vertices, faces = shapes.cube(8, 2.0)
    vertices = shapes.add_noise(vertices, faces, 0.05)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    parts = [np.unique(faces[side], return_inverse=True) for side in (~right, right)]
    (left, left_faces), (other, other_faces) = [(used, index.reshape(-1, 3)) for used, index in parts]
    off = rounding * np.random.default_rng(seed).choice([-1, 1], size=(len(other), 3))
    obj = kit.add_object(
        "Halves",
        np.concatenate([vertices[left], vertices[other] + off]),
        np.concatenate([left_faces, other_faces + len(left)]).tolist(),
    )
    _, first, second = np.intersect1d(left, other, return_indices=True)
    return obj, first, second + len(left)


@pytest.mark.parametrize("rounding", [0, 1e-7, 1e-6])
def test_a_seam_that_is_almost_welded_does_not_tear(rounding):
    obj, first, second = halves(rounding)
    bpy.ops.ridgeform.stylize(steps=5)
    moved = kit.coordinates(obj)
    assert np.array_equal(moved[first], moved[second])
    said = [note for note in job.last_summary()[0]["warnings"] if "up to rounding" in note]
    assert len(said) == (1 if rounding else 0)


def test_a_seam_that_is_almost_welded_is_no_hole():
    obj, _, _ = halves(1e-6)
    n_faces = len(obj.data.polygons)
    assert bpy.ops.ridgeform.fill_holes() == {"CANCELLED"}
    assert len(obj.data.polygons) == n_faces


def test_turned_faces_are_segmented_with_their_neighbors_and_counted():
    vertices, faces = shapes.cube(8, 2.0)
    turned = np.random.default_rng(4).random(len(faces)) < 0.1
    faces[turned] = faces[turned][:, ::-1]
    obj = kit.add_object("Turned", vertices, faces.tolist())
    bpy.ops.ridgeform.segment()
    (entry,) = job.last_summary()
    assert entry["segments"] == 6
    assert any(note.startswith(f"{turned.sum()} faces are turned") for note in entry["warnings"])
    assert np.array_equal([tuple(face.vertices) for face in obj.data.polygons], faces)


def test_t_junctions_and_second_lids_are_named():
    # A square beside two, whose common corner is in the middle of its edge, and a second lid on one of them.
    points = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (2, 1, 0), (3, 0, 0), (3, 1, 0), (3, 2, 0)]
    faces = [(0, 1, 2, 3), (1, 5, 6, 4), (4, 6, 7, 2), (4, 6, 5)]
    kit.add_object("Junction", np.array(points, float), faces)
    bpy.ops.ridgeform.segment()
    (entry,) = job.last_summary()
    assert any(note.startswith("1 vertex lies in the middle of edges") for note in entry["warnings"])
    assert any(note.startswith("2 faces lie on others") for note in entry["warnings"])


@pytest.mark.parametrize("shape", ["AUTO", "FLAT"])
def test_a_box_gets_its_lid_back(shape):
    vertices, faces = shapes.cube(8, 2.0)
    faces = faces[vertices[faces].mean(axis=1)[:, 2] < 0.99]
    obj = kit.add_object("Open", vertices, faces.tolist())
    n_faces = len(obj.data.polygons)
    bpy.ops.ridgeform.fill_holes(shape=shape, marks={"SHARP"})
    points = kit.coordinates(obj)
    new = [tuple(face.vertices) for face in obj.data.polygons][n_faces:]
    assert np.abs(points[np.unique(new)][:, 2] - 1).max() < 1e-6
    (entry,) = job.last_summary()
    assert entry["ridge_edges"] == 32


def test_a_hole_at_an_inner_wall_is_refused_by_name():
    vertices, faces = shapes.grid(8, 8)
    centers = vertices[faces].mean(axis=1)
    open_faces = faces[~((centers[:, 0] > 4) & (centers[:, 0] < 5) & (np.abs(centers[:, 1] - 4) < 1))]
    wall = np.column_stack([np.full(len(vertices), 4.0), vertices[:, 1], -vertices[:, 0]])
    both = np.concatenate([vertices, wall])
    unique, index = np.unique(both, axis=0, return_inverse=True)
    joined = index.ravel()[np.concatenate([open_faces, faces + len(vertices)])]
    kit.add_object("House", unique, joined.tolist())
    with pytest.raises(RuntimeError, match="non-manifold"):
        bpy.ops.ridgeform.fill_holes()
