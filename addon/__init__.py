# SPDX-License-Identifier: GPL-3.0-or-later
"""Ridgeform: piecewise flat meshes with crisp ridges, in Blender."""

from . import registry
from .framework import wheel


def register() -> None:
    """Add the operators, the panels, the menu entries and the command to Blender."""
    wheel.check_version()
    registry.register()


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    registry.unregister()
