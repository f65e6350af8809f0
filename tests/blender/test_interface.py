"""Panel, menus, presets, command: all there when registered, all gone when unregistered."""

import re
from fnmatch import fnmatch
from types import SimpleNamespace

import addon_kit as kit
import bpy
import hole_kit
import layout_kit
import pytest
from bl_ext.user_default import ridgeform as addon
from bl_ext.user_default.ridgeform.attributes.settings import (
    DenoiseSettings,
    InterpolateSettings,
    ModesSettings,
)
from bl_ext.user_default.ridgeform.diffusion.settings import DiffusionSettings
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.settings import defaults_of, setting_names
from bl_ext.user_default.ridgeform.holes.settings import HoleSettings
from bl_ext.user_default.ridgeform.segments.settings import SegmentSettings
from bl_ext.user_default.ridgeform.stylize.settings import (
    StylizeSettings,
    default_settings,
    first_fidelity_of,
    flat_share_of,
    movement_of,
)

CLASSES = (
    "RIDGEFORM_OT_stylize",
    "RIDGEFORM_OT_denoise_attribute",
    "RIDGEFORM_OT_interpolate_attribute",
    "RIDGEFORM_OT_vibration_modes",
    "RIDGEFORM_OT_segment",
    "RIDGEFORM_OT_segment_preset_add",
    "RIDGEFORM_MT_segment_presets",
    "RIDGEFORM_PT_segment",
    "RIDGEFORM_PT_segment_expert",
    "RIDGEFORM_PT_segment_presets",
    "RIDGEFORM_OT_show_attribute",
    "RIDGEFORM_OT_diffusion_curves",
    "RIDGEFORM_OT_redraw_diffusion_curves",
    "RIDGEFORM_OT_export_diffusion_svg",
    "RIDGEFORM_PT_diffusion",
    "RIDGEFORM_PT_diffusion_expert",
    "RIDGEFORM_OT_shipped_preset",
    "RIDGEFORM_OT_stylize_preset_add",
    "RIDGEFORM_OT_denoise_preset_add",
    "RIDGEFORM_OT_interpolate_preset_add",
    "RIDGEFORM_MT_stylize_presets",
    "RIDGEFORM_MT_denoise_presets",
    "RIDGEFORM_MT_interpolate_presets",
    "RIDGEFORM_PT_stylize",
    "RIDGEFORM_PT_stylize_where",
    "RIDGEFORM_PT_stylize_finish_options",
    "RIDGEFORM_PT_attributes_and_curves",
    "RIDGEFORM_MT_tools",
    "RIDGEFORM_OT_apply_result",
    "RIDGEFORM_OT_change_result",
    "RIDGEFORM_PT_stylize_expert",
    "RIDGEFORM_PT_stylize_presets",
    "RIDGEFORM_PT_denoise_presets",
    "RIDGEFORM_PT_interpolate_presets",
    "RIDGEFORM_PT_denoise",
    "RIDGEFORM_PT_denoise_expert",
    "RIDGEFORM_PT_interpolate",
    "RIDGEFORM_PT_interpolate_expert",
    "RIDGEFORM_PT_modes",
    "RIDGEFORM_PT_modes_expert",
    "RIDGEFORM_OT_fill_holes",
    "RIDGEFORM_OT_fill_holes_preset_add",
    "RIDGEFORM_MT_fill_holes_presets",
    "RIDGEFORM_PT_fill_holes",
    "RIDGEFORM_PT_fill_holes_expert",
    "RIDGEFORM_PT_fill_holes_presets",
    "RIDGEFORM_OT_blend_result",
    "RIDGEFORM_OT_check",
    "RIDGEFORM_OT_select_faults",
    "RIDGEFORM_OT_cure_faults",
    "RIDGEFORM_PT_check",
)
TOOLS = {
    "stylize": ("ridgeform_stylize", StylizeSettings),
    "denoise_attribute": ("ridgeform_denoise", DenoiseSettings),
    "interpolate_attribute": ("ridgeform_interpolate", InterpolateSettings),
    "segment": ("ridgeform_segment", SegmentSettings),
    "vibration_modes": ("ridgeform_modes", ModesSettings),
    "fill_holes": ("ridgeform_holes", HoleSettings),
    "diffusion_curves": ("ridgeform_diffusion", DiffusionSettings),
}
PRESETS = {tool.name: list(tool.presets or ()) for tool in addon.registry.TOOLS}
MENUS = ("VIEW3D_MT_object", "VIEW3D_MT_edit_mesh", "TOPBAR_MT_file_export")
HANDLERS = {
    "load_pre": 1,
    "load_post": 3,
    "undo_pre": 1,
    "undo_post": 1,
    "redo_pre": 1,
    "redo_post": 1,
    "save_pre": 1,
    "depsgraph_update_post": 1,
}


