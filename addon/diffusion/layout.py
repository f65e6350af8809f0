# SPDX-License-Identifier: GPL-3.0-or-later
"""Between the package's edges with colors at both ends and the points of curve objects."""

from dataclasses import dataclass

import numpy as np
import ridgeform

from ..blender.welding import Weld
from .curves_io import CurvePoints


@dataclass
class ColoredEdges:
    """What `ridgeform.redraw` wants, on a welded mesh."""

    edges: np.ndarray
    left: np.ndarray
    right: np.ndarray
    points: np.ndarray
    point_colors: np.ndarray


def curve_points(
    found: ridgeform.DiffusionCurves, mesh: ridgeform.Mesh, weld: Weld, alpha: float
) -> CurvePoints:
    """The points of the curves that the package found on a mesh; colors get an alpha if they have none."""
    sizes, cyclic, edge_of_point, end_of_point = [], [], [], []
    for begin, end in zip(found.starts[:-1], found.starts[1:], strict=True):
        closed = bool(found.edges[begin, 0] == found.edges[end - 1, 1])
        rows = np.arange(begin, end)
        edge_of_point += [rows] if closed else [rows, rows[-1:]]
        end_of_point += [np.zeros(len(rows), int)] if closed else [np.zeros(len(rows), int), np.ones(1, int)]
        sizes.append(len(rows) + (not closed))
        cyclic.append(closed)
    at = (np.concatenate([*edge_of_point, _NONE]), np.concatenate([*end_of_point, _NONE]))
    alone = len(found.points)
    points = _with_alpha(found.point_colors, alpha)
    away = offsets(mesh, found.edges)
    return CurvePoints(
        np.array(sizes + [1] * alone, np.int64),
        np.array(cyclic + [False] * alone, bool),
        weld.first[np.concatenate([found.edges[at], found.points])],
        np.concatenate([_with_alpha(found.left[at], alpha), points]),
        np.concatenate([_with_alpha(found.right[at], alpha), points]),
        np.concatenate([away[at], np.zeros((alone, 3))]),
    )


def offsets(mesh: ridgeform.Mesh, edges: np.ndarray) -> np.ndarray:
    """How far from its vertex each end (k, 2, 3) of edges of curves is drawn, to be on smooth lines."""
    return ridgeform.smooth_curves(mesh, edges) - mesh.vertices[edges]


_NONE = np.zeros(0, int)


def _with_alpha(colors: np.ndarray, alpha: float) -> np.ndarray:
    return colors if colors.shape[1] == 4 else np.column_stack([colors, np.full(len(colors), alpha)])


def colored_edges(points: CurvePoints, weld: Weld) -> ColoredEdges:
    """The edges of curves, as they are now, with the colors at their ends."""
    ends, alone = point_edges(points)
    vertices = weld.vertex[points.vertices]
    return ColoredEdges(
        vertices[ends], points.left[ends], points.right[ends], vertices[alone], points.left[alone]
    )


def point_edges(points: CurvePoints) -> tuple[np.ndarray, np.ndarray]:
    """The points at the ends (k, 2) of every edge of curves, and those (j,) of curves of one point."""
    starts = np.concatenate([[0], np.cumsum(points.sizes)]).astype(np.int64)
    tails, heads, alone = [], [], []
    for begin, end, closed in zip(starts[:-1], starts[1:], points.cyclic, strict=True):
        rows = np.arange(begin, end)
        if len(rows) == 1:
            alone.append(begin)
            continue
        tails.append(rows if closed else rows[:-1])
        heads.append(np.roll(rows, -1) if closed else rows[1:])
    ends = np.stack([np.concatenate([*part, _NONE]) for part in (tails, heads)], axis=1)
    return ends, np.array(alone, np.int64)
