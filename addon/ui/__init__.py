# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab, the menu entries and the presets."""

from . import attribute_panel, diffusion_panel, hole_panel, menus, presets, segment_panel, stylize_panel

_MODULES = (presets, stylize_panel, segment_panel, hole_panel, attribute_panel, diffusion_panel, menus)


def register() -> None:
    """Add everything to Blender's interface."""
    for module in _MODULES:
        module.register()


def unregister() -> None:
    """Take everything out of Blender's interface again."""
    for module in reversed(_MODULES):
        module.unregister()
