# SPDX-License-Identifier: GPL-3.0-or-later
"""Ridgeform: piecewise flat meshes with crisp ridges, in Blender."""

from . import batch, operators, ui, wheel

_MODULES = (operators, ui, batch)


def register() -> None:
    """Add the operators, the panel, the menu entries and the command to Blender."""
    wheel.check_version()
    for module in _MODULES:
        module.register()


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    for module in reversed(_MODULES):
        module.unregister()
