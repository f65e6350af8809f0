"""Filling holes of half a mesh under a Mirror modifier."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework.job import last_summary
from mirror_kit import half_ball, open_edges


def remove_faces(obj: bpy.types.Object, chosen: np.ndarray) -> None:
    kit.select_only(obj, np.zeros(len(obj.data.vertices), bool))
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.polygons.foreach_set("select", chosen)
    bpy.context.scene.tool_settings.mesh_select_mode = (False, False, True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.object.mode_set(mode="OBJECT")


def centers(obj: bpy.types.Object) -> np.ndarray:
    return np.array([face.center for face in obj.data.polygons])


@pytest.mark.parametrize("axes", ["X", "XY", "XYZ"])
def test_the_seam_is_no_hole(axes):
    half_ball(axes)
    assert bpy.ops.ridgeform.fill_holes() == {"CANCELLED"}


def test_a_hole_beside_the_seam_is_filled():
    obj, _ = half_ball()
    far = np.linalg.norm(centers(obj) - [0.8, 0.4, 0.3], axis=1)
    remove_faces(obj, far < 0.25)
    n = len(obj.data.vertices)
    bpy.ops.ridgeform.fill_holes()
    assert last_summary()[0]["holes"] == 1
    assert (kit.coordinates(obj)[n:, 0] > 0.0).all()
    assert open_edges(obj) == 0


def test_a_hole_that_touches_the_seam_in_a_vertex_is_filled():
    obj, _ = half_ball()
    middle = centers(obj)
    first = np.argmin(np.linalg.norm(middle - [0.1, 0.0, 1.0], axis=1))
    touching = set(obj.data.polygons[first].vertices)
    on_seam = [v for v in touching if obj.data.vertices[v].co.x == 0.0]
    chosen = np.zeros(len(middle), bool)
    second = next(
        face.index
        for face in obj.data.polygons
        if on_seam[0] not in face.vertices and len(touching & set(face.vertices)) == 2 and face.index != first
    )
    chosen[second] = True
    remove_faces(obj, chosen)
    bpy.ops.ridgeform.fill_holes()
    assert last_summary()[0]["holes"] == 1 and open_edges(obj) == 0


@pytest.mark.parametrize(
    ("axes", "place"), [("X", [0.0, 0.4, 0.9]), ("X", [0.0, -1.0, 0.0]), ("XY", [0, 0, 1])]
)
@pytest.mark.parametrize("shape", ["AUTO", "SHARP", "FLAT"])
def test_a_hole_across_the_plane_gets_its_own_side_of_a_patch(axes, place, shape):
    obj, _ = half_ball(axes)
    remove_faces(obj, np.linalg.norm(centers(obj) - place, axis=1) < 0.35)
    before = kit.coordinates(obj)
    assert open_edges(obj) > 0
    bpy.ops.ridgeform.fill_holes(shape=shape)
    assert last_summary()[0]["holes"] == 1
    made = kit.coordinates(obj)[len(before) :]
    assert open_edges(obj) == 0
    for axis in axes:
        column = "XYZ".index(axis)
        assert made[:, column].min() == 0.0 and (made[:, column] == 0.0).sum() > 2
    sizes = np.array([face.area for face in obj.data.polygons])
    assert sizes.min() > 0.0


def test_holes_across_and_beside_the_plane_at_once():
    obj, _ = half_ball()
    middle = centers(obj)
    beside = np.linalg.norm(middle - [0.8, 0.4, 0.3], axis=1) < 0.2
    remove_faces(obj, beside | (np.linalg.norm(middle - [0.0, 0.0, 1.0], axis=1) < 0.3))
    bpy.ops.ridgeform.fill_holes()
    assert last_summary()[0]["holes"] == 2 and open_edges(obj) == 0


def test_a_patch_is_cut_along_a_plane():
    clipping = __import__("bl_ext.user_default.ridgeform.holes.clipping", fromlist=["Pieces"])
    corners = np.array([[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]])
    pieces = clipping.Pieces(
        corners,
        np.empty((0, 3)),
        np.array([[0, 1, 2], [0, 2, 3]]),
        np.array([0, 0]),
        np.array([[0, 2], [2, 3]]),
    )
    pieces.cut(np.array([1.0, 0.0, 0.0]), 0.0, np.zeros(4, bool))
    pieces.compact()
    full = np.concatenate([corners, pieces.points])[pieces.triangles]
    assert (full[:, :, 0] >= 0.0).all()
    areas = np.linalg.norm(np.cross(full[:, 1] - full[:, 0], full[:, 2] - full[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(2.0) and len(pieces.points) == 3
    assert len(pieces.ridges) == 1 and pieces.ridges[0].min() == 0
