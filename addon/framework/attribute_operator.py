# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators share that make something of an attribute which a tool left on meshes."""

from typing import ClassVar

import bpy

from ..blender import mesh_io, selection
from ..blender.selection import Needs

NEEDS = Needs(coordinates=False, selection=False)


class OnAttribute:
    """Mixin for an operator on all selected meshes that have the attribute."""

    attribute: ClassVar[str]
    missing: ClassVar[str]
    """What the tooltip says where no mesh has it."""
    done: ClassVar[str]
    """What is reported, with {} for the meshes."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is such a mesh; the tooltip says why not."""
        reason = selection.reason_disabled(context, NEEDS)
        if reason is None and not cls._having(context):
            reason = cls.missing
        return selection.can_start(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it to each of them."""
        objects = self._having(context)
        with mesh_io.object_mode():
            for obj in objects:
                self.work_on(obj)
        which = f'"{objects[0].name}"' if len(objects) == 1 else f"{len(objects)} meshes"
        self.report({"INFO"}, self.done.format(which))
        return {"FINISHED"}

    def work_on(self, obj: bpy.types.Object) -> None:
        """Do it to one mesh, in Object Mode."""
        raise NotImplementedError

    @classmethod
    def _having(cls, context: bpy.types.Context) -> list[bpy.types.Object]:
        objects = selection.usable(selection.mesh_objects(context), NEEDS).objects
        return [obj for obj in objects if cls.attribute in obj.data.attributes]
