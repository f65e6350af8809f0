# SPDX-License-Identifier: GPL-3.0-or-later
"""How often Blender draws its 3D views."""

import bpy


class Redraws:
    """Counts how often a 3D view is drawn, until it is ended."""

    def __init__(self) -> None:
        """Begin to count."""
        self.count = 0
        self._handle: object | None = bpy.types.SpaceView3D.draw_handler_add(
            self._drawn, (), "WINDOW", "POST_PIXEL"
        )

    def _drawn(self) -> None:
        self.count += 1

    def end(self) -> None:
        """Count no longer; a second call does nothing."""
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None
