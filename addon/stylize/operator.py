# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that blends meshes with results that they have as attributes, and its row in the panel."""

import bpy

from ..blender import blending
from ..framework.attribute_operator import OnAttribute


class RIDGEFORM_OT_blend_result(OnAttribute, bpy.types.Operator):  # noqa: N801
    """Add a modifier that blends a mesh with the result of Stylize that it has as an attribute"""

    bl_idname = "ridgeform.blend_result"
    bl_label = "Blend Original and Result"
    bl_options = {"REGISTER", "UNDO"}

    attribute = blending.ATTRIBUTE
    missing = f'No selected mesh has the attribute "{blending.ATTRIBUTE}": stylize with it as Result'
    done = "{}: Factor of the modifier blends original and result"

    def work_on(self, obj: bpy.types.Object) -> None:
        """Add it, before all other modifiers."""
        blending.add_modifier(obj)


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
