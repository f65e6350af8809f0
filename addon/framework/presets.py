# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the panels: those that come with the add-on, and the modeler's own."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..attributes.settings import DenoiseSettings, InterpolateSettings
from ..holes.settings import HoleSettings
from ..segments.settings import SegmentSettings
from ..stylize.settings import StylizeSettings
from .shared_settings import setting_names

# The folder that holds the folder "presets".
_SHIPPED = str(Path(__file__).parents[1])


def _preset_values(settings: type) -> list[str]:
    """What a preset stores: all but the names of vertex groups and attributes, which belong to one mesh."""
    names = (name for name in setting_names(settings) if not name.endswith(("_group", "attribute")))
    return [f"settings.{name}" for name in names]


class _PresetMenu:
    preset_operator = "script.execute_preset"
    draw = bpy.types.Menu.draw_preset


class RIDGEFORM_MT_stylize_presets(_PresetMenu, bpy.types.Menu):  # noqa: N801
    """The list of presets of stylize."""

    bl_label = "Stylize Presets"
    preset_subdir = "ridgeform/stylize"


class RIDGEFORM_MT_segment_presets(_PresetMenu, bpy.types.Menu):  # noqa: N801
    """The list of presets of segmenting."""

    bl_label = "Segment Presets"
    preset_subdir = "ridgeform/segment"


class RIDGEFORM_MT_denoise_presets(_PresetMenu, bpy.types.Menu):  # noqa: N801
    """The list of presets of denoising."""

    bl_label = "Denoise Presets"
    preset_subdir = "ridgeform/denoise"


class RIDGEFORM_MT_interpolate_presets(_PresetMenu, bpy.types.Menu):  # noqa: N801
    """The list of presets of interpolating."""

    bl_label = "Interpolate Presets"
    preset_subdir = "ridgeform/interpolate"


class RIDGEFORM_MT_fill_holes_presets(_PresetMenu, bpy.types.Menu):  # noqa: N801
    """The list of presets of filling holes."""

    bl_label = "Fill Holes Presets"
    preset_subdir = "ridgeform/fill_holes"


class RIDGEFORM_OT_stylize_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.stylize_preset_add"
    bl_label = "Add Stylize Preset"
    preset_menu = "RIDGEFORM_MT_stylize_presets"
    preset_subdir = "ridgeform/stylize"
    preset_defines = ["settings = bpy.context.scene.ridgeform_stylize"]
    preset_values = _preset_values(StylizeSettings)


class RIDGEFORM_OT_segment_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.segment_preset_add"
    bl_label = "Add Segment Preset"
    preset_menu = "RIDGEFORM_MT_segment_presets"
    preset_subdir = "ridgeform/segment"
    preset_defines = ["settings = bpy.context.scene.ridgeform_segment"]
    preset_values = _preset_values(SegmentSettings)


class RIDGEFORM_OT_denoise_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.denoise_preset_add"
    bl_label = "Add Denoise Preset"
    preset_menu = "RIDGEFORM_MT_denoise_presets"
    preset_subdir = "ridgeform/denoise"
    preset_defines = ["settings = bpy.context.scene.ridgeform_denoise"]
    preset_values = _preset_values(DenoiseSettings)


class RIDGEFORM_OT_interpolate_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.interpolate_preset_add"
    bl_label = "Add Interpolate Preset"
    preset_menu = "RIDGEFORM_MT_interpolate_presets"
    preset_subdir = "ridgeform/interpolate"
    preset_defines = ["settings = bpy.context.scene.ridgeform_interpolate"]
    preset_values = _preset_values(InterpolateSettings)


class RIDGEFORM_OT_fill_holes_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.fill_holes_preset_add"
    bl_label = "Add Fill Holes Preset"
    preset_menu = "RIDGEFORM_MT_fill_holes_presets"
    preset_subdir = "ridgeform/fill_holes"
    preset_defines = ["settings = bpy.context.scene.ridgeform_holes"]
    preset_values = _preset_values(HoleSettings)


class RIDGEFORM_PT_stylize_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button of stylize."""

    bl_label = "Stylize Presets"
    preset_subdir = "ridgeform/stylize"
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.stylize_preset_add"


class RIDGEFORM_PT_segment_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button of segmenting."""

    bl_label = "Segment Presets"
    preset_subdir = "ridgeform/segment"
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.segment_preset_add"


class RIDGEFORM_PT_denoise_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button of denoising."""

    bl_label = "Denoise Presets"
    preset_subdir = "ridgeform/denoise"
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.denoise_preset_add"


class RIDGEFORM_PT_interpolate_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button of interpolating."""

    bl_label = "Interpolate Presets"
    preset_subdir = "ridgeform/interpolate"
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.interpolate_preset_add"


class RIDGEFORM_PT_fill_holes_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button of filling holes."""

    bl_label = "Fill Holes Presets"
    preset_subdir = "ridgeform/fill_holes"
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.fill_holes_preset_add"


_CLASSES = (
    RIDGEFORM_MT_stylize_presets,
    RIDGEFORM_MT_segment_presets,
    RIDGEFORM_MT_denoise_presets,
    RIDGEFORM_MT_interpolate_presets,
    RIDGEFORM_MT_fill_holes_presets,
    RIDGEFORM_OT_stylize_preset_add,
    RIDGEFORM_OT_segment_preset_add,
    RIDGEFORM_OT_denoise_preset_add,
    RIDGEFORM_OT_interpolate_preset_add,
    RIDGEFORM_OT_fill_holes_preset_add,
    RIDGEFORM_PT_stylize_presets,
    RIDGEFORM_PT_segment_presets,
    RIDGEFORM_PT_denoise_presets,
    RIDGEFORM_PT_interpolate_presets,
    RIDGEFORM_PT_fill_holes_presets,
)


def register() -> None:
    """Register the presets and where the shipped ones are."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.utils.register_preset_path(_SHIPPED)


def unregister() -> None:
    """Unregister the presets."""
    bpy.utils.unregister_preset_path(_SHIPPED)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
