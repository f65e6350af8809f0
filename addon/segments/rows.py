# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings of segmenting are drawn, in the sidebar and in the redo panel alike."""

import bpy


def draw_settings(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw all settings."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_sliders(layout, settings)
    draw_outputs(layout, settings)
    draw_ridges(layout, settings, obj)
    draw_expert(layout, settings)


def draw_sliders(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw what is segmented, and how finely."""
    column = layout.column()
    column.prop(settings, "source")
    row = column.row()
    row.active = settings.source == "ATTRIBUTE"
    row.prop(settings, "attribute")
    column.prop(settings, "length_weight")
    column.prop(settings, "use_count")
    row = column.row()
    row.active = settings.use_count
    row.prop(settings, "count")


def draw_outputs(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw what is made of the segments."""
    layout.column().prop(settings, "outputs")


def draw_ridges(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw the vertex group that borders follow."""
    column = layout.column()
    if obj is not None and obj.type == "MESH":
        column.prop_search(settings, "ridge_group", obj, "vertex_groups", text="Borders")
    row = column.row()
    row.active = bool(settings.ridge_group)
    row.prop(settings, "avoid_ridges", text="Avoid Borders")


def draw_expert(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the numbers of the paper and of the solver."""
    column = layout.column()
    column.prop(settings, "min_faces")
    column.prop(settings, "method")
    row = column.row()
    row.active = settings.method == "paper"
    row.prop(settings, "cut_threshold", slider=True)
    column.prop(settings, "use_fidelity")
    row = column.row()
    row.active = settings.use_fidelity
    row.prop(settings, "fidelity")
    column.prop(settings, "epsilon_start")
    column.prop(settings, "epsilon_end")
    column.prop(settings, "scale")
    column.prop(settings, "solver")
    column.prop(settings, "max_iterations")
