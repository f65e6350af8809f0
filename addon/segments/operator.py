# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `ridgeform.segment`."""

import bpy

from ..framework.tool_operator import ToolOperator
from .rows import draw_settings
from .settings import SegmentSettings
from .tool import Segmenting


class RIDGEFORM_OT_segment(SegmentSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Divide meshes, or the selected faces, into the parts that a person would name, along their ridges"""

    bl_idname = "ridgeform.segment"
    bl_label = "Segment"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = Segmenting
    settings = SegmentSettings
    panel = "ridgeform_segment"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_settings(self.layout, self, context.object)
