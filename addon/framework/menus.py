# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in the Object menu, the Mesh menu and the Export menu."""

import bpy


def _draw(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator("ridgeform.stylize", icon="MOD_DECIM")
    self.layout.operator("ridgeform.segment", icon="MATERIAL")
    self.layout.operator("ridgeform.fill_holes", icon="MESH_GRID")
    self.layout.operator("ridgeform.denoise_attribute", icon="MOD_SMOOTH")
    self.layout.operator("ridgeform.interpolate_attribute", icon="MOD_DATA_TRANSFER")
    self.layout.operator("ridgeform.vibration_modes", icon="MOD_WAVE")
    self.layout.operator("ridgeform.show_attribute", icon="COLOR")
    self.layout.operator("ridgeform.diffusion_curves", icon="CURVE_DATA")
    self.layout.operator("ridgeform.redraw_diffusion_curves", icon="FILE_REFRESH")


def _draw_export(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator("ridgeform.export_diffusion_svg")


def _menus() -> tuple[type, type]:
    return bpy.types.VIEW3D_MT_object, bpy.types.VIEW3D_MT_edit_mesh


def register() -> None:
    """Append the entries."""
    for menu in _menus():
        menu.append(_draw)
    bpy.types.TOPBAR_MT_file_export.append(_draw_export)


def unregister() -> None:
    """Remove the entries."""
    for menu in _menus():
        menu.remove(_draw)
    bpy.types.TOPBAR_MT_file_export.remove(_draw_export)
