# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators `bpy.ops.ridgeform.*`: thin, over `tools`."""

import bpy

from . import modal, stylize

_CLASSES = (stylize.RIDGEFORM_OT_stylize,)


def register() -> None:
    """Register all operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    modal.register()


def unregister() -> None:
    """Unregister all operators; a job that runs is cancelled first."""
    modal.unregister()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
