# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `ridgeform.stylize`."""

import bpy

from ..framework.tool_operator import ToolOperator
from .rows import draw_settings
from .settings import StylizeSettings
from .tool import Stylization


class RIDGEFORM_OT_stylize(StylizeSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Make the selected meshes piecewise flat, with crisp ridges"""

    bl_idname = "ridgeform.stylize"
    bl_label = "Stylize Flat"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = Stylization
    settings = StylizeSettings
    panel = "ridgeform_stylize"

    def finished(self, context: bpy.types.Context, run: Stylization) -> set[str]:
        """Write the result and report what happened."""
        outcome = super().finished(context, run)
        if outcome == {"FINISHED"}:
            # Redo repeats what was kept, not what was asked for.
            self.steps = max(run.steps_done, 1)
        return outcome

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_settings(self.layout, self, context.object)
