# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators `ridgeform.denoise_attribute` and `ridgeform.interpolate_attribute`."""

import bpy

from ..attribute_settings import DenoiseSettings, InterpolateSettings
from ..tools.denoise import Denoising
from ..tools.interpolate import Interpolation
from ..ui.attribute_settings import draw_denoise, draw_interpolate
from .tool_operator import ToolOperator


class RIDGEFORM_OT_denoise_attribute(DenoiseSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Smooth an attribute, a colour or a vertex group and keep its creases; the selection in Edit Mode"""

    bl_idname = "ridgeform.denoise_attribute"
    bl_label = "Denoise Attribute"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = Denoising
    settings = DenoiseSettings
    panel = "ridgeform_denoise"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_denoise(self.layout, self, context.object)


class RIDGEFORM_OT_interpolate_attribute(InterpolateSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Spread values of an attribute, a colour or a vertex group over the mesh, or fill in the selection"""

    bl_idname = "ridgeform.interpolate_attribute"
    bl_label = "Interpolate Attribute"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = Interpolation
    settings = InterpolateSettings
    panel = "ridgeform_interpolate"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_interpolate(self.layout, self, context.object)
