# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the panels: those that come with the tools, as data, and the modeler's own.

The latter are files in `presets/ridgeform/<key>` of the user's scripts, written and run by Blender.
"""

from typing import ClassVar

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import StringProperty

from .tool import Tool


def preset_folder(tool: Tool) -> str:
    """Where Blender looks for presets of a tool."""
    return f"ridgeform/{tool.key}"


def stored_names(tool: Tool) -> list[str]:
    """The settings that a preset stores: not the names of things that belong to one mesh."""
    return [name for name, setting in tool.settings.declared.items() if setting.in_presets]


class RIDGEFORM_OT_shipped_preset(bpy.types.Operator):  # noqa: N801
    """Set the settings of the panel to those of a preset"""

    bl_idname = "ridgeform.shipped_preset"
    bl_label = "Apply Preset"
    bl_options = {"INTERNAL"}

    tool: StringProperty(name="Tool", description="Name of the tool's operator", options={"HIDDEN"})
    preset: StringProperty(name="Preset", description="Name of the preset", options={"HIDDEN"})

    # What typing is given it keeps: no class of ours, or Blender 4.2 as a module crashes when Python ends.
    tools: ClassVar[dict] = {}
    """The tools with presets, by name."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set what the preset sets."""
        tool = self.tools.get(self.tool)
        if tool is None or self.preset not in tool.presets:
            self.report({"ERROR"}, f'"{self.tool}" has no preset "{self.preset}"')
            return {"CANCELLED"}
        settings = getattr(context.scene, tool.scene_property)
        for name, value in tool.preset_values(self.preset).items():
            setattr(settings, name, value)
        # As Blender does it for presets that are files.
        getattr(bpy.types, tool.presets_menu).bl_label = self.preset
        return {"FINISHED"}


class _PresetList:
    """Mixin for a menu or a popover with the presets of a tool."""

    tool: ClassVar[object]
    path_menu = bpy.types.Menu.path_menu

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the shipped presets, then the modeler's."""
        layout, tool = self.layout, self.tool
        if isinstance(self, bpy.types.Panel):
            layout.emboss = "PULLDOWN_MENU"
        layout.operator_context = "EXEC_DEFAULT"
        column = layout.column(align=True)
        for name in tool.presets:
            entry = column.operator(RIDGEFORM_OT_shipped_preset.bl_idname, text=name)
            entry.tool, entry.preset = tool.name, name
        entry = column.operator("ridgeform.save_defaults", icon="PREFERENCES")
        entry.tool = tool.name
        folders = bpy.utils.preset_paths(preset_folder(tool))
        self.path_menu(
            # Without any folder Blender would say that paths are missing.
            folders or [bpy.app.tempdir],
            "script.execute_preset",
            filter_ext=lambda extension: bool(folders) and extension.lower() == ".py",
            add_operator=None if isinstance(self, bpy.types.Menu) else _add_idname(tool),
            display_name=lambda name: bpy.path.display_name(name, title_case=False),
        )


class _AddPreset(AddPresetBase):
    """Save the settings of the panel as a preset, or remove one"""

    tool: ClassVar[object]

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Save or remove, but keep the names of shipped presets to these."""
        shipped = {self.as_filename(name) for name in self.tool.presets}
        if not (self.remove_name or self.remove_active) and self.as_filename(self.name) in shipped:
            self.report({"WARNING"}, f'Cannot create preset "{self.name}", as the name already exists')
            return {"CANCELLED"}
        return super().execute(context)


def preset_classes(tool: Tool) -> list[type]:
    """The menu, the operator that adds and removes, and the popover of a tool's presets."""
    label = f"{tool.panel_label} Presets"
    menu = tool.presets_menu
    listed = {"__module__": __name__, "bl_label": label, "tool": tool}
    # Blender gives what it runs the class of the popover, too: it changes the label.
    popover = listed | {"bl_space_type": "PROPERTIES", "bl_region_type": "HEADER"}
    add = {
        "__module__": __name__,
        "__doc__": _AddPreset.__doc__,
        "bl_idname": _add_idname(tool),
        "bl_label": f"Add {tool.panel_label} Preset",
        "tool": tool,
        "preset_menu": menu,
        "preset_subdir": preset_folder(tool),
        "preset_defines": [f"settings = bpy.context.scene.{tool.scene_property}"],
        "preset_values": [f"settings.{name}" for name in stored_names(tool)],
    }
    return [
        type(menu, (_PresetList, bpy.types.Menu), listed),
        type(f"RIDGEFORM_OT_{tool.key}_preset_add", (_AddPreset, bpy.types.Operator), add),
        type(f"RIDGEFORM_PT_{tool.key}_presets", (_PresetList, bpy.types.Panel), popover),
    ]


def _add_idname(tool: Tool) -> str:
    return f"ridgeform.{tool.key}_preset_add"


def offer(tools: list[Tool]) -> None:
    """Take the tools whose shipped presets can be applied."""
    RIDGEFORM_OT_shipped_preset.tools.clear()
    RIDGEFORM_OT_shipped_preset.tools.update({tool.name: tool for tool in tools if tool.presets is not None})
