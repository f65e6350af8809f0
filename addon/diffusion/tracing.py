# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves as they were left by hand, brought onto the edges of the mesh."""

import bpy
import numpy as np
import ridgeform

from ..blender.refusals import AttributeRefusedError, CurvesRefusedError
from ..blender.welding import Weld
from .bezier import straightened
from .curves_io import LEFT, MARK, RIGHT, CurvePoints, DrawnCurves, read_curves
from .layout import offsets, point_edges
from .sources import attribute_colors, image_colors


def curves_on_mesh(
    obj: bpy.types.Object, child: bpy.types.Object, weld: Weld, mesh: ridgeform.Mesh
) -> CurvePoints:
    """The curves of an object on vertices of its mesh: where they lie, or as near as edges run to them.

    Colors are interpolated along each curve. A side without any, as those of a curve drawn by hand,
    takes those of the paint there. `CurvesRefusedError` if there is no paint any more, and the errors of
    `ridgeform.trace_curves`.
    """
    drawn = straightened(child.data, read_curves(child))
    begins = np.concatenate([[0], np.cumsum(drawn.sizes)]).astype(np.int64)
    vertices, starts, places = ridgeform.trace_curves(mesh, drawn.places, starts=begins, closed=drawn.cyclic)
    sizes = np.diff(starts).astype(np.int64)
    of_curve = np.repeat(np.arange(len(sizes)), sizes)
    left, right = (_along(colors, drawn, begins, of_curve, places) for colors in (drawn.left, drawn.right))
    traced = CurvePoints(
        sizes,
        drawn.cyclic & (sizes > 2),
        vertices.astype(np.int64),
        left,
        right,
        np.zeros((len(vertices), 3)),
    )
    bare = [_without_colors(given, begins) for given in (drawn.left, drawn.right)]
    if any(len(curves) for curves in bare):
        paint = _paint(obj, child)[weld.first]
        opposite = _opposite_corners(weld.triangles)
        for colors, curves, direction in zip((left, right), bare, (1, -1), strict=True):
            _take_paint(traced, colors, curves, paint, opposite, direction=direction)
    ends, _ = point_edges(traced)
    traced.offsets[ends] = offsets(mesh, traced.vertices[ends])
    traced.vertices = weld.first[traced.vertices]
    return traced


def _along(
    colors: np.ndarray, drawn: DrawnCurves, begins: np.ndarray, of_curve: np.ndarray, places: np.ndarray
) -> np.ndarray:
    """Colors (k, 4) of traced points at these places along their curves."""
    before = np.floor(places).astype(np.int64)
    part = (places - before)[:, None]
    size = drawn.sizes[of_curve]
    after = np.where(drawn.cyclic[of_curve], (before + 1) % size, np.minimum(before + 1, size - 1))
    before %= size
    begin = begins[of_curve]
    return (1 - part) * colors[begin + before] + part * colors[begin + after]


def _paint(obj: bpy.types.Object, child: bpy.types.Object) -> np.ndarray:
    """The colors (n, 4) that the curves stand for; `CurvesRefusedError` if they are gone."""
    name = child.data[MARK]
    try:
        return (attribute_colors(obj, name) if name in obj.data.attributes else image_colors(obj)).values
    except AttributeRefusedError as refusal:
        raise CurvesRefusedError(
            f'A curve of "{child.name}" has no colors, and "{name}", which it could take them from, is gone: '
            f'set its attributes "{LEFT}" and "{RIGHT}"'
        ) from refusal


def _without_colors(given: np.ndarray, begins: np.ndarray) -> np.ndarray:
    """The curves whose points have no colors (p, 4) on a side."""
    some = np.add.reduceat(np.append(given.any(axis=1), False), begins[:-1]) > 0
    return np.flatnonzero(~some)


def _opposite_corners(triangles: np.ndarray) -> dict[tuple[int, int], int]:
    """For each edge, as a triangle runs along it, the corner of the triangle opposite to it."""
    opposite = {}
    for i in range(3):
        ends = np.roll(triangles, -1 - i, axis=1)[:, :2]
        opposite.update(zip(map(tuple, ends.tolist()), triangles[:, i].tolist(), strict=True))
    return opposite


def _take_paint(
    traced: CurvePoints,
    colors: np.ndarray,
    curves: np.ndarray,
    paint: np.ndarray,
    opposite: dict[tuple[int, int], int],
    *,
    direction: int,
) -> None:
    """Give curves without colors on one side the paint at the corners opposite their edges, off the curve.

    `direction` is 1 for the left side and -1 for the right one.
    """
    stops = np.cumsum(traced.sizes)
    for curve in curves:
        rows = np.arange(stops[curve] - traced.sizes[curve], stops[curve])
        path = traced.vertices[rows].tolist()
        if len(path) == 1:
            colors[rows] = paint[path]
            continue
        closed = traced.cyclic[curve]
        pairs = list(zip(path, path[1:] + path[:1], strict=True))[: len(path) if closed else -1]
        # At a rim there is nothing on one of the sides.
        beside = paint[[opposite.get(pair[::direction], pair[0]) for pair in pairs]]
        # A point between two edges has the mean of both.
        before = np.roll(beside, 1, axis=0) if closed else np.vstack([beside[:1], beside])
        after = beside if closed else np.vstack([beside, beside[-1:]])
        colors[rows] = 0.5 * (before + after)
