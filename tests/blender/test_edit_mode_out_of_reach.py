"""A mesh in Edit Mode that Blender's own operators cannot get out of it: refused, and left as it is."""

import addon_kit as kit
import bpy
import modal_kit
import pytest
from bl_ext.user_default.ridgeform.blender import selection
from modal_kit import Session, open_box


def hidden():
    """Hidden by a script while it is edited."""
    obj = open_box()
    bpy.ops.object.mode_set(mode="EDIT")
    obj.hide_set(True)
    return obj


def not_active():
    """Another object made the active one."""
    obj = open_box()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.objects.active = None
    return obj


@pytest.mark.parametrize("make", [hidden, not_active], ids=lambda make: make.__name__)
@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_it_is_refused(tool, make):
    obj = make()
    needs = modal_kit.TOOLS[tool][0].needs
    assert "is in Edit Mode, but hidden or not active" in selection.reason_against(obj, needs)


@pytest.mark.parametrize("mode", ["SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT", "EDIT"])
@pytest.mark.parametrize("tool", ["stylize", "segment", "cure_faults", "select_faults"])
def test_what_is_hidden_in_any_mode_is_refused_with_a_sentence(mode, tool):
    obj = open_box()
    bpy.ops.object.mode_set(mode=mode)
    obj.hide_set(True)
    before = obj.mode, kit.coordinates(obj).tobytes()
    with pytest.raises(RuntimeError) as refused:
        getattr(bpy.ops.ridgeform, tool)()
    assert "Traceback" not in str(refused.value)
    assert (obj.mode, kit.coordinates(obj).tobytes()) == before


@pytest.mark.parametrize("tool", ["stylize", "denoise", "fill_holes"])
def test_what_is_hidden_while_it_is_sculpted_ends_a_run(tool):
    obj = open_box()
    bpy.ops.object.mode_set(mode="SCULPT")
    session = Session(tool, [obj])
    obj.hide_set(True)
    assert session.finish() == {"CANCELLED"}
    session.check_ended()


@pytest.mark.parametrize("tool", modal_kit.TOOLS)
@pytest.mark.parametrize("change", ["hide", "deactivate"])
def test_it_ends_a_run_that_began_before(tool, change):
    obj = open_box()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    settings = {"known": "UNSELECTED"} if tool == "interpolate" else {}
    bpy.context.scene.tool_settings.mesh_select_mode = (True, False, False)
    if tool == "interpolate":
        bpy.ops.mesh.select_random(ratio=0.4, action="DESELECT")
    session = Session(tool, [obj], **settings)
    if change == "hide":
        obj.hide_set(True)
    else:
        bpy.context.view_layer.objects.active = None
    assert session.finish() == {"CANCELLED"}
    session.check_ended()
    assert "was changed meanwhile, it was hidden or is no longer active" in session.operator.reports[-1][1]


@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_the_mesh_of_a_twin_goes_into_edit_mode(tool):
    obj = open_box()
    kit.link(bpy.data.objects.new("Twin", obj.data))
    session = Session(tool, [obj])
    bpy.ops.object.mode_set(mode="EDIT")
    assert session.finish() == {"CANCELLED"}
    session.check_ended()
    assert "its mode was switched" in session.operator.reports[-1][1]
