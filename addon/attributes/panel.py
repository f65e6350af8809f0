# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the tools on attributes, in the sidebar tab "Ridgeform"."""

import bpy

from ..framework.presets import RIDGEFORM_PT_denoise_presets, RIDGEFORM_PT_interpolate_presets
from ..framework.sidebar import Sidebar, draw_last_run
from . import rows as attribute_settings
from .settings import DenoiseSettings, InterpolateSettings, ModesSettings


class RidgeformDenoiseSettings(DenoiseSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_denoise`."""


class RidgeformInterpolateSettings(InterpolateSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_interpolate`."""


class RIDGEFORM_PT_denoise(Sidebar, bpy.types.Panel):  # noqa: N801
    """Denoising an attribute."""

    bl_label = "Denoise Attribute"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the presets button."""
        RIDGEFORM_PT_denoise_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the sliders, the button and what the last run did."""
        settings, layout = context.scene.ridgeform_denoise, self.split_layout
        attribute_settings.draw_denoise_sliders(layout, settings)
        attribute_settings.draw_ridges(layout, settings, context.object)
        attribute_settings.draw_result(layout, settings)
        layout.operator("ridgeform.denoise_attribute", icon="MOD_SMOOTH").from_panel = True
        draw_last_run(layout, "denoise_attribute", "iterations")


class RIDGEFORM_PT_interpolate(Sidebar, bpy.types.Panel):  # noqa: N801
    """Interpolating an attribute."""

    bl_label = "Interpolate Attribute"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the presets button."""
        RIDGEFORM_PT_interpolate_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the button and what the last run did."""
        settings, layout = context.scene.ridgeform_interpolate, self.split_layout
        attribute_settings.draw_interpolate_sliders(layout, settings, context.object)
        attribute_settings.draw_ridges(layout, settings, context.object)
        attribute_settings.draw_result(layout, settings)
        layout.operator("ridgeform.interpolate_attribute", icon="MOD_DATA_TRANSFER").from_panel = True
        draw_last_run(layout, "interpolate_attribute", "iterations")


class RidgeformModesSettings(ModesSettings, bpy.types.PropertyGroup):
    """The settings of the panel, saved with the scene as `scene.ridgeform_modes`."""


class RIDGEFORM_PT_modes(Sidebar, bpy.types.Panel):  # noqa: N801
    """Vibration modes."""

    bl_label = "Vibration Modes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the button and what the last run did."""
        settings, layout = context.scene.ridgeform_modes, self.split_layout
        attribute_settings.draw_modes_sliders(layout, settings)
        layout.operator("ridgeform.vibration_modes", icon="MOD_WAVE").from_panel = True
        draw_last_run(layout, "vibration_modes", "modes")


class _ExpertPanel(Sidebar):
    bl_label = "Expert"
    bl_options = {"DEFAULT_CLOSED"}


class RIDGEFORM_PT_denoise_expert(_ExpertPanel, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for denoising."""

    bl_parent_id = "RIDGEFORM_PT_denoise"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the numbers of the paper and of the solver."""
        attribute_settings.draw_expert(self.split_layout, context.scene.ridgeform_denoise)


class RIDGEFORM_PT_interpolate_expert(_ExpertPanel, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for interpolating."""

    bl_parent_id = "RIDGEFORM_PT_interpolate"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the numbers of the paper and of the solver."""
        attribute_settings.draw_expert(self.split_layout, context.scene.ridgeform_interpolate)


class RIDGEFORM_PT_modes_expert(_ExpertPanel, bpy.types.Panel):  # noqa: N801
    """The paper's numbers for vibration modes."""

    bl_parent_id = "RIDGEFORM_PT_modes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choices of the paper and of the solver."""
        attribute_settings.draw_expert(self.split_layout, context.scene.ridgeform_modes)


_CLASSES = (
    RidgeformDenoiseSettings,
    RidgeformInterpolateSettings,
    RidgeformModesSettings,
    RIDGEFORM_PT_denoise,
    RIDGEFORM_PT_interpolate,
    RIDGEFORM_PT_modes,
    RIDGEFORM_PT_denoise_expert,
    RIDGEFORM_PT_interpolate_expert,
    RIDGEFORM_PT_modes_expert,
)
_SETTINGS = {
    "ridgeform_denoise": RidgeformDenoiseSettings,
    "ridgeform_interpolate": RidgeformInterpolateSettings,
    "ridgeform_modes": RidgeformModesSettings,
}


def register() -> None:
    """Register the panels and the settings of the scene."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for name, cls in _SETTINGS.items():
        setattr(bpy.types.Scene, name, bpy.props.PointerProperty(type=cls))


def unregister() -> None:
    """Unregister the panels and the settings of the scene."""
    for name in _SETTINGS:
        delattr(bpy.types.Scene, name)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
