"""Distance over a surface from a few vertices: true functions with ridges where fronts meet."""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def surface_distance(vertices: Array, faces: Indices, sources: Sequence[int]) -> Array:
    """Distance `(n,)` of every vertex to the nearest of the sources, by fast marching over the triangles.

    In every triangle the front is that of a point, found by laying out the triangle in the plane (as in
    Kimmel and Sethian 1998, with circles for straight fronts): exact on the plane around one source.
    """
    around: list[list[tuple[int, int]]] = [[] for _ in vertices]
    for a, b, c in faces.tolist():
        around[a].append((b, c))
        around[b].append((c, a))
        around[c].append((a, b))
    points = vertices.tolist()
    distance = np.full(len(vertices), np.inf)
    done = np.zeros(len(vertices), dtype=bool)
    heap = [(0.0, source) for source in sources]
    distance[list(sources)] = 0.0
    while heap:
        reached, a = heapq.heappop(heap)
        if done[a]:
            continue
        done[a] = True
        for pair in around[a]:
            for b, c in (pair, pair[::-1]):
                if done[c]:
                    continue
                there = _through(points[a], points[b], points[c], reached, distance[b])
                if there < distance[c]:
                    distance[c] = there
                    heapq.heappush(heap, (there, c))
    return distance


def _through(a: list[float], b: list[float], c: list[float], at_a: float, at_b: float) -> float:
    """Distance at corner `c` of a front that is at `at_a` and `at_b` in the other two."""
    ab, ac, bc = math.dist(a, b), math.dist(a, c), math.dist(b, c)
    along_edges = min(at_a + ac, at_b + bc)
    if not math.isfinite(at_b) or ab == 0 or abs(at_a - at_b) >= ab:
        return along_edges
    # In the plane: a at the origin, b on the x axis, c above, the source of the front below.
    c_x = (ab**2 + ac**2 - bc**2) / (2 * ab)
    c_y = max(ac**2 - c_x**2, 0.0) ** 0.5
    s_x = (ab**2 + at_a**2 - at_b**2) / (2 * ab)
    s_y = -(max(at_a**2 - s_x**2, 0.0) ** 0.5)
    if c_y - s_y <= 0:
        return along_edges
    crossing = s_x - s_y * (c_x - s_x) / (c_y - s_y)
    if 0 <= crossing <= ab:
        return math.hypot(c_x - s_x, c_y - s_y)
    return along_edges


SPOT_SOURCES = ((0.0, 0.9, 1.2), (0.0, -0.6, 1.9))
"""On Spot: tail and crown. Their fronts meet in a ridge over neck, shoulders and forelegs."""
SPOT_VIEW = (-1.0, -0.45, 0.3)
BUST_SOURCES = ((0.0, -0.6, 0.75), (0.3, 0.3, 1.9), (0.3, 0.0, 0.25), (-0.4, 0.2, 1.4))
"""On the bust: mouth, crown, shoulder, and the far side of the crown. Three fronts meet on its front."""
BUST_VIEW = (0.9, -1.0, 0.2)


def nearest(vertices: Array, points: Sequence[Sequence[float]]) -> list[int]:
    """The vertex nearest to every point."""
    return [int(((vertices - point) ** 2).sum(axis=1).argmin()) for point in np.asarray(points, dtype=float)]
