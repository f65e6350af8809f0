# SPDX-License-Identifier: GPL-3.0-or-later
"""Stylize: the flow on each mesh, then what is made of the result."""

from ..framework.tool import Feature, Tool
from .operator import RIDGEFORM_OT_blend_result, draw_blend
from .settings import PRESETS
from .tool import Stylization

FEATURE = Feature(
    tools=(
        Tool(
            label="Stylize Flat",
            description="Make the selected meshes piecewise flat, with crisp ridges",
            icon="MOD_DECIM",
            run=Stylization,
            title="Stylize",
            prominent=True,
            finds="Planar, Low Poly",
            stays_bound=True,
            presets=PRESETS,
            draw_more=draw_blend,
        ),
    ),
    operators=(RIDGEFORM_OT_blend_result,),
    menu=((RIDGEFORM_OT_blend_result.bl_idname, "GEOMETRY_NODES"),),
)
