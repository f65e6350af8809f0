# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion curves in Blender: colors in, curve objects out and in again, colors and drawings out."""

from ..framework.sidebar import ATTRIBUTES
from ..framework.tool import Feature, Tool
from . import operator
from .coloring import RIDGEFORM_OT_color_diffusion_curves
from .tool import DiffusionCurves

FEATURE = Feature(
    tools=(
        Tool(
            description="Find the few curves, with a color on each side, that redraw the painted surface",
            icon="CURVE_DATA",
            run=DiffusionCurves,
            key="diffusion",
            page="manual_diffusion_curves",
            group=ATTRIBUTES,
            draw_more=operator.draw_buttons,
        ),
    ),
    operators=(
        operator.RIDGEFORM_OT_redraw_diffusion_curves,
        RIDGEFORM_OT_color_diffusion_curves,
        operator.RIDGEFORM_OT_export_diffusion_svg,
    ),
    menu=(
        (operator.RIDGEFORM_OT_redraw_diffusion_curves.bl_idname, "FILE_REFRESH"),
        (RIDGEFORM_OT_color_diffusion_curves.bl_idname, "COLOR"),
    ),
    register=operator.register,
    unregister=operator.unregister,
)
