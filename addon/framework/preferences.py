# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences page: the values that a person wants wherever a scene does not say otherwise.

Each tool's are saved from its panel. Scenes that are opened, and new files, take those for all settings that
they leave at the defaults.
"""

from collections.abc import Sequence

import bpy
from bpy.app.handlers import persistent
from bpy.props import PointerProperty, StringProperty

from . import rows
from .tool import Tool

PACKAGE = __package__.rpartition(".")[0]
"""What Blender knows the add-on by."""

_tools: list[Tool] = []


def preferences_class(tools: Sequence[Tool], groups: dict[str, type]) -> type:
    """The class of the preferences, with a property group for each tool."""
    own = {
        "bl_idname": PACKAGE,
        "__annotations__": {
            tool.scene_property: PointerProperty(type=groups[tool.scene_property]) for tool in tools
        },
        "__module__": __name__,
        "__doc__": "Values that new scenes begin with",
    }
    return type("RidgeformPreferences", (_Page, bpy.types.AddonPreferences), own)


class _Page:
    """Mixin for the page of the preferences."""

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the main settings of each tool."""
        self.layout.label(text="Values where a scene does not say otherwise:")
        for tool in _tools:
            box = rows.split(self.layout.box())
            box.label(text=tool.panel_label, icon=tool.icon)
            rows.draw_section(box, getattr(self, tool.scene_property), tool.settings, "", None)


class RIDGEFORM_OT_save_defaults(bpy.types.Operator):  # noqa: N801
    """Save the values of this panel in the preferences, for new files and other scenes"""

    bl_idname = "ridgeform.save_defaults"
    bl_label = "Save as My Defaults"
    bl_options = {"INTERNAL"}

    tool: StringProperty(name="Tool", description="Name of the tool's operator", options={"HIDDEN"})

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether there are preferences: not where the add-on is no extension."""
        return current() is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Save them, but the names of what belongs to one mesh."""
        tool = next((tool for tool in _tools if tool.name == self.tool), None)
        if tool is None:
            self.report({"ERROR"}, f'There is no tool "{self.tool}"')
            return {"CANCELLED"}
        panel = getattr(context.scene, tool.scene_property)
        saved = getattr(current(), tool.scene_property)
        for name, setting in tool.settings.declared.items():
            if setting.in_presets:
                setattr(saved, name, getattr(panel, name))
        context.preferences.is_dirty = True
        self.report({"INFO"}, f"Saved: new files begin with these values of {tool.panel_label}")
        return {"FINISHED"}


def current() -> bpy.types.AddonPreferences | None:
    """The preferences of the add-on, `None` where it is none that Blender knows."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    return None if addon is None else addon.preferences


@persistent
def _fill_all(*_arguments: object) -> None:
    saved = current()
    if saved is None:
        return
    for scene in bpy.data.scenes:
        if not scene.is_editable:
            continue
        for tool in _tools:
            panel, mine = getattr(scene, tool.scene_property), getattr(saved, tool.scene_property)
            for name in tool.settings.declared:
                if mine.is_property_set(name) and not panel.is_property_set(name):
                    setattr(panel, name, getattr(mine, name))


def register(tools: Sequence[Tool]) -> None:
    """Have scenes that are opened take the saved values."""
    _tools[:] = tools
    bpy.app.handlers.load_post.append(_fill_all)


def unregister() -> None:
    """Have them take them no longer."""
    bpy.app.handlers.load_post.remove(_fill_all)
    _tools.clear()
