"""Shape keys: the active one is read and written as Blender itself would, and the result can be a new one."""

import addon_kit as kit
import bmesh
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.stylize.settings import default_settings, stylize_options

STEPS = 3


@pytest.fixture
def keyed():
    """A box with a Basis, a key A relative to it, B relative to A, and C relative to itself."""
    obj = kit.bumpy_box()
    rng = np.random.default_rng(5)
    shape = kit.coordinates(obj).shape
    obj.shape_key_add(name="Basis")
    keys = [kit.add_key(obj, name, rng.normal(scale=0.1, size=shape)) for name in "ABC"]
    keys[1].relative_key = keys[0]
    keys[2].relative_key = keys[2]
    keys[0].value = 0.5
    return obj


def all_keys(obj):
    return {key.name: kit.key_coordinates(obj, key.name) for key in obj.data.shape_keys.key_blocks}


def activate(obj, name):
    obj.active_shape_key_index = obj.data.shape_keys.key_blocks.find(name)


def api_result(coordinates, triangles):
    """What the wheel makes of coordinates on the triangles of a mesh."""
    mesh = ridgeform.Mesh(coordinates.astype(np.float64), triangles)
    return ridgeform.stylize(mesh, **stylize_options(default_settings(steps=STEPS))).vertices.astype(
        np.float32
    )


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("name", ["A", "C"])
def test_active_key_is_read_and_written(keyed, mode, name):
    before = all_keys(keyed)
    expected = api_result(before[name], mesh_io.triangles(keyed.data))
    activate(keyed, name)
    if mode == "EDIT":
        kit.select_only(keyed, np.ones(len(expected), bool))
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    after = all_keys(keyed)
    assert kit.same_bits(after[name], expected)
    assert kit.same_bits(after["Basis"], before["Basis"])
    assert kit.same_bits(kit.coordinates(keyed), before["Basis"])
    if name == "A":
        moved = after["A"] - before["A"]
        assert np.abs(after["B"] - before["B"] - moved).max() < 1e-6


@pytest.mark.parametrize("name", ["Basis", "A", "B"])
def test_relative_keys_follow_as_when_blender_edits(keyed, name):
    """Writing in Object Mode leaves the very bits that the same edit leaves in Blender's Edit Mode."""
    activate(keyed, name)
    twin = keyed.copy()
    twin.data = keyed.data.copy()
    kit.link(twin)
    activate(twin, name)
    target = kit.key_coordinates(keyed, name)
    target = (target + np.random.default_rng(6).normal(scale=0.2, size=target.shape)).astype(np.float32)
    mesh_io.open_coordinates(keyed).write(target)
    kit.select_only(twin, np.ones(len(target), bool))
    keyed.select_set(False)
    edited = bmesh.from_edit_mesh(twin.data)
    for vertex, position in zip(edited.verts, target.tolist(), strict=True):
        vertex.co = position
    bmesh.update_edit_mesh(twin.data)
    bpy.ops.object.mode_set(mode="OBJECT")
    ours, theirs = all_keys(keyed), all_keys(twin)
    for key, values in ours.items():
        assert kit.same_bits(values, theirs[key]), key
    assert kit.same_bits(kit.coordinates(keyed), kit.coordinates(twin))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("name", ["Basis", "A"])
def test_restore_puts_back_every_bit(keyed, mode, name):
    activate(keyed, name)
    before, positions = all_keys(keyed), kit.coordinates(keyed)
    if mode == "EDIT":
        kit.select_only(keyed, np.ones(len(positions), bool))
        mesh_io.flush_edit_mode(keyed)
    access = mesh_io.open_coordinates(keyed)
    for step in (1, 2):
        access.write((access.original * (1 + 0.1 * step)).astype(np.float32))
    access.restore()
    bpy.ops.object.mode_set(mode="OBJECT")
    for key, values in all_keys(keyed).items():
        assert kit.same_bits(values, before[key]), key
    assert kit.same_bits(kit.coordinates(keyed), positions)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_result_as_new_key_on_a_mesh_without_keys(mode):
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    expected = api_result(before, mesh_io.triangles(obj.data))
    if mode == "EDIT":
        kit.select_only(obj, np.ones(len(before), bool))
    assert bpy.ops.ridgeform.stylize(steps=STEPS, output="SHAPE_KEY") == {"FINISHED"}
    assert obj.mode == mode
    bpy.ops.object.mode_set(mode="OBJECT")
    assert list(all_keys(obj)) == ["Basis", "Stylized"]
    assert kit.same_bits(kit.key_coordinates(obj, "Basis"), before)
    assert kit.same_bits(kit.coordinates(obj), before)
    assert kit.same_bits(kit.key_coordinates(obj, "Stylized"), expected)
    assert obj.active_shape_key.name == "Stylized"
    assert obj.active_shape_key.value == 1


def test_result_as_new_key_builds_on_the_active_key(keyed):
    activate(keyed, "A")
    before = all_keys(keyed)
    assert bpy.ops.ridgeform.stylize(steps=STEPS, output="SHAPE_KEY") == {"FINISHED"}
    after = all_keys(keyed)
    for name, values in before.items():
        assert kit.same_bits(after[name], values)
    assert keyed.data.shape_keys.key_blocks["Stylized"].relative_key.name == "A"
    assert not np.array_equal(after["Stylized"], before["A"])


@pytest.mark.parametrize("tool", ["stylize", "segment", "fill_holes", "denoise_attribute"])
def test_keys_without_points_are_no_fault(tool):
    """Blender 5.2 says some length of a key of an empty mesh."""
    obj = kit.add_object("Nothing", np.empty((0, 3)), [])
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Later")
    with pytest.raises(RuntimeError, match='"Nothing"'):
        getattr(bpy.ops.ridgeform, tool)()
    assert mesh_io.key_coordinates(obj.data)["Later"].shape == (0, 3)


def test_keys_of_fewer_vertices_than_the_mesh_are_refused(keyed):
    """A script has added vertices, and Blender leaves the keys as they were."""
    keyed.data.vertices.add(3)
    with pytest.raises(RuntimeError, match="shape keys with another number of vertices"):
        bpy.ops.ridgeform.stylize()
