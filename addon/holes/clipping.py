# SPDX-License-Identifier: GPL-3.0-or-later
"""Cutting patches along the planes of mirrors: what a hole across a plane gets on the mesh's own side.

Patches are made on mesh and images together; the modifier makes the other half of them again. No Blender data
here.
"""

from dataclasses import dataclass

import numpy as np

NEAR = 0.25
"""New vertices that are closer to a plane than this part of an edge come to lie on it: no slivers are cut."""


@dataclass
class Pieces:
    """Patches on n old vertices: new points (k, 3), triangles (p, 3), their holes (p,), ridges (r, 2)."""

    places: np.ndarray
    """The old vertices (n, 3)."""
    points: np.ndarray
    triangles: np.ndarray
    hole: np.ndarray
    ridges: np.ndarray

    def cut(self, normal: np.ndarray, offset: float, is_on: np.ndarray) -> None:
        """Keep what lies on the side of the plane that the normal (3,) points to.

        `is_on` says which of the old vertices (n,) bool lie on it.
        """
        if len(self.triangles) == 0:
            return
        n = len(self.places)
        full = np.concatenate([self.places, self.points])
        height = full @ normal - offset
        height[:n][is_on] = 0.0
        edges = full[self.triangles] - full[np.roll(self.triangles, -1, axis=1)]
        near = NEAR * float(np.linalg.norm(edges, axis=2).mean())
        close = np.flatnonzero(np.abs(height) < near)
        close = close[close >= n]
        self.points = self.points - 0.0
        self.points[close - n] -= height[close, None] * normal
        height[close] = 0.0
        cutter = _Cutter(n, self.points, np.concatenate([self.places, self.points]), height, normal)
        pieces = [cutter.inside(triangle) for triangle in self.triangles.tolist()]
        counts = [len(piece) for piece in pieces]
        made = [triangle for piece in pieces for triangle in piece]
        self.hole = np.repeat(self.hole, counts)
        self.triangles = np.array(made, np.int64).reshape(-1, 3)
        ridges = [cutter.part(*edge) for edge in self.ridges.tolist()]
        self.ridges = np.array([edge for edge in ridges if edge is not None], np.int64).reshape(-1, 2)
        self.points = np.concatenate([self.points, *cutter.made]) if cutter.made else self.points

    def compact(self) -> None:
        """Leave out new points that no triangle has."""
        n = len(self.places)
        used = np.zeros(n + len(self.points), bool)
        used[:n] = True
        used[self.triangles] = True
        number = np.cumsum(used) - 1
        self.points = self.points[used[n:]]
        self.ridges = number[self.ridges[used[self.ridges].all(axis=1)]]
        self.triangles = number[self.triangles]


class _Cutter:
    """Triangles and edges cut by heights over a plane."""

    def __init__(
        self, n: int, points: np.ndarray, full: np.ndarray, height: np.ndarray, normal: np.ndarray
    ) -> None:
        self._next = n + len(points)
        self._full, self._height, self._normal = full, height, normal
        self._cuts: dict[tuple[int, int], int] = {}
        self.made: list[np.ndarray] = []

    def inside(self, triangle: list[int]) -> list[list[int]]:
        """The triangles of the part of a triangle that is above."""
        above = [self._height[v] > 0 for v in triangle]
        below = [self._height[v] < 0 for v in triangle]
        if not any(above):
            return []
        if not any(below):
            return [triangle]
        outline = []
        for i, vertex in enumerate(triangle):
            after = (i + 1) % 3
            if not below[i]:
                outline.append(vertex)
            if (above[i] and below[after]) or (below[i] and above[after]):
                outline.append(self._cut(vertex, triangle[after]))
        return [[outline[0], outline[i], outline[i + 1]] for i in range(1, len(outline) - 1)]

    def part(self, a: int, b: int) -> list[int] | None:
        """The part of an edge that is above."""
        if max(self._height[a], self._height[b]) <= 0 and min(self._height[a], self._height[b]) < 0:
            return None
        ends = [a, b]
        for i in (0, 1):
            if self._height[ends[i]] < 0:
                ends[i] = self._cut(a, b)
        return ends

    def _cut(self, a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in self._cuts:
            p, q = self._full[key[0]], self._full[key[1]]
            here, there = self._height[key[0]], self._height[key[1]]
            point = p + (q - p) * (here / (here - there))
            # Once more onto the plane, for its last bit.
            over = here + (there - here) * (here / (here - there))
            self.made.append((point - over * self._normal)[None])
            self._cuts[key] = self._next
            self._next += 1
        return self._cuts[key]
