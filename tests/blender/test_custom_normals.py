"""Custom normals after stylizing: they turn with the faces, and UVs and colors stay."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job


def corner_normals(obj):
    values = np.empty(3 * len(obj.data.loops), np.float32)
    obj.data.corner_normals.foreach_get("vector", values)
    return values.reshape(-1, 3)


def own_normals(obj):
    """The normals of a mesh without its custom ones."""
    other = obj.copy()
    other.data = obj.data.copy()
    bpy.context.collection.objects.link(other)
    with bpy.context.temp_override(object=other, active_object=other, selected_objects=[other]):
        bpy.ops.mesh.customdata_custom_splitnormals_clear()
    values = corner_normals(other)
    bpy.data.objects.remove(other)
    return values


def degrees_between(a, b):
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    return np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", a, b)))


def smooth_box():
    obj = kit.bumpy_box(cuts=7)
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), bool))
    return obj


@pytest.mark.parametrize("marks", [set(), {"SHARP"}])
def test_normals_that_files_bring_turn_with_the_faces(marks):
    obj = smooth_box()
    obj.data.normals_split_custom_set(corner_normals(obj).tolist())
    assert obj.data.has_custom_normals
    before = corner_normals(obj)
    bpy.ops.ridgeform.stylize(marks=marks)
    assert obj.data.has_custom_normals
    assert np.median(degrees_between(corner_normals(obj), before)) > 1.0
    assert degrees_between(corner_normals(obj), own_normals(obj)).max() < 1.0


def test_normals_with_a_bend_of_their_own_keep_it():
    obj = smooth_box()
    bent = corner_normals(obj) + 0.2 * np.array([0.0, 0.0, 1.0], np.float32)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    obj.data.normals_split_custom_set(bent.tolist())
    before = degrees_between(corner_normals(obj), own_normals(obj))
    bpy.ops.ridgeform.stylize(marks=set())
    after = degrees_between(corner_normals(obj), own_normals(obj))
    assert before.max() > 8.0
    assert np.abs(after - before).max() < 5.0 and np.median(np.abs(after - before)) < 1.0


@pytest.mark.skipif(bpy.app.version < (5, 0, 0), reason="free normals are from Blender 5.0 on")
def test_free_normals_are_spoken_of():
    obj = smooth_box()
    normals = corner_normals(obj)
    obj.data.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set(
        "vector", normals.ravel()
    )
    bpy.ops.ridgeform.stylize(steps=2)
    assert any("free custom normals" in note for note in job.last_summary()[0]["warnings"])


def test_uvs_and_colors_stay_in_every_bit():
    obj = smooth_box()
    rng = np.random.default_rng(0)
    layout = rng.random(2 * len(obj.data.loops)).astype(np.float32)
    obj.data.uv_layers[0].data.foreach_set("uv", layout)
    paint = rng.random(4 * len(obj.data.loops)).astype(np.float32)
    obj.data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER").data.foreach_set("color", paint)
    obj.data.normals_split_custom_set(corner_normals(obj).tolist())
    bpy.ops.ridgeform.stylize()
    now = np.empty_like(layout), np.empty_like(paint)
    obj.data.uv_layers[0].data.foreach_get("uv", now[0])
    obj.data.color_attributes["Paint"].data.foreach_get("color", now[1])
    assert np.array_equal(now[0], layout) and np.array_equal(now[1], paint)


def bent_box():
    """A smooth box whose custom normals are bent."""
    obj = smooth_box()
    bent = corner_normals(obj) + 0.3 * np.array([0.0, 0.0, 1.0], np.float32)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    obj.data.normals_split_custom_set(bent.tolist())
    return obj


NEW_FACES = [
    lambda **given: bpy.ops.ridgeform.stylize(finish="LOW_POLY", reduce_ratio=0.4, **given),
    lambda **given: bpy.ops.ridgeform.stylize(finish="FACETS", **given),
    bpy.ops.ridgeform.facet,
]


def notes():
    return "; ".join(job.last_summary()[0]["warnings"])


@pytest.mark.parametrize("call", NEW_FACES)
def test_new_faces_have_none_and_it_is_said(call):
    obj = bent_box()
    assert call() == {"FINISHED"}
    assert "its custom normals were cleared" in notes() and "so that the facets show" in notes()
    assert obj.data.has_custom_normals == ("where its faces are new" in notes())
    kit.empty_scene()
    smooth_box()
    assert call() == {"FINISHED"}
    assert "custom normals" not in notes()


@pytest.mark.parametrize("call", NEW_FACES)
def test_faces_that_a_mask_holds_keep_theirs(call):
    obj = bent_box()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.quads_convert_to_tris()
    bpy.ops.object.mode_set(mode="OBJECT")
    normals = corner_normals(obj)
    places, mesh = kit.coordinates(obj), obj.data
    group = obj.vertex_groups.new(name="Mask")
    group.add(np.flatnonzero(places[:, 2] > -0.3).tolist(), 1.0, "REPLACE")
    held = {}
    for loop, normal in zip(mesh.loops, normals, strict=True):
        held.setdefault(tuple(places[loop.vertex_index].tolist()), []).append(normal)
    deep = {place for place in held if place[2] < -0.8}
    assert call(strength_group="Mask") == {"FINISHED"}
    assert "its custom normals were cleared where its faces are new" in notes()
    now, places = corner_normals(obj), kit.coordinates(obj)
    seen = 0
    for loop, normal in zip(mesh.loops, now, strict=True):
        place = tuple(places[loop.vertex_index].tolist())
        if place in deep:
            seen += 1
            # Normals are stored in 16 bits, relative to the faces.
            assert min(degrees_between(np.array(held[place]), normal[None])) < 0.1
    assert seen > 50
