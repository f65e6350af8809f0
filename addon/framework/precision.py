# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file loses when Blender, which has single precision, reads coordinates far from the origin."""

from collections.abc import Sequence

import bpy
import numpy as np

from ..blender import mesh_io
from .far_origin import is_rounded, step_of


def rounding_notes(objects: Sequence[bpy.types.Object]) -> list[str]:
    """A sentence for each object whose coordinates were rounded visibly, how much and what to do."""
    notes = []
    for obj in objects:
        coordinates = mesh_io.positions(obj.data)
        coordinates = coordinates[np.isfinite(coordinates).all(axis=1)]
        if len(coordinates) == 0:
            continue
        if is_rounded(coordinates):
            size, step = float(np.ptp(coordinates, axis=0).max()), step_of(coordinates)
            middle = 0.5 * (coordinates.min(axis=0).astype(np.float64) + coordinates.max(axis=0))
            moves = ", ".join(f"{-x:.0f}" for x in middle)
            notes.append(
                f'"{obj.name}" lies far from the origin, where Blender rounds coordinates to steps of '
                f"{step:.2g} ({100.0 * step / size:.1g} % of its size): move the file's coordinates by about "
                f"({moves}) first, and back afterwards"
            )
    return notes


def moved_notes(offset: np.ndarray | None) -> list[str]:
    """What the record says of a file whose coordinates were moved by `-offset` (3,), and back afterwards."""
    if offset is None:
        return []
    where = ", ".join(f"{x:.0f}" for x in offset)
    return [f"it lies far from the origin, so it was worked on around ({where}), in double precision"]
