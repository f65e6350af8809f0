# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that gives faces the materials back that segments took from them."""

import bpy
import numpy as np

from ..framework.attribute_operator import OnAttribute
from . import slots


class RIDGEFORM_OT_restore_materials(OnAttribute, bpy.types.Operator):  # noqa: N801
    """Give all faces the materials back that they had before Segment made slots of its own"""

    bl_idname = "ridgeform.restore_materials"
    bl_label = "Restore Materials"
    bl_options = {"REGISTER", "UNDO"}

    attribute = slots.KEPT
    missing = "No selected mesh has material slots of Segment"
    done = "Restored the materials of {}"

    def work_on(self, obj: bpy.types.Object) -> None:
        """Give them back, on all faces."""
        slots.give_back(obj.data, np.ones(len(obj.data.polygons), bool))


def draw_restore(layout: bpy.types.UILayout, _settings: object) -> None:
    """Draw the button where the active mesh has materials to give back."""
    obj = bpy.context.object
    if obj is not None and obj.type == "MESH" and slots.KEPT in obj.data.attributes:
        layout.operator(RIDGEFORM_OT_restore_materials.bl_idname, icon="LOOP_BACK")
