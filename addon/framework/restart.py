# SPDX-License-Identifier: GPL-3.0-or-later
"""What is there instead of the tools until Blender is started again: a panel that says so."""

import bpy

from . import wheel, wrapping

REASON = wheel.misfit() or ""
"""What is wrong: nothing that changes before Blender is started again."""


class RIDGEFORM_PT_restart(bpy.types.Panel):  # noqa: N801
    """Says that Blender must be started again."""

    bl_label = "Ridgeform"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ridgeform"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the sentence."""
        column = self.layout.column(align=True)
        for line in wrapping.label_lines(context, REASON):
            column.label(text=line)


def register() -> None:
    """Show the panel."""
    print(REASON)
    bpy.utils.register_class(RIDGEFORM_PT_restart)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_class(RIDGEFORM_PT_restart)
