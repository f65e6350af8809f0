# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the panel: those that come with the add-on, and the modeler's own."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..settings import SETTING_NAMES

SUBDIRECTORY = "ridgeform/stylize"
# The folder that holds the folder "presets".
_SHIPPED = str(Path(__file__).parents[1])


class RIDGEFORM_MT_stylize_presets(bpy.types.Menu):  # noqa: N801
    """The list of presets."""

    bl_label = "Stylize Presets"
    preset_subdir = SUBDIRECTORY
    preset_operator = "script.execute_preset"
    draw = bpy.types.Menu.draw_preset


class RIDGEFORM_OT_stylize_preset_add(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Save the settings of the panel as a preset, or remove one"""

    bl_idname = "ridgeform.stylize_preset_add"
    bl_label = "Add Stylize Preset"
    preset_menu = "RIDGEFORM_MT_stylize_presets"
    preset_subdir = SUBDIRECTORY
    preset_defines = ["settings = bpy.context.scene.ridgeform_stylize"]
    # Vertex groups belong to one mesh, not to a preset.
    preset_values = [f"settings.{name}" for name in SETTING_NAMES if not name.endswith("_group")]


class RIDGEFORM_PT_stylize_presets(PresetPanel, bpy.types.Panel):  # noqa: N801
    """The popover behind the presets button."""

    bl_label = "Stylize Presets"
    preset_subdir = SUBDIRECTORY
    preset_operator = "script.execute_preset"
    preset_add_operator = "ridgeform.stylize_preset_add"


_CLASSES = (RIDGEFORM_MT_stylize_presets, RIDGEFORM_OT_stylize_preset_add, RIDGEFORM_PT_stylize_presets)


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
