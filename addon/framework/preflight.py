# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh is too large for the memory that is free, before anything of it is read."""

import bpy
import numpy as np
import ridgeform

SHARE = 0.8
"""The share of what is free that a call may take, as in the package."""
STEPS = 20
"""Halvings until what would fit is known to a millionth."""
UNEVEN_SCALE = 1.1
"""Object scales that differ by more than this ratio visibly change which facets the flow prefers."""


def uneven_scale(obj: bpy.types.Object) -> np.ndarray | None:
    """The scale (3,) of an object in the world, if it stretches visibly: tools see the mesh without it."""
    scales = np.abs(obj.matrix_world.to_scale())
    return scales if scales.max() > UNEVEN_SCALE * scales.min() else None


def reason_too_large(obj: bpy.types.Object, call: str) -> str | None:
    """Why a call of the package on the mesh of an object would not fit into memory; `None` if it would.

    The package asks again when all of the problem is known, such as how many columns the values have.
    """
    mesh = obj.data
    size = len(mesh.vertices), max(len(mesh.loops) - 2 * len(mesh.polygons), 0)
    free = SHARE * ridgeform.memory_available()
    needed = ridgeform.memory_estimate(call, size)
    if needed <= free:
        return None
    fits, too_much = 0.0, 1.0
    for _ in range(STEPS):
        middle = 0.5 * (fits + too_much)
        smaller = tuple(int(middle * number) for number in size)
        if ridgeform.memory_estimate(call, smaller) <= free:
            fits = middle
        else:
            too_much = middle
    return _refusal(obj, needed, free, f"reduce it to about {int(fits * size[0])} vertices")


def reason_too_long(obj: bpy.types.Object, mesh: ridgeform.Mesh, longest: int) -> str | None:
    """Why filling holes, the longest of so many edges, would not fit into memory; `None` if it would."""
    free = SHARE * ridgeform.memory_available()
    needed = ridgeform.memory_estimate("fill_holes", mesh, longest=longest)
    if needed <= free:
        return None
    return _refusal(obj, needed, free, f"cut its hole of {longest} edges in two by a strip of faces")


def _refusal(obj: bpy.types.Object, needed: float, free: float, cure: str) -> str:
    return (
        f'"{obj.name}" needs about {_gigabytes(needed)} of memory, {_gigabytes(free)} are free: {cure}, '
        "or close other programs"
    )


def _gigabytes(number: float) -> str:
    return f"{number / 1e9:.2g} GB" if number < 1e10 else f"{number / 1e9:.0f} GB"
