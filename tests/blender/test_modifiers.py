"""What is said of modifiers and shape keys that change or hide a result."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from mirror_kit import half_ball, warnings

SENTENCES = [
    ("SUBSURF", {}, "rounds the facets off"),
    ("SUBSURF", {"subdivision_type": "SIMPLE"}, None),
    ("SUBSURF", {"show_viewport": False}, None),
    ("SOLIDIFY", {}, None),
    ("ARRAY", {}, None),
    ("ARRAY", {"use_merge_vertices": True}, "merges copies"),
    ("ARMATURE", {}, "moves the facets"),
    ("LATTICE", {}, "moves the facets"),
    ("BOOLEAN", {}, "works on the facets"),
    ("BEVEL", {}, "works on the facets"),
    ("REMESH", {}, "makes new faces"),
    ("NODES", {}, "makes new faces"),
    ("LAPLACIANSMOOTH", {}, "rounds the facets off"),
]


@pytest.mark.parametrize(("kind", "settings", "sentence"), SENTENCES)
def test_other_modifiers_are_spoken_of(kind, settings, sentence):
    obj = kit.bumpy_box()
    modifier = obj.modifiers.new("Mine", kind)
    for name, value in settings.items():
        setattr(modifier, name, value)
    bpy.ops.ridgeform.stylize(steps=1)
    said = warnings()
    assert (f'"Mine" {sentence}' in said) if sentence else ('"Mine"' not in said)


def test_creases_hold_the_ridges_under_a_subdivision():
    obj = kit.bumpy_box()
    obj.modifiers.new("Mine", "SUBSURF")
    bpy.ops.ridgeform.stylize(steps=1, marks={"CREASE"})
    assert "Mine" not in warnings()


def test_a_shape_key_that_does_not_show_is_spoken_of():
    obj = kit.bumpy_box()
    obj.shape_key_add(name="Basis")
    key = kit.add_key(obj, "Smile", np.zeros((len(obj.data.vertices), 3)))
    obj.active_shape_key_index = 1
    key.value = 0.0
    bpy.ops.ridgeform.stylize(steps=1)
    assert 'shape key "Smile"' in warnings() and "value 0" in warnings()
    key.value = 1.0
    bpy.ops.ridgeform.stylize(steps=1)
    assert "Smile" not in warnings()


def painted_half():
    obj, coordinates = half_ball("X")
    colors = obj.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    values = np.ones((len(coordinates), 4), np.float32)
    values[:, :3] = coordinates[:, 2:] > 0
    colors.data.foreach_set("color", values.ravel())
    return obj


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda: bpy.ops.ridgeform.vibration_modes(count=2), "these are the modes of the half"),
        (lambda: bpy.ops.ridgeform.diffusion_curves(attribute="paint"), "the curves are those of the half"),
    ],
)
def test_tools_that_see_half_a_mirrored_mesh_say_so(call, what):
    obj = painted_half()
    assert call() == {"FINISHED"}
    assert what in warnings()
    obj.modifiers["Mirror"].show_viewport = False
    assert call() == {"FINISHED"}
    assert what not in warnings()
    obj.modifiers["Mirror"].show_viewport = True
    bpy.ops.object.modifier_apply(modifier="Mirror")
    assert call() == {"FINISHED"}
    assert what not in warnings()
