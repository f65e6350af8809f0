# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings of diffusion curves are drawn, in the sidebar and in the redo panel alike."""

import bpy


def draw_settings(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw all settings."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_main(layout, settings)
    draw_expert(layout, settings)


def draw_main(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw where colors and regions come from, and how few colors the curves may have."""
    column = layout.column()
    column.prop(settings, "source")
    row = column.row()
    row.active = settings.source == "ATTRIBUTE"
    row.prop(settings, "attribute")
    column.prop(settings, "regions")
    if settings.regions == "ATTRIBUTE":
        column.prop(settings, "region_attribute")
    found = column.column()
    found.active = settings.regions == "COLORS"
    found.prop(settings, "count")
    found.prop(settings, "least_faces")
    column.prop(settings, "color_error")
    column.prop(settings, "rims")
    column.prop(settings, "show")


def draw_expert(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw how the colors of the curves are found."""
    column = layout.column()
    column.prop(settings, "refine")
    column.prop(settings, "fidelity")
