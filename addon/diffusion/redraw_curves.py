# SPDX-License-Identifier: GPL-3.0-or-later
"""Redrawing a mesh from its diffusion curves as they are now: Rowe et al. 2024, eq. (26)."""

import bpy
import ridgeform

from ..blender import mesh_io
from ..framework.surface import Surface, surface_of
from . import curves_io
from .curves_io import CurvePoints
from .drawing import write_corners
from .layout import colored_edges
from .tracing import curves_on_mesh


def read_on_mesh(obj: bpy.types.Object, child: bpy.types.Object) -> tuple[Surface, CurvePoints]:
    """The surface of a mesh object, in Object Mode, and its curves as they are now, on vertices of the mesh.

    The errors are those of `redraw`.
    """
    surface = surface_of(obj)
    return surface, curves_on_mesh(obj, child, surface.weld, surface.mesh)


def redraw(obj: bpy.types.Object, child: bpy.types.Object) -> str:
    """Redraw the colors of a mesh object from its curves as they are now; returns the attribute's name.

    `RefusedError` for a mesh or curves that cannot be used, and the errors of `ridgeform.trace_curves`
    and `ridgeform.redraw`.
    """
    with mesh_io.object_mode():
        surface, points = read_on_mesh(obj, child)
        given = colored_edges(points, surface.weld)
        drawn = ridgeform.redraw(
            surface.mesh,
            given.edges,
            given.left,
            given.right,
            points=given.points,
            point_colors=given.point_colors,
        )
        return write_corners(obj, surface.weld, drawn.corners, child.data[curves_io.MARK], 1.0)
