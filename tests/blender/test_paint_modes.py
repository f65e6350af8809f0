"""Tools in the modes that paint and sculpt: the same result as in Object Mode, and the mode stays."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import mesh_io

MODES = list(mesh_io.PAINTING.values())
TOOLS = {
    "stylize": {"steps": 3},
    "segment": {},
    "fill_holes": {},
    "denoise_attribute": {"attribute": "Heat"},
    "interpolate_attribute": {"attribute": "Heat", "known": "GROUP", "known_group": "Known"},
}


def painted():
    """A box without one of its faces, with an attribute and a vertex group."""
    obj = kit.bumpy_box(cuts=5)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.polygons[20].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="ONLY_FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    n = len(obj.data.vertices)
    heat = obj.data.attributes.new("Heat", "FLOAT", "POINT")
    heat.data.foreach_set("value", np.random.default_rng(0).random(n).astype(np.float32))
    obj.vertex_groups.new(name="Known").add(list(range(0, n, 3)), 1.0, "REPLACE")
    return obj


def look(obj):
    """Coordinates, faces and attributes of a mesh."""
    mesh = obj.data
    layout = {layer.name for layer in mesh.attributes if not layer.name.startswith(".")}
    values = [item.value for item in mesh.attributes["Heat"].data]
    for name in ("Heat_denoised", "Heat_interpolated"):
        if name in mesh.attributes:
            values += [item.value for item in mesh.attributes[name].data]
    index = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", index)
    places = kit.coordinates(obj).tolist()
    # Vertex Paint makes a color attribute where there is none.
    layout -= {"material_index", "Attribute"}
    return places, mesh_io.triangles(mesh).tolist(), layout, values, index.tolist()


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("tool", TOOLS)
def test_a_tool_does_the_same_as_in_object_mode(tool, mode):
    call = getattr(bpy.ops.ridgeform, tool)
    obj = painted()
    assert call(**TOOLS[tool]) == {"FINISHED"}
    wanted = look(obj)
    kit.empty_scene()
    other = kit.bumpy_box("Other")
    before = kit.coordinates(other)
    obj = painted()
    other.select_set(True)
    bpy.ops.object.mode_set(mode=mode)
    assert call.poll()
    assert call(**TOOLS[tool]) == {"FINISHED"}
    assert obj.mode == mode
    assert other.select_get()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert look(obj) == wanted
    # Only what is painted takes part.
    assert kit.same_bits(kit.coordinates(other), before)


@pytest.mark.parametrize("mode", MODES)
def test_what_is_refused_leaves_the_mode(mode):
    obj = kit.bumpy_box()
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.ridgeform.fill_holes() == {"CANCELLED"}
    assert obj.mode == mode


def test_other_modes_are_told_what_to_do():
    bpy.ops.object.armature_add()
    bpy.ops.object.mode_set(mode="POSE")
    assert not bpy.ops.ridgeform.stylize.poll()


@pytest.mark.parametrize("mode", MODES)
def test_materials_are_restored_there(mode):
    obj = painted()
    bpy.ops.object.mode_set(mode=mode)
    bpy.ops.ridgeform.segment()
    assert len(obj.data.materials) > 0
    bpy.ops.ridgeform.restore_materials()
    assert len(obj.data.materials) == 0 and obj.mode == mode