def trace():
    """What the add-on has left in Blender."""
    return {
        "classes": {name for name in CLASSES if hasattr(bpy.types, name)},
        "menus": [len(getattr(bpy.types, menu)._dyn_ui_initialize()) for menu in MENUS],
        "handlers": [len(getattr(bpy.app.handlers, name)) for name in HANDLERS],
        "scene": [hasattr(bpy.types.Scene, name) for name, _ in TOOLS.values()],
    }


def test_registering_and_unregistering_leave_nothing():
    there = trace()
    assert there["classes"] == set(CLASSES)
    assert all(there["scene"])
    addon.unregister()
    gone = trace()
    assert gone == {
        "classes": set(),
        "menus": [count - 1 for count in there["menus"]],
        "handlers": [count - own for count, own in zip(there["handlers"], HANDLERS.values(), strict=True)],
        "scene": [False] * len(TOOLS),
    }
    addon.register()
    assert trace() == there


@pytest.mark.parametrize("tool", list(TOOLS))
def test_panel_and_operator_have_the_same_settings(tool):
    scene_name, settings = TOOLS[tool]
    panel = getattr(bpy.context.scene, scene_name)
    operator = getattr(bpy.ops.ridgeform, tool).get_rna_type().properties
    for name in setting_names(settings):
        assert panel.bl_rna.properties[name].name == operator[name].name
        value = getattr(defaults_of(settings), name)
        assert getattr(panel, name) == (pytest.approx(value) if isinstance(value, float) else value)


def apply(tool, preset):
    assert bpy.ops.ridgeform.shipped_preset(tool=tool, preset=preset) == {"FINISHED"}


@pytest.mark.parametrize("name", ["Soft Planes", "Facets", "Gemstone", "Paper 2024"])
def test_shipped_presets_set_the_panel(name):
    settings = bpy.context.scene.ridgeform_stylize
    settings.steps = 999
    apply("stylize", name)
    assert settings.steps != 999
    assert settings.coupling == ("separate" if name == "Paper 2024" else "joint")


@pytest.mark.parametrize("tool", ["denoise", "interpolate"])
def test_shipped_presets_of_the_attribute_panels(tool):
    settings = getattr(bpy.context.scene, f"ridgeform_{tool}")
    seen = set()
    names = PRESETS[f"{tool}_attribute"]
    for name in names:
        settings.energy, settings.sharpness, settings.attribute = "l1_edge_laplacian", 0.125, "mine"
        apply(f"{tool}_attribute", name)
        assert settings.attribute == "mine"
        kinds = ("energy", "sharpness", "strength", "known")
        seen.add(tuple(getattr(settings, name) for name in kinds if hasattr(settings, name)))
    assert len(seen) == len(names) >= 3
    assert {entry[0] for entry in seen} == {"l1_hessian", "l2_curved_hessian"}


def test_shipped_presets_of_segmenting():
    settings = bpy.context.scene.ridgeform_segment
    seen = set()
    for name in PRESETS["segment"]:
        settings.length_weight, settings.method, settings.attribute = 9.0, "paper", "mine"
        apply("segment", name)
        assert settings.attribute == "mine"
        assert settings.use_fidelity == (settings.method == "paper") == (name == "Paper 2024")
        seen.add((settings.method, round(settings.length_weight, 6)))
    assert len(seen) == 4


def test_shipped_presets_of_fill_holes():
    settings = bpy.context.scene.ridgeform_holes
    seen = {}
    for name in PRESETS["fill_holes"]:
        settings.max_edges = 7
        apply("fill_holes", name)
        seen[name] = (settings.shape, frozenset(settings.marks))
        assert settings.max_edges == 7
    assert seen == {
        "Automatic": ("AUTO", frozenset()),
        "Hard Ridges": ("SHARP", frozenset({"SHARP"})),
        "Smooth": ("SMOOTH", frozenset()),
    }


@pytest.mark.parametrize(("tool", "preset"), [("stylize", "Melted"), ("vibration_modes", "Facets")])
def test_a_preset_that_is_not_there_is_refused(tool, preset):
    with pytest.raises(RuntimeError, match=f'"{tool}" has no preset "{preset}"'):
        bpy.ops.ridgeform.shipped_preset(tool=tool, preset=preset)


