"""One undo step takes everything back, one redo step brings it again. Run after test_batch: see there."""

import addon_kit as kit
import bpy
import hole_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import attribute_io, attribute_names

STEPS = 3


def test_undo_gives_the_mesh_back_and_redo_the_result():
    obj = kit.bumpy_box()
    bpy.ops.ed.undo_push(message="made")
    before = kit.coordinates(obj)
    bpy.ops.ridgeform.stylize(steps=STEPS)
    bpy.ops.ed.undo_push(message="stylized")
    after = kit.coordinates(bpy.data.objects["Box"])
    bpy.ops.ed.undo()
    assert kit.same_bits(kit.coordinates(bpy.data.objects["Box"]), before)
    bpy.ops.ed.redo()
    assert kit.same_bits(kit.coordinates(bpy.data.objects["Box"]), after)


def state(name="Box"):
    """Attributes and vertex groups, with their values, that a mesh has now."""
    obj = bpy.data.objects[name]
    return {
        item: attribute_io.read_values(obj, item).values.tobytes()
        for item in attribute_names.usable_names(obj)
    }


def painted_box():
    obj = kit.bumpy_box()
    values = np.random.default_rng(0).random(len(obj.data.vertices)).astype(np.float32)
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values)
    group = obj.vertex_groups.new(name="paint")
    for vertex, weight in enumerate(values[:60]):
        group.add([vertex], float(weight), "REPLACE")
    bpy.context.preferences.edit.use_global_undo = True
    return obj


@pytest.mark.parametrize("output", ["NEW", "IN_PLACE"])
@pytest.mark.parametrize("attribute", ["heat", "paint"])
def test_undo_takes_attributes_back_and_redo_brings_them(attribute, output):
    painted_box()
    bpy.ops.ed.undo_push(message="before")
    before = state()
    bpy.ops.ridgeform.denoise_attribute("EXEC_DEFAULT", True, attribute=attribute, output=output)
    after = state()
    assert after != before
    bpy.ops.ed.undo()
    assert state() == before
    bpy.ops.ed.redo()
    assert state() == after


@pytest.mark.parametrize("attribute", ["heat", "paint"])
def test_undo_in_edit_mode(attribute):
    obj = painted_box()
    kit.select_only(obj, kit.coordinates(obj)[:, 2] > 0)
    bpy.ops.ed.undo_push(message="before")
    before = edited_state()
    bpy.ops.ridgeform.interpolate_attribute(
        "EXEC_DEFAULT", True, attribute=attribute, known="UNSELECTED", output="IN_PLACE"
    )
    after = edited_state()
    assert after != before
    bpy.ops.ed.undo()
    assert bpy.context.mode == "EDIT_MESH"
    assert edited_state() == before
    bpy.ops.ed.redo()
    assert edited_state() == after


def test_undo_opens_the_holes_again():
    obj = hole_kit.box()
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    before = hole_kit.state(obj)
    bpy.ops.ridgeform.fill_holes("EXEC_DEFAULT", True)
    after = hole_kit.state(obj)
    assert len(after["faces"]) > len(before["faces"])
    bpy.ops.ed.undo()
    assert hole_kit.state(bpy.data.objects["Box"]) == before
    bpy.ops.ed.redo()
    assert hole_kit.state(bpy.data.objects["Box"]) == after


def edited_state():
    """The same of a mesh in Edit Mode, which is left and entered again."""
    bpy.ops.object.mode_set(mode="OBJECT")
    found = state()
    bpy.ops.object.mode_set(mode="EDIT")
    return found


def test_undo_takes_a_cure_back():
    box = kit.bumpy_box()
    box.data.vertices.add(3)
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.ridgeform.cure_faults(kind="loose_vertices") == {"FINISHED"}
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert len(bpy.data.objects["Box"].data.vertices) == 155
    bpy.ops.ed.redo()
    assert len(bpy.data.objects["Box"].data.vertices) == 152
