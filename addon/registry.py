# SPDX-License-Identifier: GPL-3.0-or-later
"""The features of the add-on, and how all of it is added to Blender."""

import bpy

from .attributes import operator as attributes
from .attributes import panel as attribute_panel
from .diffusion import operator as diffusion
from .diffusion import panel as diffusion_panel
from .framework import batch, menus, modal, presets
from .holes import operator as holes
from .holes import panel as hole_panel
from .segments import operator as segments
from .segments import panel as segment_panel
from .segments.tool import forget
from .stylize import operator as stylize
from .stylize import panel as stylize_panel

_OPERATORS = (
    stylize.RIDGEFORM_OT_stylize,
    segments.RIDGEFORM_OT_segment,
    holes.RIDGEFORM_OT_fill_holes,
    attributes.RIDGEFORM_OT_denoise_attribute,
    attributes.RIDGEFORM_OT_interpolate_attribute,
    attributes.RIDGEFORM_OT_vibration_modes,
    attributes.RIDGEFORM_OT_show_attribute,
    diffusion.RIDGEFORM_OT_diffusion_curves,
    diffusion.RIDGEFORM_OT_redraw_diffusion_curves,
    diffusion.RIDGEFORM_OT_export_diffusion_svg,
)
_MODULES = (
    modal,
    presets,
    stylize_panel,
    segment_panel,
    hole_panel,
    attribute_panel,
    diffusion_panel,
    menus,
    batch,
)


def register() -> None:
    """Add the operators, the panels, the menu entries and the command to Blender."""
    for cls in _OPERATORS:
        bpy.utils.register_class(cls)
    for module in _MODULES:
        module.register()


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    for module in reversed(_MODULES):
        module.unregister()
    forget()
    for cls in reversed(_OPERATORS):
        bpy.utils.unregister_class(cls)
