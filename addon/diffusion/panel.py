# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of diffusion curves, in the sidebar tab "Ridgeform"."""

import bpy

from ..framework import job
from ..framework.sidebar import LAST_RUN_LINES, Sidebar
from . import rows as diffusion_settings
from .settings import DiffusionSettings


class RidgeformDiffusionSettings(DiffusionSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_diffusion`."""


class RIDGEFORM_PT_diffusion(Sidebar, bpy.types.Panel):  # noqa: N801
    """Diffusion curves: find them, redraw from them."""

    bl_label = "Diffusion Curves"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the buttons and what the last run did."""
        settings, layout = context.scene.ridgeform_diffusion, self.split_layout
        diffusion_settings.draw_main(layout, settings)
        layout.operator("ridgeform.diffusion_curves", icon="CURVE_DATA").from_panel = True
        layout.operator("ridgeform.redraw_diffusion_curves", icon="FILE_REFRESH").show = settings.show
        layout.operator("ridgeform.export_diffusion_svg", text="Export SVG", icon="EXPORT")
        column = layout.column(align=True)
        done = [entry for entry in job.last_summary() if "numbers_after" in entry]
        for entry in done[:LAST_RUN_LINES]:
            quality = "exact" if entry["psnr"] is None else f"{entry['psnr']:.1f} dB"
            column.label(text=f"{entry['name']}: {entry['curves']} curves, {quality}", icon="INFO")
            numbers = f"{entry['numbers_after']} numbers instead of {entry['numbers_before']}"
            column.label(text=numbers, icon="BLANK1")


class RIDGEFORM_PT_diffusion_expert(Sidebar, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for diffusion curves."""

    bl_label = "Expert"
    bl_options = {"DEFAULT_CLOSED"}
    bl_parent_id = "RIDGEFORM_PT_diffusion"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how the colors of the curves are found."""
        diffusion_settings.draw_expert(self.split_layout, context.scene.ridgeform_diffusion)


_CLASSES = (RidgeformDiffusionSettings, RIDGEFORM_PT_diffusion, RIDGEFORM_PT_diffusion_expert)


def register() -> None:
    """Register the panels and the settings of the scene."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.ridgeform_diffusion = bpy.props.PointerProperty(type=RidgeformDiffusionSettings)


def unregister() -> None:
    """Unregister the panels and the settings of the scene."""
    del bpy.types.Scene.ridgeform_diffusion
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
