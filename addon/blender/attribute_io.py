# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for the values of an attribute or vertex group at the vertices.

Object Mode only: in Edit Mode Blender keeps attributes elsewhere. Colors are linear, as they are rendered.
"""

from dataclasses import dataclass

import bpy
import numpy as np

from .attribute_names import COLORS, GROUP, reason_against
from .mesh_layers import ATTRIBUTE_KINDS
from .refusals import AttributeRefusedError

_LIMITS = {GROUP: (0.0, 1.0), "BYTE_COLOR": (0.0, 1.0), "FLOAT_COLOR": (0.0, np.inf)}


@dataclass
class PointValues:
    """The values of one attribute or vertex group, one row a vertex."""

    name: str
    data_type: str
    """Blender's, or `GROUP`."""
    domain: str
    values: np.ndarray
    """Values (n, k) float32 of the vertices."""
    mixed: np.ndarray
    """Vertices (n,) bool whose face corners have different values."""
    member: np.ndarray
    """Vertices (n,) bool that have a value at all: those in the vertex group, else all."""


def read_values(obj: bpy.types.Object, name: str) -> PointValues:
    """The values of an attribute, or else of a vertex group; `AttributeRefusedError` if it cannot be used."""
    attribute = obj.data.attributes.get(name)
    if attribute is None:
        if name not in obj.vertex_groups:
            raise AttributeRefusedError(f'"{obj.name}" has no attribute or vertex group "{name}"')
        return _read_group(obj, name)
    reason = reason_against(name, attribute.data_type, attribute.domain)
    if reason is not None:
        raise AttributeRefusedError(f'"{name}" of "{obj.name}" cannot be used: {reason}')
    prop, dtype, size = ATTRIBUTE_KINDS[attribute.data_type]
    values = np.empty(len(attribute.data) * size, dtype)
    attribute.data.foreach_get(prop, values)
    values = values.reshape(-1, size)
    n = len(obj.data.vertices)
    mixed = np.zeros(n, bool)
    if attribute.domain == "CORNER":
        corners, values = values, np.zeros((n, size), dtype)
        vertex = _corner_vertices(obj.data)
        values[vertex] = corners
        # NaN counts as equal to itself here: it is refused as what it is.
        differ = (corners != values[vertex]) & ~(np.isnan(corners) & np.isnan(values[vertex]))
        mixed[vertex[differ.any(axis=1)]] = True
    return PointValues(name, attribute.data_type, attribute.domain, values, mixed, np.ones(n, bool))


def _read_group(obj: bpy.types.Object, name: str) -> PointValues:
    index = obj.vertex_groups[name].index
    n = len(obj.data.vertices)
    values, member = np.zeros((n, 1), np.float32), np.zeros(n, bool)
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            if element.group == index:
                values[vertex.index], member[vertex.index] = element.weight, True
                break
    return PointValues(name, GROUP, "POINT", values, np.zeros(n, bool), member)


def _corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    return vertices


def limited(data_type: str, values: np.ndarray) -> np.ndarray:
    """Values (n, k) brought into the range that the type can hold; alpha is at most 1."""
    low, high = _LIMITS.get(data_type, (-np.inf, np.inf))
    inside = np.clip(values, low, high)
    if data_type in COLORS:
        inside[:, 3] = np.clip(inside[:, 3], 0.0, 1.0)
    return inside


def write_values(obj: bpy.types.Object, like: PointValues, values: np.ndarray, name: str) -> str:
    """Store values (n, k) under a name, in the type and domain of `like`; returns the name that Blender gave.

    What has this name, type and domain is written over. A vertex gets into a group if its weight is not 0.
    """
    if like.data_type == GROUP:
        return _write_group(obj, like, values[:, 0], name)
    attribute = obj.data.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != (like.data_type, like.domain):
        attribute = obj.data.attributes.new(name, like.data_type, like.domain)
    name = attribute.name
    if like.domain == "CORNER":
        values = values[_corner_vertices(obj.data)]
    prop, dtype, _ = ATTRIBUTE_KINDS[like.data_type]
    attribute.data.foreach_set(prop, np.ascontiguousarray(values, dtype).ravel())
    obj.data.update()
    return name


def write_floats(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    """Store numbers (n,) in an attribute of this name; one of another type or domain is replaced."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != ("FLOAT", "POINT"):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))
    mesh.update()


def _write_group(obj: bpy.types.Object, like: PointValues, weights: np.ndarray, name: str) -> str:
    group = obj.vertex_groups.get(name)
    if group is None:
        group = obj.vertex_groups.new(name=name)
    elif name != like.name:
        group.remove(list(range(len(weights))))
    for vertex in np.flatnonzero((weights > 0) | like.member).tolist():
        group.add([vertex], float(weights[vertex]), "REPLACE")
    obj.data.update()
    return group.name


def reason_locked(obj: bpy.types.Object, values: PointValues) -> str | None:
    """Why an attribute must not be written over; `None` if it may."""
    if values.data_type == GROUP and obj.vertex_groups[values.name].lock_weight:
        return f'The vertex group "{values.name}" of "{obj.name}" is locked: unlock it first'
    return None
