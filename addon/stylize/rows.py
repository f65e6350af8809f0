# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings of stylize are drawn, in the sidebar and in the redo panel alike."""

import bpy


def draw_settings(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw all settings: the sliders, where they act, the last steps and the paper's numbers."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_sliders(layout, settings)
    draw_where(layout, settings, obj)
    draw_last_steps(layout, settings)
    draw_expert(layout, settings)


def draw_sliders(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw steps, strength and sharpness."""
    column = layout.column()
    column.prop(settings, "steps")
    row = column.row()
    row.active = not settings.use_fidelity
    row.prop(settings, "strength", slider=True)
    column.prop(settings, "sharpness", slider=True)


def draw_where(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw the vertex groups and where the result goes."""
    column = layout.column()
    if obj is not None and obj.type == "MESH":
        column.prop_search(settings, "strength_group", obj, "vertex_groups")
        column.prop_search(settings, "ridge_group", obj, "vertex_groups")
    row = column.row()
    row.active = bool(settings.ridge_group)
    row.prop(settings, "avoid_ridges")
    column.prop(settings, "output")


def draw_last_steps(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the optional last steps."""
    column = layout.column()
    column.prop(settings, "keep_volume")
    row = column.row(align=True)
    row.prop(settings, "marks", expand=True)
    row = column.row()
    row.active = bool(settings.marks)
    row.prop(settings, "mark_angle")
    column.prop(settings, "reduce")
    row = column.row()
    row.active = settings.reduce
    row.prop(settings, "reduce_ratio", slider=True)


def draw_expert(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the numbers of the paper and of the solver."""
    column = layout.column()
    column.prop(settings, "use_fidelity")
    paper = column.column()
    paper.active = settings.use_fidelity
    paper.prop(settings, "fidelity")
    paper.prop(settings, "scale")
    for name in ("coupling", "dual", "delaunay", "solver", "tolerance", "max_iterations"):
        column.prop(settings, name)
