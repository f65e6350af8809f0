# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Segment" of the sidebar tab "Ridgeform"."""

import bpy

from ..framework import job
from ..framework.presets import RIDGEFORM_PT_segment_presets
from ..framework.sidebar import LAST_RUN_LINES, Sidebar
from . import rows as segment_settings
from .settings import SegmentSettings


class RidgeformSegmentSettings(SegmentSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_segment`."""


class RIDGEFORM_PT_segment(Sidebar, bpy.types.Panel):  # noqa: N801
    """What is segmented, how finely, what is made of it, and the button."""

    bl_label = "Segment"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the presets button."""
        RIDGEFORM_PT_segment_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the button and what the last run did."""
        settings, layout = context.scene.ridgeform_segment, self.split_layout
        segment_settings.draw_sliders(layout, settings)
        segment_settings.draw_outputs(layout, settings)
        segment_settings.draw_ridges(layout, settings, context.object)
        layout.operator("ridgeform.segment", icon="MATERIAL").from_panel = True
        _draw_last_run(layout)


class RIDGEFORM_PT_segment_expert(Sidebar, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for segmenting."""

    bl_label = "Expert"
    bl_options = {"DEFAULT_CLOSED"}
    bl_parent_id = "RIDGEFORM_PT_segment"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the numbers of the paper and of the solver."""
        segment_settings.draw_expert(self.split_layout, context.scene.ridgeform_segment)


def _draw_last_run(layout: bpy.types.UILayout) -> None:
    column = layout.column(align=True)
    for entry in [entry for entry in job.last_summary() if "segments" in entry][:LAST_RUN_LINES]:
        fewest, most = entry["possible"]
        column.label(text=f"{entry['name']}: {entry['segments']} segments", icon="INFO")
        column.label(text=f"{fewest} to {most} are possible, {entry['seconds']:.1f} s", icon="BLANK1")
        for note in entry["warnings"]:
            column.label(text=note, icon="BLANK1")


_CLASSES = (RidgeformSegmentSettings, RIDGEFORM_PT_segment, RIDGEFORM_PT_segment_expert)


def register() -> None:
    """Register the panel and the settings of the scene."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.ridgeform_segment = bpy.props.PointerProperty(type=RidgeformSegmentSettings)


def unregister() -> None:
    """Unregister the panel and the settings of the scene."""
    del bpy.types.Scene.ridgeform_segment
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
