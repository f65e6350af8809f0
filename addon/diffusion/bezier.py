# SPDX-License-Identifier: GPL-3.0-or-later
"""Bézier curves, as the drawing tools of Edit Mode make them, as lines of points."""

from dataclasses import replace

import bpy
import numpy as np

from .curves_io import DrawnCurves, point_values

BEZIER = 2
"""Blender's number for the type in the attribute `curve_type`."""
PIECES = 16
"""Straight pieces between two control points: fine enough for strokes, whose points lie at their bends."""


def straightened(data: bpy.types.Curves, drawn: DrawnCurves) -> DrawnCurves:
    """The same curves, those of type Bézier with points along them; colors go on linearly between points."""
    types = np.zeros(len(drawn.sizes), np.int8)
    if "curve_type" in data.attributes:
        data.attributes["curve_type"].data.foreach_get("value", types)
    if not (types == BEZIER).any():
        return drawn
    n = len(drawn.places)
    moved = drawn.places - point_values(data, "position", n, 3)
    before, after = (point_values(data, f"handle_{side}", n, 3) + moved for side in ("left", "right"))
    colors = np.concatenate([drawn.left, drawn.right], axis=1)
    sizes, rows = [], []
    begin = 0
    for size, closed, kind in zip(drawn.sizes.tolist(), drawn.cyclic.tolist(), types.tolist(), strict=True):
        points = np.arange(begin, begin + size)
        begin += size
        values = np.concatenate([drawn.places[points], colors[points]], axis=1)
        if kind == BEZIER and size > 1:
            ends = np.stack([points, np.roll(points, -1)], axis=1)[: size if closed else -1]
            lines = [
                _segment(np.stack([drawn.places[i], after[i], before[j], drawn.places[j]]), colors[[i, j]])
                for i, j in ends.tolist()
            ]
            values = np.concatenate([*lines, *([] if closed else [values[-1:]])])
        sizes.append(len(values))
        rows.append(values)
    places, left, right = np.split(np.concatenate(rows), [3, 7], axis=1)
    return replace(drawn, sizes=np.array(sizes, np.int64), places=places, left=left, right=right)


def _segment(corners: np.ndarray, colors: np.ndarray) -> np.ndarray:
    """Places and colors from the first of four corners (4, 3) up to the last, and between two colors."""
    t = np.arange(PIECES)[:, None] / PIECES
    weights = np.concatenate([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    return np.concatenate([weights @ corners, (1 - t) * colors[0] + t * colors[1]], axis=1)
