# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Stylize" of the sidebar tab "Ridgeform"."""

import bpy

from ..framework.presets import RIDGEFORM_PT_stylize_presets
from ..framework.sidebar import Sidebar, draw_last_run
from . import rows as stylize_settings
from .settings import StylizeSettings


class RidgeformStylizeSettings(StylizeSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_stylize`."""


class RIDGEFORM_PT_stylize(Sidebar, bpy.types.Panel):  # noqa: N801
    """Sliders and the button."""

    bl_label = "Stylize"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the presets button."""
        RIDGEFORM_PT_stylize_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the sliders, the button and what the last run did."""
        settings = context.scene.ridgeform_stylize
        layout = self.split_layout
        stylize_settings.draw_sliders(layout, settings)
        row = layout.row()
        row.scale_y = 1.4
        row.operator("ridgeform.stylize", icon="MOD_DECIM").from_panel = True
        draw_last_run(layout, "stylize", "steps")


class _SubPanel(Sidebar):
    bl_parent_id = "RIDGEFORM_PT_stylize"
    bl_options = {"DEFAULT_CLOSED"}


class RIDGEFORM_PT_stylize_where(_SubPanel, bpy.types.Panel):  # noqa: N801
    """Vertex groups and result."""

    bl_label = "Where"
    bl_options = set()

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the vertex groups and the kind of result."""
        stylize_settings.draw_where(self.split_layout, context.scene.ridgeform_stylize, context.object)


class RIDGEFORM_PT_stylize_last_steps(_SubPanel, bpy.types.Panel):  # noqa: N801
    """Optional last steps."""

    bl_label = "Last Steps"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the switches of the last steps."""
        stylize_settings.draw_last_steps(self.split_layout, context.scene.ridgeform_stylize)


class RIDGEFORM_PT_stylize_expert(_SubPanel, bpy.types.Panel):  # noqa: N801
    """The paper's numbers."""

    bl_label = "Expert"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the numbers of the paper and of the solver."""
        stylize_settings.draw_expert(self.split_layout, context.scene.ridgeform_stylize)


_CLASSES = (
    RidgeformStylizeSettings,
    RIDGEFORM_PT_stylize,
    RIDGEFORM_PT_stylize_where,
    RIDGEFORM_PT_stylize_last_steps,
    RIDGEFORM_PT_stylize_expert,
)


def register() -> None:
    """Register the panels and the settings of the scene."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.ridgeform_stylize = bpy.props.PointerProperty(type=RidgeformStylizeSettings)


def unregister() -> None:
    """Unregister the panels and the settings of the scene."""
    del bpy.types.Scene.ridgeform_stylize
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
