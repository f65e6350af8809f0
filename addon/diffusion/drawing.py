# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors between curves as a color attribute."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..blender import attribute_names, display, mesh_io
from ..blender.welding import Weld
from .sources import SUFFIX


@dataclass
class _Shown:
    """What `display.show` asks for."""

    display: str = "VIEWPORT"
    bands: int = 0


def show(obj: bpy.types.Object, name: str) -> list[str]:
    """Show a color attribute in the viewport; returns notes."""
    with mesh_io.object_mode():
        return display.show([(obj, name)], _Shown())[0]


def write_corners(obj: bpy.types.Object, weld: Weld, corners: np.ndarray, source: str, alpha: float) -> str:
    """Store the colors (l, 3, c) of the corners of welded triangles as a color attribute on face corners.

    There colors may jump from face to face, as they do across a curve. The name is that of the source and
    `SUFFIX`; what has it is written over. Returns the name that Blender gave.
    """
    mesh = obj.data
    name = attribute_names.result_name(source, SUFFIX)
    mesh.calc_loop_triangles()
    places = mesh_io.triangle_corners(mesh)[weld.rows].ravel()
    colors = np.zeros((len(mesh.loops), 4), np.float32)
    colors[:, 3] = alpha
    colors[places, : corners.shape[2]] = corners.reshape(len(places), -1)
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != ("FLOAT_COLOR", "CORNER"):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(name, "FLOAT_COLOR", "CORNER")
    name = attribute.name
    attribute.data.foreach_set("color", colors.ravel())
    mesh.update()
    return name
