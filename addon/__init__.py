# SPDX-License-Identifier: GPL-3.0-or-later
"""Ridgeform: piecewise flat meshes with crisp ridges, in Blender."""

from .framework import wheel

if wheel.misfit() is None:
    from . import batch, check, job, registry
else:
    # The tools are not even imported: of another module they may want what it does not have.
    from .framework import restart as registry

__all__ = ("batch", "check", "job", "register", "unregister")
"""For scripts: `bl_ext.user_default.ridgeform.job.last_summary()` says what the last run did, `check.last()`
what the last check found, and `batch.main(arguments)` is the batch command."""


def register() -> None:
    """Add the operators, the panels, the menu entries and the command to Blender."""
    registry.register()


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    registry.unregister()
