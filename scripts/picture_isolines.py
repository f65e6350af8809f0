"""Isolines and bands of a function on a triangle mesh, exact on every triangle, in NumPy alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SLIVER = 1e-9
"""Pieces below this share of their triangle's area are left out: a level through a corner leaves nothing."""


class _Sorted:
    """Corners of every triangle from the least to the greatest value, and points on its border by value."""

    def __init__(self, vertices: Array, faces: Indices, values: Array) -> None:
        order = np.argsort(values[faces], axis=1, kind="stable")
        corners = np.take_along_axis(faces, order, axis=1)
        self.points = vertices[corners]
        self.values = values[corners]
        self.turned = (order[:, 1] - order[:, 0]) % 3 == 2

    def _on_edge(self, face: Indices, start: int, end: int, level: Array) -> Array:
        low, high = self.values[face, start], self.values[face, end]
        share = np.divide(level - low, high - low, out=np.zeros_like(level), where=high > low)
        share = np.clip(share, 0, 1)[:, None]
        return (1 - share) * self.points[face, start] + share * self.points[face, end]

    def on_long_edge(self, face: Indices, level: Array) -> Array:
        """The point of value `level` on the edge from the least to the greatest corner."""
        return self._on_edge(face, 0, 2, level)

    def on_short_edges(self, face: Indices, level: Array) -> Array:
        """The point of value `level` on the way over the middle corner."""
        below = (level <= self.values[face, 1])[:, None]
        return np.where(below, self._on_edge(face, 0, 1, level), self._on_edge(face, 1, 2, level))


def _pairs(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """All pairs `(i, k)` with `first[i] <= k < last[i]`."""
    counts = np.maximum(last - first, 0)
    rows = np.repeat(np.arange(len(counts)), counts)
    steps = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return rows, first[rows] + steps


def isolines(vertices: ArrayLike, faces: ArrayLike, values: ArrayLike, levels: ArrayLike) -> Array:
    """Segments `(k, 2, 3)` on which the piecewise linear function `values` `(n,)` has one of the `levels`.

    `levels` ascend. Triangles on which the function is constant have none.
    """
    faces, levels = np.asarray(faces, dtype=np.int64), np.asarray(levels, dtype=float)
    ordered = _Sorted(np.asarray(vertices, dtype=float), faces, np.asarray(values, dtype=float))
    first = np.searchsorted(levels, ordered.values[:, 0], side="right")
    last = np.searchsorted(levels, ordered.values[:, 2], side="left")
    face, level = _pairs(first, last)
    level = levels[level]
    return np.stack([ordered.on_long_edge(face, level), ordered.on_short_edges(face, level)], axis=1)


def bands(
    vertices: ArrayLike, faces: ArrayLike, values: ArrayLike, levels: ArrayLike
) -> tuple[Array, Indices, Indices, Indices]:
    """Cut every triangle along the `levels` (ascending) of the piecewise linear function `values` `(n,)`.

    Returns the pieces, which share no vertices: `(3k, 3)` vertices, `(k, 3)` faces turned as their triangles,
    the band `(k,)` of each (0 below the first level) and its triangle `(k,)`.
    """
    faces, levels = np.asarray(faces, dtype=np.int64), np.asarray(levels, dtype=float)
    ordered = _Sorted(np.asarray(vertices, dtype=float), faces, np.asarray(values, dtype=float))
    least, middle, greatest = ordered.values.T
    first = np.searchsorted(levels, least, side="right")
    last = np.maximum(np.searchsorted(levels, greatest, side="left"), first)
    face, band = _pairs(first, last + 1)
    borders = np.concatenate([[-np.inf], levels, [np.inf]])
    low = np.maximum(borders[band], least[face])
    high = np.minimum(borders[band + 1], greatest[face])
    a, b = ordered.on_long_edge(face, low), ordered.on_long_edge(face, high)
    d, c = ordered.on_short_edges(face, low), ordered.on_short_edges(face, high)
    between = ((low <= middle[face]) & (middle[face] <= high))[:, None]
    e = np.where(between, ordered.points[face, 1], d)
    corners = np.stack([np.stack(piece, axis=1) for piece in ((a, c, b), (a, e, c), (a, d, e))], axis=1)
    constant = least == greatest
    corners[constant[face], 0] = ordered.points[face[constant[face]]]
    corners[constant[face], 1:] = corners[constant[face], 1:, :1]
    turned = ordered.turned[face]
    corners[turned] = corners[turned][:, :, ::-1]
    area = _areas(corners)
    kept = area > SLIVER * _areas(ordered.points)[face][:, None]
    pieces = corners[kept]
    face, band = (np.broadcast_to(index[:, None], kept.shape)[kept] for index in (face, band))
    return pieces.reshape(-1, 3), np.arange(3 * len(pieces)).reshape(-1, 3), band, face


def _areas(corners: Array) -> Array:
    """Areas of triangles `(..., 3, 3)`."""
    a, b, c = (corners[..., i, :] for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1)
