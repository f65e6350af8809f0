# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for diffusion curves: curve objects with colors on both sides.

They are objects of Blender's newer type Curves, poly curves through vertices of the mesh: the points of the
older type Curve have no attributes, in no version. Each point has the attributes `left` and `right`, colors,
and `offset`, how far from its vertex it is drawn. A curve of one point is a color for the vertex there.
"""

from dataclasses import dataclass

import bpy
import numpy as np

LEFT, RIGHT, OFFSET = "left", "right", "offset"
MARK = "ridgeform_diffusion"
"""The property of the curves that tells them from others: the name of the colors that they stand for."""


@dataclass
class CurvePoints:
    """Curves through vertices of a mesh, point after point."""

    sizes: np.ndarray
    """Points of each curve (q,) int."""
    cyclic: np.ndarray
    """Which curves (q,) bool are closed."""
    vertices: np.ndarray
    """The vertex of the mesh of each point (p,) int."""
    left: np.ndarray
    """Colors (p, 4) on the left."""
    right: np.ndarray
    """Colors (p, 4) on the right."""
    offsets: np.ndarray
    """Where each point is drawn, from its vertex (p, 3): without the teeth of the mesh's edges."""


@dataclass
class DrawnCurves:
    """Curves as they were left by hand, point after point: anywhere near the mesh."""

    sizes: np.ndarray
    """Points of each curve (q,) int."""
    cyclic: np.ndarray
    """Which curves (q,) bool are closed."""
    places: np.ndarray
    """Where each point is (p, 3), in the space of the mesh, less its offset: at a vertex if unmoved."""
    left: np.ndarray
    """Colors (p, 4) on the left."""
    right: np.ndarray
    """Colors (p, 4) on the right."""


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
        places = (coordinates.reshape(-1, 3)[points.vertices] + points.offsets).astype(np.float32)
        data.position_data.foreach_set("vector", places.ravel())
        # Setting the attribute behind the type corrupts memory in 4.2 and 5.2, and 4.2 has no other way:
        # there the curves are Catmull-Rom splines, which pass through the same points.
        if hasattr(data, "set_types"):
            data.set_types(type="POLY")
        _store(data, "cyclic", ("BOOLEAN", "CURVE"), points.cyclic)
        for side, colors in ((LEFT, points.left), (RIGHT, points.right)):
            _store(data, side, ("FLOAT_COLOR", "POINT"), colors.astype(np.float32).ravel())
        _store(data, OFFSET, ("FLOAT_VECTOR", "POINT"), points.offsets.astype(np.float32).ravel())
        data.attributes.active = data.attributes[LEFT]
    return _child(obj, data)


def _store(data: bpy.types.Curves, name: str, kind: tuple[str, str], values: np.ndarray) -> None:
    attribute = data.attributes.get(name) or data.attributes.new(name, *kind)
    attribute.data.foreach_set(_FIELDS.get(kind[0], "value"), values)


_FIELDS = {"FLOAT_COLOR": "color", "FLOAT_VECTOR": "vector"}


def _child(obj: bpy.types.Object, data: bpy.types.Curves) -> bpy.types.Object:
    child = curves_of(obj)
    if child is None:
        child = bpy.data.objects.new(data.name, data)
        for collection in obj.users_collection:
            collection.objects.link(child)
        child.parent = obj
        child.show_in_front = True  # it runs along the edges, half within the surface
    else:
        old = child.data
        child.data = data
        if old.users == 0:
            name = old.name
            bpy.data.hair_curves.remove(old)
            data.name = name
    return child


def read_curves(child: bpy.types.Object) -> DrawnCurves:
    """The curves of an object, also in Edit Mode. Colors that were never given are 0.

    Where the object stands does not count, so that the curves may be set aside to see both.
    """
    data = child.data
    n = len(data.points)
    places = point_values(data, "position", n, 3) - point_values(data, OFFSET, n, 3)
    sizes = np.array([curve.points_length for curve in data.curves], np.int64)
    cyclic = np.zeros(len(sizes), bool)
    if "cyclic" in data.attributes:
        data.attributes["cyclic"].data.foreach_get("value", cyclic)
    left, right = (point_values(data, side, n, 4) for side in (LEFT, RIGHT))
    return DrawnCurves(sizes, cyclic, places, left, right)


def selected_points(data: bpy.types.Curves) -> np.ndarray:
    """Which points (p,) bool are selected, alone or with their curve; all where none was ever chosen."""
    attribute = data.attributes.get(".selection")
    if attribute is None:
        return np.ones(len(data.points), bool)
    values = np.zeros(len(attribute.data), bool if attribute.data_type == "BOOLEAN" else np.float32)
    attribute.data.foreach_get("value", values)
    if attribute.domain == "CURVE":
        return np.repeat(values > 0, [curve.points_length for curve in data.curves])
    return values > 0


def write_colors(data: bpy.types.Curves, name: str, colors: np.ndarray) -> None:
    """Store colors (p, 4) of the points."""
    _store(data, name, ("FLOAT_COLOR", "POINT"), colors.astype(np.float32).ravel())
    data.update_tag()


def point_values(data: bpy.types.Curves, name: str, n: int, width: int) -> np.ndarray:
    """An attribute (n, width) of the points; 0 where it was never given."""
    values = np.zeros(width * n, np.float32)
    if n and name in data.attributes:
        attribute = data.attributes[name]
        attribute.data.foreach_get(_FIELDS[attribute.data_type], values)
    return values.reshape(-1, width).astype(np.float64)
