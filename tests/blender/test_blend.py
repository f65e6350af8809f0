"""A result as an attribute, and the modifier that blends the mesh with it."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform import job
from bl_ext.user_default.ridgeform.blender import blending
from bl_ext.user_default.ridgeform.framework import batch, files


def evaluated(obj):
    """The coordinates (n, 3) of a mesh with its modifiers."""
    made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    values = np.empty(3 * len(made.vertices), np.float32)
    made.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def blended():
    """A box, its coordinates, and the coordinates of its result, which it has as an attribute."""
    twin = kit.bumpy_box("Twin")
    bpy.ops.ridgeform.stylize(steps=3)
    twin.select_set(False)
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    assert bpy.ops.ridgeform.stylize(steps=3, output="ATTRIBUTE") == {"FINISHED"}
    assert kit.same_bits(kit.coordinates(obj), before)
    result = kit.coordinates(twin)
    assert np.abs(result - before).max() > 0.01
    return obj, before, result


def test_the_attribute_is_the_result():
    obj, _, result = blended()
    assert kit.same_bits(blending.stored(obj.data), result)
    assert [modifier.name for modifier in obj.modifiers] == ["Ridgeform Blend"]
    group = obj.modifiers[0].node_group
    assert group.asset_data is not None
    # Once more, on another mesh too: one modifier each, and one group.
    bpy.ops.ridgeform.stylize(steps=2, output="ATTRIBUTE")
    other = kit.bumpy_box("Other", seed=1)
    bpy.ops.ridgeform.stylize(steps=2, output="ATTRIBUTE")
    assert len(obj.modifiers) == len(other.modifiers) == 1
    assert [item for item in bpy.data.node_groups if item.name.startswith("Ridgeform")] == [group]


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.0])
def test_the_factor_blends(factor):
    obj, before, result = blended()
    blending.set_input(obj.modifiers[0], blending.FACTOR, factor)
    expected = before + np.float32(factor) * (result - before)
    assert np.allclose(evaluated(obj), expected, rtol=0, atol=1e-6)


def test_a_mask_blends_vertex_by_vertex():
    obj, before, result = blended()
    weights = np.random.default_rng(5).random(len(before)).astype(np.float32)
    group = obj.vertex_groups.new(name="Where")
    for vertex, weight in enumerate(weights.tolist()):
        group.add([vertex], weight, "REPLACE")
    blending.set_attribute(obj.modifiers[0], blending.MASK, "Where")
    blending.set_input(obj.modifiers[0], blending.FACTOR, 0.5)
    expected = before + 0.5 * weights[:, None] * (result - before)
    assert np.allclose(evaluated(obj), expected, rtol=0, atol=1e-6)


def test_without_the_attribute_nothing_moves():
    obj, before, _ = blended()
    blending.store(obj.data, None)
    assert kit.same_bits(evaluated(obj), before)
    assert not bpy.ops.ridgeform.blend_result.poll()


def test_the_modifier_comes_before_others_and_sees_no_note():
    obj = kit.bumpy_box()
    obj.modifiers.new("Round", "SUBSURF")
    bpy.ops.ridgeform.stylize(steps=2, output="ATTRIBUTE")
    assert [modifier.type for modifier in obj.modifiers] == ["NODES", "SUBSURF"]
    (entry,) = job.last_summary()
    assert not any("Ridgeform Blend" in note for note in entry["warnings"])
    bpy.ops.ridgeform.stylize(steps=2)
    (entry,) = job.last_summary()
    assert any("shows the result that was stored before" in note for note in entry["warnings"])


def test_the_operator_adds_the_modifier_again():
    obj, _, result = blended()
    obj.modifiers.clear()
    assert bpy.ops.ridgeform.blend_result() == {"FINISHED"}
    assert np.allclose(evaluated(obj), result, rtol=0, atol=1e-6)


def test_in_edit_mode_only_the_selection_differs():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    chosen = before[:, 2] > 0
    kit.select_only(obj, chosen)
    assert bpy.ops.ridgeform.stylize(steps=2, output="ATTRIBUTE") == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert kit.same_bits(kit.coordinates(obj), before)
    moved = (blending.stored(obj.data) != before).any(axis=1)
    assert moved.any()
    assert not moved[~chosen].any()


def test_low_poly_says_why_not():
    kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=2, output="ATTRIBUTE", finish="LOW_POLY")
    assert any("Result leaves the mesh as it is" in note for note in job.last_summary()[0]["warnings"])


def test_files_that_apply_modifiers_have_the_result(tmp_path):
    kit.bumpy_box()
    source = tmp_path / "box.blend"
    files.write_file(source)
    made = []
    for name, options in (("plain", ()), ("blended", ("--blend",))):
        target = tmp_path / f"{name}.obj"
        assert batch.main(["stylize", str(source), "-o", str(target), "--steps", "3", *options]) == 0
        (obj,) = files.read_file(target)
        made.append(kit.coordinates(obj))
    assert np.allclose(*made, rtol=0, atol=2e-6)
