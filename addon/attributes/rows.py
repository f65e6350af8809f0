# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings of the tools on attributes are drawn, in the sidebar and in the redo panel alike."""

import bpy

from .settings import EXTRINSIC, OURS, QUADRATIC


def draw_denoise(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw all settings of denoising."""
    _split(layout)
    draw_denoise_sliders(layout, settings)
    draw_ridges(layout, settings, obj)
    draw_result(layout, settings)
    draw_expert(layout, settings)


def draw_interpolate(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw all settings of interpolating."""
    _split(layout)
    draw_interpolate_sliders(layout, settings, obj)
    draw_ridges(layout, settings, obj)
    draw_result(layout, settings)
    draw_expert(layout, settings)


def _split(layout: bpy.types.UILayout) -> None:
    layout.use_property_split = True
    layout.use_property_decorate = False


def draw_denoise_sliders(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw attribute, strength and sharpness."""
    column = layout.column()
    column.prop(settings, "attribute")
    row = column.row()
    row.active = not settings.use_fidelity
    row.prop(settings, "strength", slider=True)
    _draw_energy(column, settings)


def draw_interpolate_sliders(
    layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None
) -> None:
    """Draw attribute, what is known, and sharpness."""
    column = layout.column()
    column.prop(settings, "attribute")
    column.prop(settings, "known")
    if settings.known == "GROUP" and obj is not None and obj.type == "MESH":
        column.prop_search(settings, "known_group", obj, "vertex_groups")
    _draw_energy(column, settings)


def _draw_energy(layout: bpy.types.UILayout, settings: object) -> None:
    layout.prop(settings, "energy")
    row = layout.row()
    row.active = settings.energy == OURS
    row.prop(settings, "sharpness", slider=True)


def draw_ridges(layout: bpy.types.UILayout, settings: object, obj: bpy.types.Object | None) -> None:
    """Draw the vertex group of the ridges."""
    column = layout.column()
    if obj is not None and obj.type == "MESH":
        column.prop_search(settings, "ridge_group", obj, "vertex_groups")
    row = column.row()
    row.active = bool(settings.ridge_group)
    row.prop(settings, "avoid_ridges")


def draw_result(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw where the result goes, and how it is shown."""
    column = layout.column()
    column.prop(settings, "output")
    draw_display(column, settings)


def draw_display(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw how a result is shown."""
    layout.prop(settings, "display")
    row = layout.row()
    row.active = settings.display == "MATERIAL"
    row.prop(settings, "bands")


def draw_expert(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the numbers of the paper and of the solver."""
    column = layout.column()
    if hasattr(settings, "use_fidelity"):
        column.prop(settings, "use_fidelity")
        row = column.row()
        row.active = settings.use_fidelity
        row.prop(settings, "fidelity")
    if hasattr(settings, "sharpness"):
        column.prop(settings, "coupling")
    row = column.row()
    row.active = settings.energy == OURS
    row.prop(settings, "dual")
    row = column.row()
    row.active = settings.energy not in EXTRINSIC
    row.prop(settings, "delaunay")
    row = column.row()
    row.active = settings.energy not in QUADRATIC
    row.prop(settings, "solver")
    column.prop(settings, "tolerance")
    column.prop(settings, "max_iterations")


def draw_modes(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw all settings of vibration modes."""
    _split(layout)
    draw_modes_sliders(layout, settings)
    draw_expert(layout, settings)


def draw_modes_sliders(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw how many modes there are, their energy, and how they are shown."""
    column = layout.column()
    column.prop(settings, "count")
    column.prop(settings, "energy")
    column.prop(settings, "shown")
    draw_display(column, settings)
