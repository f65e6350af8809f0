# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that Blender calls when files, undo steps, or data change."""

from collections.abc import Callable

import bpy


class Handlers:
    """Functions by the name of the list in `bpy.app.handlers` that they belong in."""

    def __init__(self, **calls: Callable[..., None]) -> None:
        """Nothing is called yet."""
        self._calls = [(getattr(bpy.app.handlers, name), call) for name, call in calls.items()]

    def add(self) -> None:
        """Have Blender call them."""
        for handlers, call in self._calls:
            handlers.append(call)

    def remove(self) -> None:
        """Have it call them no more."""
        for handlers, call in self._calls:
            handlers.remove(call)
