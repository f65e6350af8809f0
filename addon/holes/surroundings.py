# SPDX-License-Identifier: GPL-3.0-or-later
"""The patches that fill the holes of a mesh, together with the faces around them, as a small mesh of its own.

All that is continued into a patch is computed here, so that its cost depends on the holes, not on the mesh.
"""

from dataclasses import dataclass

import numpy as np

from ..blender.welding import Weld, connected_parts

RINGS = 2
"""Rings of faces around a hole: those beyond are not in the stencils of the patch's vertices."""


@dataclass
class Patch:
    """The new faces of a mesh of n vertices."""

    points: np.ndarray
    """Coordinates (k, 3) of the new vertices; the i-th of them is vertex n + i."""
    triangles: np.ndarray
    """Vertices (p, 3) of the new triangles."""
    hole: np.ndarray
    """The hole (p,) that each triangle fills, counted from 0."""
    ridges: np.ndarray
    """Edges (r, 2) where the patch has a ridge, inside it or on its border."""


@dataclass
class Border:
    """The edges between the patches and the mesh, in the direction in which the patch runs along them."""

    start: np.ndarray
    """Local vertex (b,) at the start of each edge."""
    end: np.ndarray
    """Local vertex (b,) at its end."""
    start_corner: np.ndarray
    """The corner (b,) of the mesh's face at the start."""
    end_corner: np.ndarray
    """The corner (b,) of the mesh's face at the end."""
    patch_triangle: np.ndarray
    """The local triangle (b,) of the patch."""
    hole: np.ndarray
    """The hole (b,)."""
    following: np.ndarray
    """The edge (b,) that goes on where each one ends, around the same hole; -1 if there is none."""


def ring_triangles(triangles: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Which triangles (m,) bool lie in the rings around some of the vertices of triangles (m, 3)."""
    near = np.zeros(int(triangles.max()) + 1, bool)
    near[vertices] = True
    a, b, c = triangles.T
    for _ in range(RINGS):
        # Column by column: NumPy takes ten times as long along an axis of three.
        kept = near[a] | near[b] | near[c]
        near[triangles[kept]] = True
    return kept


class Surroundings:
    """The patches and the rings of faces around them.

    Corner i (0 to 2) of triangle t is numbered 3 t + i. The mesh's triangles come first, then the patches'.
    """

    def __init__(self, coordinates: np.ndarray, ring: np.ndarray, weld: Weld, patch: Patch) -> None:
        """Join patches with the triangles (r, 3) around them, of a mesh with coordinates (n, 3)."""
        n_welded = len(weld.first)
        n = len(coordinates)

        def welded(vertices: np.ndarray) -> np.ndarray:
            old = weld.vertex[np.minimum(vertices, n - 1)]
            return np.where(vertices < n, old, vertices - n + n_welded)

        both = np.concatenate([weld.vertex[ring], welded(patch.triangles)])
        self.vertex, local = np.unique(both, return_inverse=True)
        """The welded vertex (v,) of each local one; new vertices follow the last welded one."""
        self.triangles = local.reshape(-1, 3).astype(np.int32)
        """The triangles (r + p, 3) in local vertices."""
        self.n_ring = len(ring)
        self.is_new = self.vertex >= n_welded
        """Which local vertices (v,) bool are new."""
        self.new_index = self.vertex - n_welded
        """Which of the patch's points each local vertex (v,) is, for new ones."""
        self.hole = patch.hole
        old = coordinates[weld.first[self.vertex[~self.is_new]]].astype(np.float64)
        self.places = np.concatenate([old, patch.points[self.new_index[self.is_new]]])
        """Coordinates (v, 3) of the local vertices."""
        self._find_edges()
        self._mark_ridges(welded(patch.ridges))
        self.border = self._border()

    def _find_edges(self) -> None:
        """Pair the corners on the two sides of every edge that has exactly two triangles."""
        starts = self.triangles.ravel().astype(np.int64)
        ends = np.roll(self.triangles, -1, axis=1).ravel().astype(np.int64)
        key = np.minimum(starts, ends) * len(self.vertex) + np.maximum(starts, ends)
        order = np.argsort(key, kind="stable")
        _, first, count = np.unique(key[order], return_index=True, return_counts=True)
        first = first[count == 2]
        one, two = order[first], order[first + 1]
        # Halfedge h = 3 t + i starts at corner h and ends at the next corner of its triangle.
        after = np.arange(len(key)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
        opposite = starts[one] == ends[two]
        self.edge_start = starts[one]
        """Local vertex (e,) at one end of each paired edge."""
        self.edge_end = ends[one]
        """Local vertex (e,) at its other end."""
        self.start_corners = np.stack([one, np.where(opposite, after[two], two)], axis=1)
        """The two corners (e, 2) at the first end, one in each triangle."""
        self.end_corners = np.stack([after[one], np.where(opposite, two, after[two])], axis=1)
        """The two corners (e, 2) at the second end."""
        self.edge_triangles = np.stack([one // 3, two // 3], axis=1)
        """The two triangles (e, 2); the one with the lower number first."""
        self.inside = (self.edge_triangles >= self.n_ring).all(axis=1)
        """Which edges (e,) bool lie inside a patch."""

    def _mark_ridges(self, ridges: np.ndarray) -> None:
        size = np.int64(self.vertex.max(initial=0) + 1)
        wanted = np.sort(ridges.reshape(-1, 2), axis=1).astype(np.int64)
        ends = np.sort(self.vertex[np.stack([self.edge_start, self.edge_end], axis=1)], axis=1).astype(
            np.int64
        )
        self.is_ridge = np.isin(ends[:, 0] * size + ends[:, 1], wanted[:, 0] * size + wanted[:, 1])
        """Which edges (e,) bool are ridges of the patch."""

    def _border(self) -> Border:
        across = (self.edge_triangles[:, 0] < self.n_ring) & (self.edge_triangles[:, 1] >= self.n_ring)
        rows = np.flatnonzero(across)
        patch_triangle = self.edge_triangles[rows, 1]
        # Which way the patch runs: its corner at the edge's start comes right before that at its end.
        at_start, at_end = self.start_corners[rows, 1], self.end_corners[rows, 1]
        forward = at_end == 3 * patch_triangle + (at_start - 3 * patch_triangle + 1) % 3

        def turned(along: np.ndarray, against: np.ndarray) -> np.ndarray:
            return np.where(forward, along[rows], against[rows])

        start = turned(self.edge_start, self.edge_end)
        hole = self.hole[patch_triangle - self.n_ring]
        begins = {(h, v): row for row, (h, v) in enumerate(zip(hole.tolist(), start.tolist(), strict=True))}
        end = turned(self.edge_end, self.edge_start)
        following = [begins.get(key, -1) for key in zip(hole.tolist(), end.tolist(), strict=True)]
        return Border(
            start,
            end,
            turned(self.start_corners[:, 0], self.end_corners[:, 0]),
            turned(self.end_corners[:, 0], self.start_corners[:, 0]),
            patch_triangle,
            hole,
            np.array(following, np.int64),
        )

    def pieces(self, cut: np.ndarray) -> np.ndarray:
        """The connected piece (p,) of each patch triangle when edges `cut` (e,) bool separate them."""
        joined = self.edge_triangles[self.inside & ~cut] - self.n_ring
        return connected_parts(joined[:, [0, 1, 1]], len(self.hole))
