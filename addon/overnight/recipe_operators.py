# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels' settings as a step of a recipe, and the steps of a recipe as the panels' settings."""

from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..framework import former
from ..framework.settings import values_of
from ..framework.sidebar import InTab
from ..framework.tool import Tool
from ..framework.writing import write_text
from . import recipe

_tools: dict[str, Tool] = {}


class _SaveRecipe(ExportHelper):
    """Save the settings of a panel as a step of a recipe, which the command line runs on many files"""

    bl_idname = "ridgeform.save_recipe"
    bl_label = "Save Recipe"
    bl_options = {"INTERNAL"}

    filename_ext: ClassVar[str] = ".toml"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file, whole or not at all."""
        path, tool = Path(bpy.path.abspath(self.filepath)), _tools[self.tool]
        panel = getattr(context.scene, tool.scene_property)
        former.take_given(panel, tool.settings)
        text = recipe.step_text(tool, values_of(tool.settings, panel))
        try:
            if self.append and path.exists():
                recipe.read(path, _tools)
                text = f"{path.read_text(encoding='utf-8').rstrip()}\n\n{text}"
            write_text(path, text)
        except (recipe.RecipeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Saved: ridgeform run {path.name} FILES -o OUT")
        return {"FINISHED"}


class _LoadRecipe(ImportHelper):
    """Give the panels the settings of the steps of a recipe"""

    bl_idname = "ridgeform.load_recipe"
    bl_label = "Load Recipe"
    bl_options = {"UNDO", "INTERNAL"}

    filename_ext: ClassVar[str] = ".toml"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set all settings of each tool that has a step."""
        try:
            steps = recipe.read(Path(bpy.path.abspath(self.filepath)), _tools)
        except recipe.RecipeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for step in steps:
            panel = getattr(context.scene, step.tool.scene_property)
            for name, value in vars(step.settings).items():
                setattr(panel, name, value)
        labels = [step.tool.label for step in steps]
        twice = sorted({label for label in labels if labels.count(label) > 1})
        if twice:
            self.report({"WARNING"}, f"{', '.join(twice)} has several steps: its panel has the last one's")
        else:
            self.report({"INFO"}, f"The panels are set: press {', then '.join(labels)}")
        return {"FINISHED"}


class _RecipePanel(InTab):
    """Mixin for the panel with the two buttons."""

    bl_label = "Recipe"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the buttons."""
        row = self.layout.row(align=True)
        row.operator("ridgeform.save_recipe", text="Save…", icon="FILE_TICK")
        row.operator("ridgeform.load_recipe", text="Load…", icon="FILE_FOLDER")


def classes(tools: Sequence[Tool]) -> list[type]:
    """The operators and the panel, for these tools."""
    _tools.clear()
    _tools.update({tool.command: tool for tool in tools})
    filtered = {"filter_glob": StringProperty(default="*.toml", options={"HIDDEN"})}
    saved = {
        "tool": EnumProperty(
            name="Tool",
            description="The tool whose settings are saved",
            items=tuple((tool.command, tool.panel_label, tool.description) for tool in tools),
        ),
        "append": BoolProperty(
            name="Append",
            description="Add the step at the end of the file, instead of replacing what it has",
        ),
    }
    return [
        _made("RIDGEFORM_OT_save_recipe", _SaveRecipe, bpy.types.Operator, filtered | saved),
        _made("RIDGEFORM_OT_load_recipe", _LoadRecipe, bpy.types.Operator, filtered),
        _made("RIDGEFORM_PT_recipe", _RecipePanel, bpy.types.Panel, {}),
    ]


def _made(name: str, mixin: type, base: type, properties: dict[str, object]) -> type:
    own = {"__module__": __name__, "__doc__": mixin.__doc__, "__annotations__": properties}
    return type(name, (mixin, base), own)
