# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Fill Holes" of the sidebar tab "Ridgeform"."""

import bpy

from ..framework import job
from ..framework.presets import RIDGEFORM_PT_fill_holes_presets
from ..framework.sidebar import LAST_RUN_LINES, Sidebar
from . import rows as hole_settings
from .settings import HoleSettings


class RidgeformHoleSettings(HoleSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_holes`."""


class RIDGEFORM_PT_fill_holes(Sidebar, bpy.types.Panel):  # noqa: N801
    """Which holes, what the patches are like, and the button."""

    bl_label = "Fill Holes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the presets button."""
        RIDGEFORM_PT_fill_holes_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the button and what the last run did."""
        settings, layout = context.scene.ridgeform_holes, self.split_layout
        hole_settings.draw_choice(layout, settings)
        hole_settings.draw_patch(layout, settings)
        layout.operator("ridgeform.fill_holes", icon="MESH_GRID").from_panel = True
        _draw_last_run(layout)


class RIDGEFORM_PT_fill_holes_expert(Sidebar, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for filling holes."""

    bl_label = "Expert"
    bl_options = {"DEFAULT_CLOSED"}
    bl_parent_id = "RIDGEFORM_PT_fill_holes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the numbers of the paper."""
        hole_settings.draw_expert(self.split_layout, context.scene.ridgeform_holes)


def _draw_last_run(layout: bpy.types.UILayout) -> None:
    column = layout.column(align=True)
    for entry in [entry for entry in job.last_summary() if "holes" in entry][:LAST_RUN_LINES]:
        column.label(
            text=f"{entry['name']}: {entry['holes']} filled, {entry['faces_added']} faces", icon="INFO"
        )
        column.label(text=f"{entry['ridge_edges']} ridge edges, {entry['seconds']:.1f} s", icon="BLANK1")
        for note in entry["warnings"]:
            column.label(text=note, icon="BLANK1")


_CLASSES = (RidgeformHoleSettings, RIDGEFORM_PT_fill_holes, RIDGEFORM_PT_fill_holes_expert)


def register() -> None:
    """Register the panel and the settings of the scene."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.ridgeform_holes = bpy.props.PointerProperty(type=RidgeformHoleSettings)


def unregister() -> None:
    """Unregister the panel and the settings of the scene."""
    del bpy.types.Scene.ridgeform_holes
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
