# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file loses when Blender, which has single precision, reads coordinates far from the origin."""

from collections.abc import Sequence

import bpy
import numpy as np

from ..blender import mesh_io

VISIBLE = 1e-5
"""Rounding by less than this part of a mesh's size is what files of six digits have anyway."""


def rounding_notes(objects: Sequence[bpy.types.Object]) -> list[str]:
    """A sentence for each object whose coordinates were rounded visibly, how much and what to do."""
    notes = []
    for obj in objects:
        coordinates = mesh_io.positions(obj.data)
        coordinates = coordinates[np.isfinite(coordinates).all(axis=1)]
        if len(coordinates) == 0:
            continue
        size = float(np.ptp(coordinates, axis=0).max())
        farthest = np.abs(coordinates).max(axis=0)
        step = float(np.spacing(farthest.max()))
        if step > VISIBLE * size > 0.0:
            middle = 0.5 * (coordinates.min(axis=0).astype(np.float64) + coordinates.max(axis=0))
            moves = ", ".join(f"{-x:.0f}" for x in middle)
            notes.append(
                f'"{obj.name}" lies far from the origin, where Blender rounds coordinates to steps of '
                f"{step:.2g} ({100.0 * step / size:.1g} % of its size): move the file's coordinates by about "
                f"({moves}) first, and back afterwards"
            )
    return notes
