# SPDX-License-Identifier: GPL-3.0-or-later
"""Ridgeform: piecewise flat meshes with crisp ridges, in Blender."""

from . import check, registry
from .framework import job, wheel

__all__ = ("check", "job", "register", "unregister")
"""For scripts: `bl_ext.user_default.ridgeform.job.last_summary()` says what the last run did, `check.last()`
what the last check found."""


def register() -> None:
    """Add the operators, the panels, the menu entries and the command to Blender."""
    wheel.check_version()
    registry.register()


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    registry.unregister()
