"""Vibration modes as attributes, and showing any attribute."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io, ramp
from bl_ext.user_default.ridgeform.blender.attribute_names import SHOWN
from bl_ext.user_default.ridgeform.framework import job

COUNT = 4


def floats(obj, name):
    data = obj.data.attributes[name].data
    values = np.empty(len(data), np.float32)
    data.foreach_get("value", values)
    return values


def mode_names(obj):
    return [a.name for a in obj.data.attributes if a.name.startswith("ridgeform_mode_")]


@pytest.mark.parametrize("energy", ["l1_hessian", "l2_curved_hessian"])
def test_modes_are_those_of_the_wheel(energy):
    obj = kit.bumpy_box()
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), mesh_io.triangles(obj.data))
    outcome = bpy.ops.ridgeform.vibration_modes(count=COUNT, energy=energy, delaunay=True)
    assert outcome == {"FINISHED"}
    tolerance = float(np.float32(0.001))
    expected = ridgeform.vibration_modes(mesh, COUNT, energy=energy, delaunay=True, tolerance=tolerance)
    assert mode_names(obj) == [f"ridgeform_mode_{index}" for index in range(COUNT)]
    for index, mode in enumerate(expected.T):
        assert kit.same_bits(floats(obj, f"ridgeform_mode_{index}"), mode.astype(np.float32))
    (entry,) = job.last_summary()
    assert entry["energies"] == sorted(entry["energies"])
    assert len(entry["energies"]) == COUNT


def test_a_second_run_replaces_the_first_and_shows_the_mode_asked_for():
    obj = kit.bumpy_box()
    obj.data.attributes.new("ridgeform_mode_1", "INT", "FACE")
    obj.data.attributes.new("ridgeform_mode_of_mine", "FLOAT", "POINT")
    bpy.ops.ridgeform.vibration_modes(count=5)
    bpy.ops.ridgeform.vibration_modes(count=3, shown=2)
    assert sorted(mode_names(obj)) == [*(f"ridgeform_mode_{i}" for i in range(3)), "ridgeform_mode_of_mine"]
    mode = floats(obj, "ridgeform_mode_2")
    places = 0.5 + 0.5 * mode / np.abs(mode).max()
    stored = np.empty(4 * len(mode), np.float32)
    obj.data.attributes[SHOWN].data.foreach_get("color", stored)
    assert np.allclose(stored.reshape(-1, 4), ramp.colors_at(ramp.DIVERGING, places), atol=1e-5)


def test_modes_in_edit_mode_are_those_of_the_whole_mesh():
    obj = kit.bumpy_box()
    bpy.ops.ridgeform.vibration_modes(count=COUNT)
    before = floats(obj, "ridgeform_mode_3")
    kit.select_only(obj, np.zeros(len(before), bool))
    assert bpy.ops.ridgeform.vibration_modes(count=COUNT) == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert kit.same_bits(floats(obj, "ridgeform_mode_3"), before)


def test_more_modes_than_vertices_are_refused():
    obj = kit.add_object("Face", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    with pytest.raises(RuntimeError, match="count: is 9"):
        bpy.ops.ridgeform.vibration_modes(count=9)
    assert mode_names(obj) == []
    assert SHOWN not in obj.data.attributes


def test_showing_an_attribute():
    obj = kit.bumpy_box()
    heat = kit.coordinates(obj)[:, 2]
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", heat)
    kit.select_only(obj, heat > 0)
    assert bpy.ops.ridgeform.show_attribute(attribute="heat", display="MATERIAL", bands=7) == {"FINISHED"}
    assert obj.mode == "EDIT"
    assert [material.name for material in obj.data.materials] == ["Ridgeform heat"]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.ridgeform.show_attribute(attribute="heat", signed=True) == {"FINISHED"}
    assert SHOWN in obj.data.attributes
    with pytest.raises(RuntimeError, match='has no attribute or vertex group "cold"'):
        bpy.ops.ridgeform.show_attribute(attribute="cold")
