# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise, interpolate and show attributes; vibration modes."""

from functools import partial

from ..framework.sidebar import ATTRIBUTES
from ..framework.tool import Feature, Tool
from .denoise import Denoising
from .interpolate import Interpolation
from .modes import VibrationModes
from .operator import RIDGEFORM_OT_show_attribute
from .settings import DENOISE_PRESETS, INTERPOLATE_PRESETS

_tool = partial(Tool, page="manual_attributes", group=ATTRIBUTES)

FEATURE = Feature(
    tools=(
        _tool(
            description="Smooth an attribute, color, or vertex group and keep its creases. In Edit Mode, "
            "only the selection",
            icon="MOD_SMOOTH",
            run=Denoising,
            key="denoise",
            presets=DENOISE_PRESETS,
        ),
        _tool(
            description="Spread values of an attribute, color, or vertex group over the mesh, or fill in the "
            "selection",
            icon="MOD_DATA_TRANSFER",
            run=Interpolation,
            key="interpolate",
            presets=INTERPOLATE_PRESETS,
        ),
        _tool(
            description="Store the functions on the surface that bend least, one after the other, as "
            "attributes",
            icon="MOD_WAVE",
            run=VibrationModes,
            key="modes",
        ),
    ),
    operators=(RIDGEFORM_OT_show_attribute,),
    menu=((RIDGEFORM_OT_show_attribute.bl_idname, "COLOR"),),
)
