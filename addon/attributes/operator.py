# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators on attributes: denoise, interpolate, vibration modes, show."""

import bpy
from bpy.props import BoolProperty, StringProperty

from ..blender import attribute_io, attribute_names, display, mesh_io, selection
from ..framework.tool_operator import ToolOperator
from .denoise import Denoising
from .interpolate import Interpolation
from .modes import VibrationModes
from .rows import draw_denoise, draw_display, draw_interpolate, draw_modes
from .settings import DenoiseSettings, DisplaySettings, InterpolateSettings, ModesSettings


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


class RIDGEFORM_OT_vibration_modes(ModesSettings, ToolOperator, bpy.types.Operator):  # noqa: N801
    """Store the functions on the surface that bend least, one after the other, as attributes"""

    bl_idname = "ridgeform.vibration_modes"
    bl_label = "Vibration Modes"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    tool = VibrationModes
    settings = ModesSettings
    panel = "ridgeform_modes"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_modes(self.layout, self)


class RIDGEFORM_OT_show_attribute(DisplaySettings, bpy.types.Operator):  # noqa: N801
    """Show an attribute or a vertex group as colours"""

    bl_idname = "ridgeform.show_attribute"
    bl_label = "Show Attribute"
    bl_options = {"REGISTER", "UNDO"}

    attribute: StringProperty(
        name="Attribute",
        description="Attribute or vertex group to show. Empty: the active one",
        search=attribute_names.search_names,
    )
    signed: BoolProperty(
        name="Zero in the Middle",
        description="Negative values in blue, positive ones in red, zero in white",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to show; the tooltip says why not."""
        reason = selection.reason_disabled(context, Denoising.needs)
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Show the attribute of every mesh that has it."""
        objects = selection.usable(selection.mesh_objects(context), Denoising.needs).objects
        with mesh_io.object_mode():
            shown, missing = [], []
            for obj in objects:
                try:
                    name = self.attribute or attribute_names.default_name(obj, ())
                    attribute_io.read_values(obj, name)
                except attribute_names.AttributeRefusedError as refusal:
                    missing.append(str(refusal))
                else:
                    shown.append((obj, name))
            if not shown:
                self.report({"ERROR"}, missing[0])
                return {"CANCELLED"}
            notes = [note for notes in display.show(shown, self, self.signed) for note in notes]
        self.report({"INFO"}, "; ".join([f'Shown: "{shown[0][1]}"', *notes, *missing]))
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "attribute")
        draw_display(layout, self)
        layout.prop(self, "signed")