def test_button_of_fill_holes_takes_the_settings_of_the_panel():
    hole_kit.sheet()
    bpy.context.scene.ridgeform_holes.edge_length = 0.02
    bpy.ops.ridgeform.fill_holes("INVOKE_DEFAULT", from_panel=True)
    fine = job.last_summary()[0]["faces_added"]
    kit.empty_scene()
    hole_kit.sheet()
    bpy.ops.ridgeform.fill_holes("INVOKE_DEFAULT")
    assert fine > 4 * job.last_summary()[0]["faces_added"]


def test_button_takes_the_settings_of_the_panel():
    kit.bumpy_box()
    bpy.context.scene.ridgeform_stylize.steps = 2
    bpy.ops.ridgeform.stylize("INVOKE_DEFAULT", from_panel=True)
    assert job.last_summary()[0]["steps"] == 2
    bpy.ops.ridgeform.stylize("INVOKE_DEFAULT", steps=3)
    assert job.last_summary()[0]["steps"] == 3


def test_buttons_of_the_attribute_panels_take_their_settings():
    obj = kit.bumpy_box()
    obj.data.attributes.new("heat", "FLOAT", "POINT").data[3].value = 1.0
    obj.data.attributes.new("cold", "FLOAT", "POINT").data[4].value = 1.0
    bpy.context.scene.ridgeform_denoise.attribute = "heat"
    bpy.ops.ridgeform.denoise_attribute("INVOKE_DEFAULT", from_panel=True)
    assert job.last_summary()[0]["attribute"] == "heat"
    bpy.ops.ridgeform.denoise_attribute("INVOKE_DEFAULT", attribute="cold")
    assert job.last_summary()[0]["attribute"] == "cold"


@pytest.mark.parametrize("tool", list(TOOLS))
def test_operator_is_undoable(tool):
    # Presets are those of the panel: there is one set of values.
    assert getattr(bpy.types, f"RIDGEFORM_OT_{tool}").bl_options == {"REGISTER", "UNDO"}


STYLIZE = next(tool for tool in addon.registry.TOOLS if tool.name == "stylize")


def drawn(cls, **own):
    """What a panel, a menu or an operator draws."""
    drawing = SimpleNamespace(layout=layout_kit.Layout(), **own)
    drawing.draw_all = lambda context: cls.draw_all(drawing, context)
    cls.draw(drawing, bpy.context)
    return drawing.layout


def test_the_menu_says_what_the_search_finds():
    texts = " ".join(text for _, text in drawn(bpy.types.RIDGEFORM_MT_tools).buttons).lower()
    assert bpy.types.RIDGEFORM_MT_tools.bl_label == "Ridgeform"
    for word in ("low poly", "planar", "repair", "stylize", "segment", "redraw"):
        assert word in texts


def test_the_line_on_the_last_run_follows_undo_and_deletion():
    def labels():
        panel = drawn(bpy.types.RIDGEFORM_PT_stylize, tool=STYLIZE, section="")
        return [text for text in panel.labels if "facet" in text]

    bpy.context.preferences.edit.use_global_undo = True
    obj = kit.bumpy_box()
    bpy.ops.ed.undo_push(message="made")
    bpy.ops.ridgeform.stylize(steps=2)
    bpy.ops.ed.undo_push(message="stylized")
    assert labels()[0].startswith("Box: ")
    obj.name = "Renamed"
    assert labels() == []
    obj.name = "Box"
    assert labels()
    bpy.ops.ed.undo()
    assert labels() == []
    assert job.last_summary()[0]["steps"] == 2


def test_a_redo_that_takes_long_is_not_offered():
    kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=2)
    own = vars(default_settings()) | {"tool": STYLIZE}
    operator = bpy.types.RIDGEFORM_OT_stylize
    # Not what it took here: that would be the machine's load.
    job.store_summary([entry | {"seconds": 0.4} for entry in job.last_summary()])
    assert drawn(operator, **own).rows == ["finish", "steps", "strength", "sharpness"]
    job.store_summary([entry | {"seconds": 0.6} for entry in job.last_summary()])
    panel = drawn(operator, **own)
    assert panel.rows == []
    assert panel.labels == ["Took 0.6 s: change the settings in the sidebar (N)"]


