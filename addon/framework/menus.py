# SPDX-License-Identifier: GPL-3.0-or-later
"""The submenu "Ridgeform" of the Object menu and the Mesh menu."""

from collections.abc import Sequence

import bpy

from .tool import Feature

_entries: list[tuple[str, str, str]] = []


class RIDGEFORM_MT_tools(bpy.types.Menu):  # noqa: N801
    """All tools; the search finds them by the words here, too"""

    bl_idname = "RIDGEFORM_MT_tools"
    bl_label = "Ridgeform"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the entries."""
        for idname, text, icon in _entries:
            self.layout.operator(idname, text=text, icon=icon)


def _draw(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(RIDGEFORM_MT_tools.bl_idname, icon="MOD_DECIM")


def _menus() -> tuple[type, type]:
    return bpy.types.VIEW3D_MT_object, bpy.types.VIEW3D_MT_edit_mesh


def register(features: Sequence[Feature]) -> None:
    """Append the submenu, with an entry for all that the features have."""
    operators = {cls.bl_idname: cls.bl_label for feature in features for cls in feature.operators}
    _entries[:] = [
        entry
        for feature in features
        for entry in [
            *((tool.idname, tool.menu_text, tool.icon) for tool in feature.tools),
            *((idname, operators[idname], icon) for idname, icon in feature.menu),
        ]
    ]
    for menu in _menus():
        menu.append(_draw)


def unregister() -> None:
    """Remove it."""
    for menu in _menus():
        menu.remove(_draw)
