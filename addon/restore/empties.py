# SPDX-License-Identifier: GPL-3.0-or-later
"""Empties aligned with surfaces."""

from collections.abc import Iterable

import bpy
import numpy as np
from mathutils import Matrix, Vector

MARK = "ridgeform_surface_of"
"""The property of an empty that names the object whose surface it stands for."""


def remove_earlier(obj: bpy.types.Object) -> None:
    """Remove the empties of an earlier run."""
    for child in [child for child in obj.children if child.get(MARK) == obj.name]:
        bpy.data.objects.remove(child)


def add(obj: bpy.types.Object, surfaces: Iterable[dict[str, object]], middles: np.ndarray) -> int:
    """Add an empty for each surface of a known kind, given the middle (k, 3) of each; how many there are."""
    count = 0
    for surface, middle in zip(surfaces, middles, strict=True):
        if surface["kind"] == "free":
            continue
        empty = bpy.data.objects.new(f"{obj.name} {surface['kind']}", None)
        place, size = _place(surface, np.asarray(middle))
        empty.empty_display_type = "SINGLE_ARROW" if surface["kind"] == "plane" else "ARROWS"
        empty.empty_display_size = size
        for name in ("kind", "radius", "major", "minor", "angle", "rms", "faces"):
            if name in surface:
                empty[name] = surface[name]
        empty[MARK] = obj.name
        for collection in obj.users_collection:
            collection.objects.link(empty)
        empty.parent = obj
        axis = Vector(surface.get("normal") or surface.get("axis") or (0.0, 0.0, 1.0))
        turn = axis.to_track_quat("Z", "Y").to_matrix().to_4x4()
        empty.matrix_local = Matrix.Translation(Vector(place)) @ turn
        count += 1
    return count


def _place(surface: dict[str, object], middle: np.ndarray) -> tuple[np.ndarray, float]:
    """Where the empty of a surface is, and how large it is drawn."""
    if surface["kind"] == "plane":
        normal = np.asarray(surface["normal"])
        return middle + (surface["offset"] - middle @ normal) * normal, 1.0
    if surface["kind"] in {"sphere", "torus"}:
        return np.asarray(surface["center"]), float(surface.get("radius") or surface["major"])
    axis, point = np.asarray(surface["axis"]), np.asarray(surface["point"])
    return point + ((middle - point) @ axis) * axis, max(abs(float(surface["radius"])), 1e-6)