def test_saved_defaults_are_those_of_scenes_that_do_not_say_otherwise(tmp_path):
    panel = bpy.context.scene.ridgeform_stylize
    panel.strength = 0.875
    saved = addon.framework.preferences.current().ridgeform_stylize
    try:
        assert bpy.ops.ridgeform.save_defaults(tool="stylize") == {"FINISHED"}
        panel.strength = 0.25
        path = str(tmp_path / "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        kit.empty_scene()
        assert bpy.context.scene.ridgeform_stylize.strength == 0.875
        bpy.ops.wm.open_mainfile(filepath=path)
        assert bpy.context.scene.ridgeform_stylize.strength == 0.25
        kit.bumpy_box()
    finally:
        for name in setting_names(StylizeSettings):
            saved.property_unset(name)
    kit.empty_scene()
    assert bpy.context.scene.ridgeform_stylize.strength == 0.5


def test_every_tool_is_looked_up_in_its_page_of_the_manual():
    manual = addon.framework.manual
    prefix, entries = manual.manual_map()
    assert prefix.startswith("file://")
    for tool in addon.registry.TOOLS:
        page = next(page for pattern, page in entries if fnmatch(f"bpy.ops.ridgeform.{tool.name}", pattern))
        text = (manual.PAGES / page).read_text(encoding="utf-8")
        assert tool.label in text
        assert manual.address_of(tool).endswith(page)
    assert manual.manual_map in bpy.utils._manual_map


def test_nothing_comes_out_of_a_panel():
    broken = SimpleNamespace(settings=None, presets=None, scene_property="none")
    panel = drawn(bpy.types.RIDGEFORM_PT_stylize, tool=broken, section="")
    assert panel.labels[0].startswith("AttributeError: ")
    assert drawn(bpy.types.RIDGEFORM_PT_stylize, tool=STYLIZE, section="").rows


def test_a_wheel_of_another_version_or_build_is_named(monkeypatch):
    wheel = addon.framework.wheel
    assert wheel.misfit() is None
    monkeypatch.setattr(wheel.ridgeform, "__build__", f"{wheel.ridgeform.__version__}+0")
    assert re.search(r"found version .+\+0 of its native module. Restart Blender", wheel.misfit())
    monkeypatch.setattr(wheel.ridgeform, "__build__", wheel.ridgeform.__version__)
    assert wheel.misfit() is None
    monkeypatch.setattr(wheel.ridgeform, "__version__", "0.0.0")
    assert "found version 0.0.0 of its native module" in wheel.misfit()


def test_scripts_ask_the_add_on_itself_what_the_last_run_did():
    kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=2)
    assert addon.job.last_summary() == job.last_summary()
    assert addon.job.last_summary()[0]["steps"] == 2


def test_more_strength_means_less_fidelity_and_more_of_the_rest():
    strengths = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5)
    values = [first_fidelity_of(strength) for strength in strengths]
    assert values == sorted(values, reverse=True)
    for more in (movement_of, flat_share_of):
        values = [more(strength) for strength in strengths]
        assert values == sorted(values)
        assert values[0] > 0 and values[-1] <= 1


def test_unknown_setting_is_refused():
    with pytest.raises(TypeError, match="no setting step"):
        default_settings(step=3)


def test_energy_and_gap_are_in_the_subpanel_for_experts():
    kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=2)
    panel = drawn(bpy.types.RIDGEFORM_PT_stylize, tool=STYLIZE, section="").labels
    expert = drawn(bpy.types.RIDGEFORM_PT_stylize_expert, tool=STYLIZE, section="Expert").labels
    assert not any("energy" in text or "gap" in text for text in panel)
    assert any(re.fullmatch(r"Box: energy [\d.]+ → [\d.]+, gap \S+", text) for text in expert), expert


def test_no_panel_speaks_of_energy_but_for_experts():
    for tool in addon.registry.TOOLS:
        entry = {
            "name": "Box",
            "energy_before": 2.0,
            "energy_after": 1.0,
            "gap": 0.001,
            "steps": 3,
            "seconds": 1.0,
        }
        entry |= {"facets": 3, "moved": 0.01, "holes": 1, "faces_added": 2, "ridge_edges": 1, "warnings": []}
        entry |= {"segments": 3, "possible": [1, 4], "curves": 2, "psnr": 30.0, "numbers_before": 9}
        entry |= {
            "numbers_after": 4,
            "regions": 2,
            "rms": 0.01,
            "surfaces": [],
            "noise": 0.1,
            "relations": [],
        }
        assert not any("energy" in line or "gap" in line for line in tool.run.lines(entry)), tool.name
        assert tool.run.numbers(entry) == ["Box: energy 2 → 1, gap 0.001"]
