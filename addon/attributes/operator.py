# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that shows an attribute."""

import bpy

from ..blender import attribute_io, attribute_names, display, mesh_io, selection
from ..blender.refusals import RefusedError
from ..framework import rows
from ..framework.settings import properties_of
from .denoise import Denoising
from .settings import ShowSettings


class RIDGEFORM_OT_show_attribute(bpy.types.Operator):  # noqa: N801
    """Show an attribute or a vertex group as colors"""

    bl_idname = "ridgeform.show_attribute"
    bl_label = "Show Attribute"
    bl_options = {"REGISTER", "UNDO"}
    __annotations__ = properties_of(ShowSettings)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to show; the tooltip says why not."""
        return selection.can_start(cls, selection.reason_disabled(context, Denoising.needs))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Show the attribute of every mesh that has it."""
        objects = selection.usable(selection.mesh_objects(context), Denoising.needs).objects
        with mesh_io.object_mode():
            shown, missing = [], []
            for obj in objects:
                try:
                    name = self.attribute or attribute_names.default_name(obj, ())
                    attribute_io.read_values(obj, name)
                except RefusedError as refusal:
                    missing.append(str(refusal))
                else:
                    shown.append((obj, name))
            if not shown:
                self.report({"ERROR"}, missing[0])
                return {"CANCELLED"}
            notes = [note for notes in display.show(shown, self, self.signed) for note in notes]
        self.report({"INFO"}, "; ".join([f'Shown: "{shown[0][1]}"', *notes, *missing]))
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        rows.draw_all(self.layout, self, ShowSettings, context.object)
