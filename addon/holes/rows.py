# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings of Fill Holes are drawn, in the sidebar and in the redo panel alike."""

import bpy


def draw_settings(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw all settings."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_choice(layout, settings)
    draw_patch(layout, settings)
    draw_expert(layout, settings)


def draw_choice(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw which holes are filled."""
    column = layout.column()
    column.prop(settings, "max_edges")
    column.prop(settings, "outer")


def draw_patch(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw what the patches are like."""
    column = layout.column()
    column.prop(settings, "shape")
    row = column.row()
    row.active = settings.shape == "SHARP"
    row.prop(settings, "sharpness", slider=True)
    column.prop(settings, "edge_length")
    column.prop(settings, "material")
    row = column.row(align=True)
    row.prop(settings, "marks", expand=True)


def draw_expert(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the numbers of the paper."""
    column = layout.column()
    for name in ("iterations", "fidelity", "coupling"):
        column.prop(settings, name)
