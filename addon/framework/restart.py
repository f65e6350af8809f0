# SPDX-License-Identifier: GPL-3.0-or-later
"""What is there instead of the tools until Blender is started again: a panel that says so."""

import textwrap

import bpy

from . import wheel

COLUMNS = 36
"""What a line of the sidebar holds at its usual width."""


class RIDGEFORM_PT_restart(bpy.types.Panel):  # noqa: N801
    """Says that Blender must be started again."""

    bl_label = "Ridgeform"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ridgeform"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the sentence."""
        column = self.layout.column(align=True)
        for line in textwrap.wrap(wheel.misfit() or "Restart Blender.", COLUMNS):
            column.label(text=line)


def register() -> None:
    """Show the panel."""
    print(wheel.misfit())
    bpy.utils.register_class(RIDGEFORM_PT_restart)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_class(RIDGEFORM_PT_restart)
