"""Segmenting into parts: the operator gives what the wheel gives, and makes of it what it makes of faces."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.blender.stored_numbers import read_ints
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.segments import groups, layers
from known_shapes import limbs
from known_shapes.segment_shapes import adjusted_rand_index

PARTS = 5


@pytest.fixture
def ball():
    vertices, faces, truth = limbs.ball_with_limbs(4)
    return kit.add_object("Ball", vertices, faces.tolist()), truth


def labels_of(obj):
    return read_ints(obj.data, layers.SEGMENT, "FACE", -7)


def kept_in(obj):
    """The names of all that a run adds, and which edges are marked."""
    marks = [(edge.use_seam, edge.use_edge_sharp) for edge in obj.data.edges]
    slots = [material.name for material in obj.data.materials]
    attributes = sorted(attribute.name for attribute in obj.data.attributes)
    return attributes, slots, [group.name for group in obj.vertex_groups], marks, len(bpy.data.materials)


def expected(obj, n_parts=None, **keywords):
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), mesh_io.triangles(obj.data))
    return ridgeform.parts(mesh, n_parts=n_parts, **keywords)


def edges_open(mesh):
    """How many edges have one face."""
    return int((np.bincount(mesh_io.corner_edges(mesh), minlength=len(mesh.edges)) == 1).sum())


def test_the_operator_gives_the_parts_that_the_wheel_gives(ball):
    obj, truth = ball
    assert bpy.ops.ridgeform.segment(kind="PARTS") == {"FINISHED"}
    found = expected(obj)
    assert np.array_equal(labels_of(obj), found.labels)
    assert adjusted_rand_index(labels_of(obj), truth) >= 0.95
    (entry,) = job.last_summary()
    assert entry["segments"] == PARTS
    assert entry["possible"] == list(found.range)
    assert len(obj.data.materials) == PARTS


def test_another_number_is_nested_and_a_second_run_leaves_nothing_behind(ball):
    obj, _ = ball
    before = mesh_io.positions(obj.data).copy()
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"MATERIALS", "VERTEX_GROUPS", "SEAMS", "FACE_SETS"})
    assert len(obj.vertex_groups) == PARTS
    finer = labels_of(obj)
    bpy.ops.ridgeform.segment(
        kind="PARTS", use_count=True, count=2, outputs={"MATERIALS", "VERTEX_GROUPS", "SEAMS", "FACE_SETS"}
    )
    coarser = labels_of(obj)
    assert len(np.unique(np.stack([finer, coarser]), axis=1).T) == PARTS
    assert np.array_equal(coarser, expected(obj).labels_at(2))
    assert len(obj.vertex_groups) == len(obj.data.materials) == len(bpy.data.materials) == 2
    seams = np.zeros(len(obj.data.edges), bool)
    obj.data.edges.foreach_get("use_seam", seams)
    assert np.array_equal(seams, layers.border_edges(obj.data, coarser))
    assert np.array_equal(mesh_io.positions(obj.data), before)


def test_undo_leaves_nothing_of_the_parts_behind(ball):
    obj, _ = ball
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="made")
    before = kept_in(obj)
    outputs = {"MATERIALS", "VERTEX_GROUPS", "SEAMS", "SHARP", "FACE_SETS"}
    bpy.ops.ridgeform.segment(kind="PARTS", outputs=outputs)
    assert kept_in(obj) != before
    bpy.ops.ed.undo_push(message="divided")
    bpy.ops.ed.undo()
    assert kept_in(bpy.data.objects["Ball"]) == before


def test_groups_with_a_transition_are_soft_and_sum_to_one(ball):
    obj, truth = ball
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"VERTEX_GROUPS"}, transition=0.6)
    weights = np.stack([mesh_io.group_weights(obj, group.name) for group in obj.vertex_groups])
    assert len(weights) == PARTS
    np.testing.assert_allclose(weights.sum(axis=0), 1.0, atol=2e-3)
    distance = np.linalg.norm(mesh_io.positions(obj.data), axis=1)
    far = distance > 2.0
    assert (weights[:, far].max(axis=0) == 1.0).all()
    near = np.abs(distance - 1.15) < 0.1
    assert ((weights > 0.02) & (weights < 0.98)).any(axis=0)[near].any()
    # Along a limb the weight of the body only falls.
    body = labels_of(obj)[np.flatnonzero(truth == limbs.BODY)[0]]
    hard = groups.segment_weights(obj.data, labels_of(obj), 0.0)
    assert set(np.unique(hard[int(body)])) == {0.0, 1.0}


def test_borders_that_exist_are_kept_where_they_can(ball):
    obj, truth = ball
    far = np.linalg.norm(mesh_io.positions(obj.data)[mesh_io.triangles(obj.data)].mean(axis=1), axis=1)
    tip = ((truth == 1) & (far > 1.7)).astype(np.int32)
    rim = layers.border_edges(obj.data, tip)
    obj.data.edges.foreach_set("use_edge_sharp", rim)
    bpy.ops.ridgeform.segment(kind="PARTS", use_count=True, count=2, existing={"SHARP"})
    assert adjusted_rand_index(labels_of(obj), tip) >= 0.99
    bpy.ops.ridgeform.segment(kind="PARTS", use_count=True, count=2)
    assert adjusted_rand_index(labels_of(obj), tip) < 0.9


@pytest.mark.usefixtures("ball")
def test_capped_parts_are_closed():
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"OBJECTS"}, use_caps=True)
    objects = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    assert len(objects) == PARTS
    for item in objects:
        assert edges_open(item.data) == 0
        assert "ridgeform_cut" not in item.data.attributes
    assert sum(len(item.data.polygons) for item in objects) > 5120


@pytest.mark.usefixtures("ball")
def test_parts_without_caps_stay_open_at_the_cuts():
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"OBJECTS"})
    objects = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    assert all(edges_open(item.data) > 0 for item in objects)


@pytest.mark.usefixtures("ball")
def test_making_objects_leaves_nothing_in_the_context():
    """Blender 4.2 keeps the scene in it where its tool settings were read: the next glTF export crashed."""
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"OBJECTS"})
    assert bpy.context.id_data is None


def test_what_parts_do_not_have_is_said(ball):
    obj, _ = ball
    bpy.ops.ridgeform.segment(kind="PARTS", outputs={"INDICATOR"})
    (entry,) = job.last_summary()
    assert any("no indicator" in note for note in entry["warnings"])
    assert layers.INDICATOR not in obj.data.attributes


def test_only_selected_faces_are_divided_in_edit_mode(ball):
    obj, truth = ball
    mask = truth != 2
    obj.data.polygons.foreach_set("select", mask)
    bpy.context.scene.tool_settings.mesh_select_mode = (False, False, True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ridgeform.segment(kind="PARTS")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (labels_of(obj)[~mask] == -1).all()
    assert adjusted_rand_index(labels_of(obj)[mask], truth[mask]) >= 0.95
