"""Panel, menus, presets, command: all there when registered, all gone when unregistered."""

from pathlib import Path

import addon_kit as kit
import bpy
import pytest
from bl_ext.user_default import ridgeform as addon
from bl_ext.user_default.ridgeform import job
from bl_ext.user_default.ridgeform.settings import SETTING_NAMES, default_settings, fidelity_of

CLASSES = (
    "RIDGEFORM_OT_stylize",
    "RIDGEFORM_OT_stylize_preset_add",
    "RIDGEFORM_MT_stylize_presets",
    "RIDGEFORM_PT_stylize",
    "RIDGEFORM_PT_stylize_where",
    "RIDGEFORM_PT_stylize_last_steps",
    "RIDGEFORM_PT_stylize_expert",
    "RIDGEFORM_PT_stylize_presets",
)
MENUS = ("VIEW3D_MT_object", "VIEW3D_MT_edit_mesh")
HANDLERS = ("load_pre", "undo_pre", "redo_pre")


def trace():
    """What the add-on has left in Blender."""
    return {
        "classes": {name for name in CLASSES if hasattr(bpy.types, name)},
        "menus": [len(getattr(bpy.types, menu)._dyn_ui_initialize()) for menu in MENUS],
        "handlers": [len(getattr(bpy.app.handlers, name)) for name in HANDLERS],
        "scene": hasattr(bpy.types.Scene, "ridgeform_stylize"),
        "presets": bool(bpy.utils.preset_paths("ridgeform/stylize")),
    }


def test_registering_and_unregistering_leave_nothing():
    there = trace()
    assert there["classes"] == set(CLASSES)
    assert there["scene"]
    assert there["presets"]
    addon.unregister()
    gone = trace()
    assert gone == {
        "classes": set(),
        "menus": [count - 1 for count in there["menus"]],
        "handlers": [count - 1 for count in there["handlers"]],
        "scene": False,
        "presets": False,
    }
    addon.register()
    assert trace() == there


def test_panel_and_operator_have_the_same_settings():
    panel = bpy.context.scene.ridgeform_stylize
    operator = bpy.ops.ridgeform.stylize.get_rna_type().properties
    for name in SETTING_NAMES:
        assert panel.bl_rna.properties[name].name == operator[name].name
        value = getattr(default_settings(), name)
        assert getattr(panel, name) == (pytest.approx(value) if isinstance(value, float) else value)


@pytest.mark.parametrize("name", ["Soft_Planes", "Facets", "Gemstone", "Paper_2024"])
def test_shipped_presets_set_the_panel(name):
    (folder,) = bpy.utils.preset_paths("ridgeform/stylize")
    settings = bpy.context.scene.ridgeform_stylize
    settings.steps = 999
    path = Path(folder, f"{name}.py")
    bpy.ops.script.execute_preset(filepath=str(path), menu_idname="RIDGEFORM_MT_stylize_presets")
    assert settings.steps != 999
    assert settings.coupling == ("separate" if name == "Paper_2024" else "joint")


def test_button_takes_the_settings_of_the_panel():
    kit.bumpy_box()
    bpy.context.scene.ridgeform_stylize.steps = 2
    bpy.ops.ridgeform.stylize("INVOKE_DEFAULT", from_panel=True)
    assert job.last_summary()[0]["steps"] == 2
    bpy.ops.ridgeform.stylize("INVOKE_DEFAULT", steps=3)
    assert job.last_summary()[0]["steps"] == 3


def test_operator_is_undoable_and_takes_presets():
    assert {"REGISTER", "UNDO", "PRESET"} <= bpy.types.RIDGEFORM_OT_stylize.bl_options


def test_wrong_wheel_is_refused(monkeypatch):
    monkeypatch.setattr(addon.wheel.ridgeform, "__version__", "0.0.0")
    with pytest.raises(RuntimeError, match=r"found version 0\.0\.0 of its native module"):
        addon.wheel.check_version()


def test_more_strength_means_less_fidelity():
    values = [fidelity_of(strength) for strength in (0.0, 0.25, 0.5, 0.75, 1.0)]
    assert values == sorted(values, reverse=True)


def test_unknown_setting_is_refused():
    with pytest.raises(TypeError, match="no setting step"):
        default_settings(step=3)
