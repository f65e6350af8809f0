# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators `bpy.ops.ridgeform.*`: thin, over `tools`."""

import bpy

from ..tools.segment import forget
from . import attributes, diffusion, fill_holes, modal, segment, stylize

_CLASSES = (
    stylize.RIDGEFORM_OT_stylize,
    segment.RIDGEFORM_OT_segment,
    fill_holes.RIDGEFORM_OT_fill_holes,
    attributes.RIDGEFORM_OT_denoise_attribute,
    attributes.RIDGEFORM_OT_interpolate_attribute,
    attributes.RIDGEFORM_OT_vibration_modes,
    attributes.RIDGEFORM_OT_show_attribute,
    diffusion.RIDGEFORM_OT_diffusion_curves,
    diffusion.RIDGEFORM_OT_redraw_diffusion_curves,
    diffusion.RIDGEFORM_OT_export_diffusion_svg,
)


def register() -> None:
    """Register all operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    modal.register()


def unregister() -> None:
    """Unregister all operators; a job that runs is cancelled first."""
    modal.unregister()
    forget()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
