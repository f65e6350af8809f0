"""Segment leaves nothing of an earlier run behind, and gives materials and face sets back."""

import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender.stored_numbers import write_numbers
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.segments import layers, slots
from test_segment import SIDES, cube, flags, ints, same_partition, select_faces, slot_of_faces


def textured(n_slots=3, name="Cube"):
    """A cube whose faces are in slots of their own in turns, and these slots (f,)."""
    obj, truth = cube(name)
    for number in range(n_slots):
        obj.data.materials.append(bpy.data.materials.new(f"Tex{number}"))
    index = (np.arange(len(truth)) % n_slots).astype(np.int32)
    obj.data.polygons.foreach_set("material_index", index)
    return obj, truth, index


def names(obj):
    return [material and material.name for material in obj.data.materials]


def look(obj):
    """All that lies on a mesh: slots, attributes and their values, vertex groups."""
    layout = {}
    for attribute in obj.data.attributes:
        if attribute.data_type in {"INT", "BOOLEAN", "FLOAT"} and not attribute.name.startswith(".select"):
            values = [item.value for item in attribute.data]
            # Blender keeps some of its own that are nowhere set.
            if any(values) or attribute.name.startswith("ridgeform"):
                layout[attribute.name] = values
    layout.pop(layers.SEGMENT, None)
    return layout, names(obj), slot_of_faces(obj).tolist(), [group.name for group in obj.vertex_groups]


def test_materials_come_back_with_one_press():
    obj, truth, index = textured()
    before = look(obj)
    bpy.ops.ridgeform.segment()
    assert same_partition(slot_of_faces(obj), truth)
    assert "Restore Materials" in job.last_summary()[0]["warnings"][-1]
    assert np.array_equal(ints(obj, slots.KEPT), index)
    assert bpy.ops.ridgeform.restore_materials() == {"FINISHED"}
    assert look(obj) == before
    assert not bpy.ops.ridgeform.restore_materials.poll()
    assert len(bpy.data.materials) == 3


def test_a_mesh_without_slots_has_none_again():
    obj, _ = cube()
    bpy.ops.ridgeform.segment()
    assert job.last_summary()[0]["warnings"] == []
    bpy.ops.ridgeform.restore_materials()
    assert names(obj) == [] and not slot_of_faces(obj).any()
    assert len(bpy.data.materials) == 0


def test_an_empty_slot_counts_as_one():
    obj, _ = cube()
    obj.data.materials.append(None)
    bpy.ops.ridgeform.segment()
    bpy.ops.ridgeform.restore_materials()
    assert names(obj) == [None]


def test_restoring_survives_runs_with_other_counts_and_faces_given_other_slots():
    obj, _, index = textured()
    bpy.ops.ridgeform.segment()
    bpy.ops.ridgeform.segment(use_count=True, count=2)
    index[:5] = 1
    now = slot_of_faces(obj)
    now[:5] = 1
    obj.data.polygons.foreach_set("material_index", now)
    bpy.ops.ridgeform.segment()
    bpy.ops.ridgeform.restore_materials()
    assert np.array_equal(slot_of_faces(obj), index)


def test_slots_added_behind_those_of_segments_are_followed():
    obj, _, index = textured()
    bpy.ops.ridgeform.segment()
    obj.data.materials.append(bpy.data.materials.new("Late"))
    now = slot_of_faces(obj)
    now[7] = 3 + SIDES
    obj.data.polygons.foreach_set("material_index", now)
    bpy.ops.ridgeform.segment(use_count=True, count=2)
    bpy.ops.ridgeform.restore_materials()
    assert names(obj) == ["Tex0", "Tex1", "Tex2", "Late"]
    index[7] = 3
    assert np.array_equal(slot_of_faces(obj), index)


MAKES = ["MATERIALS", "SEAMS", "SHARP", "FACE_SETS", "VERTEX_GROUPS", "INDICATOR"]


@pytest.mark.parametrize("first", MAKES)
def test_another_make_leaves_nothing_of_the_first(first):
    second = "SEAMS" if first != "SEAMS" else "SHARP"
    obj, _, _ = textured()
    mine = np.zeros(len(obj.data.edges), bool)
    mine[[3, 40]] = True
    obj.data.edges.foreach_set("use_seam", mine)
    obj.vertex_groups.new(name="Mine")
    bpy.ops.ridgeform.segment(outputs={second})
    alone = look(obj)
    bpy.ops.ridgeform.segment(outputs={first})
    assert look(obj) != alone
    bpy.ops.ridgeform.segment(outputs={second})
    assert look(obj) == alone


def test_face_sets_come_back():
    obj, truth = cube()
    sets = (1 + np.arange(len(truth)) // 50).astype(np.int32)
    write_numbers(obj.data, layers.FACE_SET, "INT", "FACE", sets)
    bpy.ops.ridgeform.segment(outputs={"FACE_SETS"})
    bpy.ops.ridgeform.segment(outputs={"FACE_SETS"}, use_count=True, count=2)
    bpy.ops.ridgeform.segment(outputs={"SHARP"})
    assert np.array_equal(ints(obj, layers.FACE_SET), sets)


def test_in_edit_mode_only_the_selected_faces_change():
    obj, truth, index = textured()
    bpy.ops.ridgeform.segment()
    first = slot_of_faces(obj)
    top = truth == 0
    select_faces(obj, top)
    bpy.ops.ridgeform.segment(outputs={"SHARP"})
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(slot_of_faces(obj)[top], index[top])
    assert [names(obj)[k] for k in slot_of_faces(obj)[~top]] == [f"Cube Segment {k - 2}" for k in first[~top]]
    bpy.ops.ridgeform.restore_materials()
    assert np.array_equal(slot_of_faces(obj), index)


def test_materials_are_called_by_the_object():
    for name in ("Roof", "Wall"):
        obj, _ = cube(name)
        bpy.context.view_layer.objects.active = obj
    bpy.data.objects["Roof"].select_set(True)
    bpy.ops.ridgeform.segment()
    for name in ("Roof", "Wall"):
        assert names(bpy.data.objects[name]) == [f"{name} Segment {k + 1}" for k in range(SIDES)]


def test_materials_of_a_mesh_that_is_gone_do_not_take_the_names():
    obj, _ = cube()
    bpy.ops.ridgeform.segment()
    bpy.data.objects.remove(obj)
    bpy.data.meshes.remove(bpy.data.meshes[0])
    obj, _ = cube()
    bpy.ops.ridgeform.segment()
    assert names(obj) == [f"Cube Segment {k + 1}" for k in range(SIDES)]


def test_marks_of_seams_do_not_outlive_the_run():
    obj, _ = cube()
    bpy.ops.ridgeform.segment(outputs={"SEAMS"})
    assert flags(obj, "use_seam").any()
    bpy.ops.ridgeform.segment()
    assert not flags(obj, "use_seam").any()
