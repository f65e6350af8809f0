# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `ridgeform.fill_holes`."""

import bpy

from ..framework.tool_operator import ToolOperator
from .rows import draw_settings
from .settings import HoleSettings
from .tool import HoleFilling


class RIDGEFORM_OT_fill_holes(HoleSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Fill holes and bring back the ridges that end there; in Edit Mode those with a selected border edge"""

    bl_idname = "ridgeform.fill_holes"
    bl_label = "Fill Holes"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = HoleFilling
    settings = HoleSettings
    panel = "ridgeform_holes"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_settings(self.layout, self)
