# SPDX-License-Identifier: GPL-3.0-or-later
"""Taking vertices off the curves of a mesh of triangles, by collapsing edges along them.

No Blender data here.
"""

from collections.abc import Iterable

import numpy as np

TURNED = 0.2
"""The least cosine between the normals of a triangle before and after; that of fast-simplification."""


class Fans:
    """Triangles under edit: the triangles of every vertex."""

    def __init__(self, points: np.ndarray, faces: np.ndarray) -> None:
        """Take points (p, 3) and triangles (q, 3)."""
        self._points = points.tolist()
        self.faces: list[list[int] | None] = faces.tolist()
        """The triangles; `None` for those that are gone."""
        self._of: list[set[int]] = [set() for _ in self._points]
        for face, corners in enumerate(self.faces):
            for vertex in corners:
                self._of[vertex].add(face)
        self._border = self._border_vertices(faces)

    def _border_vertices(self, faces: np.ndarray) -> set[int]:
        ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        edges, count = np.unique(ends, axis=0, return_counts=True)
        return set(edges[count == 1].ravel().tolist())

    def collapse(self, vertex: int, into: int) -> bool:
        """Move a vertex into a neighbor, unless that would fold the surface or join what is apart."""
        gone = self._of[vertex] & self._of[into]
        if not 1 <= len(gone) <= 2 or not self._stays_a_surface(vertex, into, gone):
            return False
        stay = self._of[vertex] - gone
        if any(self._turns(face, vertex, into) for face in stay):
            return False
        for face in gone:
            for corner in self.faces[face]:
                self._of[corner].discard(face)
            self.faces[face] = None
        for face in stay:
            self.faces[face] = [into if corner == vertex else corner for corner in self.faces[face]]
        self._of[into] |= stay
        self._of[vertex] = set()
        return True

    def _stays_a_surface(self, vertex: int, into: int, gone: set[int]) -> bool:
        """The link condition (Dey et al. 1999), and no vertex is left with two triangles back to back."""
        tips = {corner for face in gone for corner in self.faces[face]} - {vertex, into}
        if len(gone) == 2 and {vertex, into} <= self._border:
            return False
        if any(len(self._of[tip]) <= 3 and tip not in self._border for tip in tips):
            return False
        return self._neighbors(vertex) & self._neighbors(into) == tips

    def _neighbors(self, vertex: int) -> set[int]:
        return {corner for face in self._of[vertex] for corner in self.faces[face]} - {vertex}

    def _turns(self, face: int, vertex: int, into: int) -> bool:
        corners = self.faces[face]
        before = self._normal(corners)
        after = self._normal([into if corner == vertex else corner for corner in corners])
        lengths = np.sqrt(_dot(before, before) * _dot(after, after))
        return not _dot(before, after) > TURNED * lengths

    def _normal(self, corners: Iterable[int]) -> tuple[float, float, float]:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (self._points[corner] for corner in corners)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


def _dot(a: tuple[float, float, float], b: tuple[float, float, float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
