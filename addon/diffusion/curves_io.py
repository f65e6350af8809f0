# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for diffusion curves: curve objects with colours on both sides.

They are objects of Blender's newer type Curves, poly curves through vertices of the mesh: the points of the
older type Curve have no attributes, in no version. Each point has the attributes `left` and `right`, colours,
and `vertex`, the vertex of the mesh that it stands for. A curve of one point is a colour for that vertex.
"""

from dataclasses import dataclass

import bpy
import numpy as np

LEFT, RIGHT, VERTEX = "left", "right", "vertex"
MARK = "ridgeform_diffusion"
"""The property of the curves that tells them from others: the name of the colours that they stand for."""


class CurvesRefusedError(Exception):
    """Curves that cannot be drawn from; the message says why, and what to do about it."""


@dataclass
class CurvePoints:
    """Curves, point after point."""

    sizes: np.ndarray
    """Points of each curve (q,) int."""
    cyclic: np.ndarray
    """Which curves (q,) bool are closed."""
    vertices: np.ndarray
    """The vertex of the mesh of each point (p,) int."""
    left: np.ndarray
    """Colours (p, 4) on the left."""
    right: np.ndarray
    """Colours (p, 4) on the right."""


def curves_of(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The diffusion curves of a mesh object: its child; `None` if it has none."""
    return next((child for child in obj.children if is_curves(child)), None)


def is_curves(obj: bpy.types.Object | None) -> bool:
    """Whether an object holds diffusion curves."""
    return obj is not None and obj.type == "CURVES" and MARK in obj.data


def write_curves(obj: bpy.types.Object, points: CurvePoints, name: str) -> bpy.types.Object:
    """Store curves for a mesh object: as its child, in place of those of an earlier run."""
    coordinates = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", coordinates)
    data = bpy.data.hair_curves.new(f"{obj.name} Diffusion Curves")
    data[MARK] = name
    if len(points.sizes):
        data.add_curves(points.sizes.tolist())
        places = coordinates.reshape(-1, 3)[points.vertices]
        data.position_data.foreach_set("vector", places.ravel())
        # Setting the attribute behind the type corrupts memory in 4.2 and 5.2, and 4.2 has no other way:
        # there the curves are Catmull-Rom splines, which pass through the same points.
        if hasattr(data, "set_types"):
            data.set_types(type="POLY")
        _store(data, "cyclic", ("BOOLEAN", "CURVE"), points.cyclic)
        _store(data, VERTEX, ("INT", "POINT"), points.vertices.astype(np.int32))
        for side, colors in ((LEFT, points.left), (RIGHT, points.right)):
            _store(data, side, ("FLOAT_COLOR", "POINT"), colors.astype(np.float32).ravel())
        data.attributes.active = data.attributes[LEFT]
    return _child(obj, data)


def _store(data: bpy.types.Curves, name: str, kind: tuple[str, str], values: np.ndarray) -> None:
    attribute = data.attributes.get(name) or data.attributes.new(name, *kind)
    attribute.data.foreach_set("color" if kind[0] == "FLOAT_COLOR" else "value", values)


def _child(obj: bpy.types.Object, data: bpy.types.Curves) -> bpy.types.Object:
    child = curves_of(obj)
    if child is None:
        child = bpy.data.objects.new(data.name, data)
        for collection in obj.users_collection:
            collection.objects.link(child)
        child.parent = obj
    else:
        old = child.data
        child.data = data
        if old.users == 0:
            name = old.name
            bpy.data.hair_curves.remove(old)
            data.name = name
    return child


def read_curves(child: bpy.types.Object, n_vertices: int) -> CurvePoints:
    """The curves of an object, also in Edit Mode; `CurvesRefusedError` unless they fit so many vertices."""
    data = child.data
    n = len(data.points)
    missing = [name for name in (LEFT, RIGHT, VERTEX) if n and name not in data.attributes]
    if missing:
        raise CurvesRefusedError(f'"{child.name}" has no attribute "{missing[0]}": make the curves again')
    vertices = np.zeros(n, np.int32)
    if n:
        data.attributes[VERTEX].data.foreach_get("value", vertices)
    outside = np.flatnonzero((vertices < 0) | (vertices >= n_vertices))
    if len(outside):
        raise CurvesRefusedError(
            f'Point {outside[0]} of "{child.name}" stands for vertex {vertices[outside[0]]}, which the mesh '
            "does not have: the mesh was changed, make the curves again"
        )
    sizes = np.array([curve.points_length for curve in data.curves], np.int64)
    cyclic = np.zeros(len(sizes), bool)
    if "cyclic" in data.attributes:
        data.attributes["cyclic"].data.foreach_get("value", cyclic)
    left, right = (_colors(data, side, n) for side in (LEFT, RIGHT))
    return CurvePoints(sizes, cyclic, vertices, left, right)


def _colors(data: bpy.types.Curves, side: str, n: int) -> np.ndarray:
    values = np.zeros(4 * n, np.float32)
    if n:
        data.attributes[side].data.foreach_get("color", values)
    return values.reshape(-1, 4).astype(np.float64)
