# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that gives faces the materials back that segments took from them."""

import bpy
import numpy as np

from ..blender import mesh_io, selection
from ..blender.selection import Needs
from . import slots

NEEDS = Needs(coordinates=False, selection=False)


def _kept(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The objects that take part and have materials to give back."""
    objects = selection.usable(selection.mesh_objects(context), NEEDS).objects
    return [obj for obj in objects if slots.KEPT in obj.data.attributes]


class RIDGEFORM_OT_restore_materials(bpy.types.Operator):  # noqa: N801
    """Give all faces the materials back that they had before Segment made slots of its own"""

    bl_idname = "ridgeform.restore_materials"
    bl_label = "Restore Materials"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh with materials to give back; the tooltip says why not."""
        reason = selection.reason_disabled(context, NEEDS)
        if reason is None and not _kept(context):
            reason = "No selected mesh has material slots of Segment"
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Give them back, on all faces of each mesh."""
        objects = _kept(context)
        with mesh_io.object_mode():
            for obj in objects:
                slots.give_back(obj.data, np.ones(len(obj.data.polygons), bool))
        which = f'"{objects[0].name}"' if len(objects) == 1 else f"{len(objects)} meshes"
        self.report({"INFO"}, f"Restored the materials of {which}")
        return {"FINISHED"}


def draw_restore(layout: bpy.types.UILayout, _settings: object) -> None:
    """Draw the button where the active mesh has materials to give back."""
    obj = bpy.context.object
    if obj is not None and obj.type == "MESH" and slots.KEPT in obj.data.attributes:
        layout.operator(RIDGEFORM_OT_restore_materials.bl_idname, icon="LOOP_BACK")
