# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that blends meshes with results that they have as attributes, and its row in the panel."""

import bpy

from ..blender import blending, mesh_io, selection
from ..blender.selection import Needs

NEEDS = Needs(coordinates=False, selection=False)


class RIDGEFORM_OT_blend_result(bpy.types.Operator):  # noqa: N801
    """Add a modifier that blends a mesh with the result of Stylize that it has as an attribute"""

    bl_idname = "ridgeform.blend_result"
    bl_label = "Blend Original and Result"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh with a result; the tooltip says why not."""
        reason = selection.reason_disabled(context, NEEDS)
        if reason is None and not _with_result(context):
            reason = f'No selected mesh has the attribute "{blending.ATTRIBUTE}": stylize with it as Result'
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it to each, before all other modifiers."""
        objects = _with_result(context)
        with mesh_io.object_mode():
            for obj in objects:
                blending.add_modifier(obj)
        which = f'"{objects[0].name}"' if len(objects) == 1 else f"{len(objects)} meshes"
        self.report({"INFO"}, f"{which}: Factor of the modifier blends original and result")
        return {"FINISHED"}


def _with_result(context: bpy.types.Context) -> list[bpy.types.Object]:
    objects = selection.usable(selection.mesh_objects(context), NEEDS).objects
    return [obj for obj in objects if blending.ATTRIBUTE in obj.data.attributes]


def draw_blend(layout: bpy.types.UILayout, _settings: object) -> None:
    """Draw the factor of the active mesh if it is blended, else the button where it has a result."""
    obj = bpy.context.object
    if obj is None or obj.type != "MESH":
        return
    modifier = blending.modifier_of(obj)
    if modifier is not None:
        owner, name = blending.input_of(modifier, blending.FACTOR)
        layout.prop(owner, name, text="Blend", slider=True)
    elif blending.ATTRIBUTE in obj.data.attributes:
        layout.operator(RIDGEFORM_OT_blend_result.bl_idname, icon="GEOMETRY_NODES")
