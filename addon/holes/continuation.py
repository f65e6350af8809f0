# SPDX-License-Identifier: GPL-3.0-or-later
"""Values around a hole, continued into its patch: Rowe et al. 2024, eq. (22), on patch and rings alone."""

from collections.abc import Callable

import numpy as np
import ridgeform

from ..blender.welding import connected_parts
from .cuts import PatchGraph, cut_along, value_jumps
from .surroundings import Surroundings

SAME = 1e-5
"""Values that differ by less than this share of their range are the same: files store UVs in six digits."""
Solve = Callable[[ridgeform.Mesh, np.ndarray, np.ndarray], np.ndarray]


def interpolated(mesh: ridgeform.Mesh, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (v, c) at all vertices of a mesh, from those (k, c) at the vertices `known` (k,)."""
    columns = values[:, 0] if values.shape[1] == 1 else values
    return ridgeform.interpolate(mesh, known, columns).values.reshape(-1, values.shape[1])


class Continuation:
    """Continues what lies on the faces around the holes into the patches."""

    def __init__(self, around: Surroundings, solve: Solve = interpolated) -> None:
        """Take the surroundings, and what computes values from known ones."""
        self.around = around
        self.graph = PatchGraph(around)
        self._solve = solve

    def corners(self, values: np.ndarray) -> np.ndarray:
        """Values (3 p, c) at the corners of the patches from those (3 r, c) at the corners around them.

        Where values jump across an edge of the mesh, a seam, they are taken to lie on separate islands. Seams
        that end at a hole go on through its patch, and each island is continued by itself. Where one value
        is not a finite number, the nearest are taken.
        """
        if not np.isfinite(values).all():
            return values[self.nearest_corners()]
        values = values.astype(np.float64)
        tolerance = SAME * float(np.ptp(values, axis=0).max(initial=0.0))
        cut = self._cut(values, tolerance)
        island_vertex = self._island_vertices(values, tolerance, cut)
        count = int(island_vertex.max()) + 1
        ring = island_vertex[: len(values)]
        known = np.bincount(ring, minlength=count) > 0
        given = np.zeros((count, values.shape[1]))
        np.add.at(given, ring, values)
        given[known] /= np.bincount(ring, minlength=count)[known, None]
        full = self._filled_in(island_vertex, known, given)
        return full[island_vertex[len(values) :]]

    def points(self, values: np.ndarray) -> np.ndarray:
        """Values (k, c) at the new vertices from those (3 r, c) at the corners around them."""
        at_corners = self.corners(values)
        around = self.around
        vertex = around.triangles[around.n_ring :].ravel()
        new = around.is_new[vertex]
        result = np.zeros((int(around.is_new.sum()), values.shape[1]))
        result[around.new_index[vertex[new]]] = at_corners[new]
        return result

    def faces(self, values: np.ndarray) -> np.ndarray:
        """Values (p, c) of the patch's faces: those (r, c) of the faces that they border on.

        Where faces with different values meet at a hole, the border between them goes on through the patch.
        """
        around, border = self.around, self.around.border
        beside = values[border.start_corner // 3]
        jumps = value_jumps(around, beside.astype(np.float64), beside.astype(np.float64), 0.0)
        piece = around.pieces(cut_along(around, self.graph, jumps))
        row = self._longest_border(piece[border.patch_triangle - around.n_ring], beside)
        result = np.zeros((len(piece), values.shape[1]), values.dtype)
        for label in np.unique(piece).tolist():
            result[piece == label] = beside[row[label]] if label in row else beside[0]
        return result

    def majority(self, values: np.ndarray) -> np.ndarray:
        """Values (p, c) of the patch's faces: that of (r, c) which most of the border of their hole has."""
        around, border = self.around, self.around.border
        beside = values[border.start_corner // 3]
        row = self._longest_border(border.hole, beside)
        result = np.zeros((len(around.hole), values.shape[1]), values.dtype)
        for hole, best in row.items():
            result[around.hole == hole] = beside[best]
        return result

    def nearest_corners(self) -> np.ndarray:
        """The corner (3 p,) around the holes whose value a patch's corner takes where none can be mixed."""
        around, border = self.around, self.around.border
        at_vertex = dict(zip(border.start.tolist(), border.start_corner.tolist(), strict=True))
        source = self.graph.nearest(at_vertex)
        vertex = around.triangles[around.n_ring :].ravel().tolist()
        return np.array([at_vertex[source.get(v, border.start[0])] for v in vertex], np.int64)

    def marks(self, ends: np.ndarray, only_ridges: bool) -> np.ndarray:
        """Edges (e,) bool inside the patches on which marks go on that end at the border vertices `ends`."""
        marked = np.zeros(len(self.around.inside), bool)
        border = self.around.border
        for hole in np.unique(border.hole).tolist():
            here = np.intersect1d(ends, border.start[border.hole == hole])
            if len(here) > 1:
                marked |= self.graph.connected(here.tolist(), only_ridges)
        return marked

    def _cut(self, values: np.ndarray, tolerance: float) -> np.ndarray:
        border = self.around.border
        jumps = value_jumps(self.around, values[border.start_corner], values[border.end_corner], tolerance)
        return cut_along(self.around, self.graph, jumps)

    def _island_vertices(self, values: np.ndarray, tolerance: float, cut: np.ndarray) -> np.ndarray:
        """A number for each corner (3 r + 3 p,), the same where corners are one vertex of one island."""
        around = self.around
        joins = []
        in_ring = (around.edge_triangles < around.n_ring).all(axis=1)
        for pairs in (around.start_corners, around.end_corners):
            same = np.zeros(len(pairs), bool)
            ends = pairs[in_ring]
            same[in_ring] = (np.abs(values[ends[:, 0]] - values[ends[:, 1]]) <= tolerance).all(axis=1)
            joins.append(pairs[np.where(in_ring, same, ~cut)])
        joined = np.concatenate(joins)
        label = connected_parts(joined[:, [0, 1, 1]], around.triangles.size)
        return np.unique(label, return_inverse=True)[1]

    def _filled_in(self, island_vertex: np.ndarray, known: np.ndarray, given: np.ndarray) -> np.ndarray:
        varying = (given[known] != given[known][:1]).any(axis=0)
        full = np.where(known[:, None], given, given[known][:1])
        if known.all() or not varying.any():
            return full
        place = np.empty((len(known), 3))
        place[island_vertex] = self.around.places[self.around.triangles.ravel()]
        mesh = ridgeform.Mesh(place, island_vertex.reshape(-1, 3).astype(np.int32))
        rows = np.flatnonzero(known)
        solved = self._solve(mesh, rows, given[np.ix_(known, varying)])
        full[np.ix_(~known, varying)] = solved[~known]
        return full

    def _longest_border(self, label: np.ndarray, beside: np.ndarray) -> dict[int, int]:
        """For each label of border edges (b,) an edge with the value (b, c) that the most border has."""
        border, places = self.around.border, self.around.places
        length = np.linalg.norm(places[border.start] - places[border.end], axis=1)
        best: dict[int, int] = {}
        for name in np.unique(label).tolist():
            rows = np.flatnonzero(label == name)
            _, first, kind = np.unique(beside[rows], axis=0, return_index=True, return_inverse=True)
            total = np.bincount(kind.ravel(), weights=length[rows])
            best[name] = int(rows[first[total.argmax()]])
        return best
