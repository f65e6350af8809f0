# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in the Object menu and the Mesh menu."""

from collections.abc import Sequence

import bpy

from .tool import Feature

_entries: list[tuple[str, str]] = []


def _draw(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    for idname, icon in _entries:
        self.layout.operator(idname, icon=icon)


def _menus() -> tuple[type, type]:
    return bpy.types.VIEW3D_MT_object, bpy.types.VIEW3D_MT_edit_mesh


def register(features: Sequence[Feature]) -> None:
    """Append the entries of the features."""
    _entries[:] = [
        entry
        for feature in features
        for entry in [*((tool.idname, tool.icon) for tool in feature.tools), *feature.menu]
    ]
    for menu in _menus():
        menu.append(_draw)


def unregister() -> None:
    """Remove the entries."""
    for menu in _menus():
        menu.remove(_draw)
