# SPDX-License-Identifier: GPL-3.0-or-later
"""Treating the two sides of a split seam as one surface while computing.

Formats that store a vertex once per normal or UV (glTF, PLY), and the Edge Split modifier, leave open
borders whose vertices lie in the same place. Computed as they are, the surface would tear open along them.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Weld:
    """The welded mesh of a mesh: which of its vertices each vertex is, and what is left of its triangles."""

    vertex: np.ndarray
    """The welded vertex (n,) of each vertex."""
    first: np.ndarray
    """A vertex (k,) of the mesh for each welded vertex."""
    triangles: np.ndarray
    """The welded triangles (l, 3), those that kept three different vertices."""
    kept: np.ndarray
    """Which triangles (m,) bool of the mesh these are."""

    def of(self, vertices: np.ndarray) -> np.ndarray:
        """The welded vertices of an array of vertices; the array itself if none were welded."""
        return vertices if len(self.first) == len(self.vertex) else self.vertex[vertices]

    def all_of(self, mask: np.ndarray) -> np.ndarray:
        """Whether a mask (n,) holds for all the vertices of each welded vertex (k,)."""
        result = np.ones(len(self.first), bool)
        np.logical_and.at(result, self.vertex, mask)
        return result

    def mean_of(self, values: np.ndarray) -> np.ndarray:
        """The mean of values (n,) over the vertices of each welded vertex (k,)."""
        return self.sum_of(values) / self.sum_of(np.ones(len(values)))

    def sum_of(self, values: np.ndarray) -> np.ndarray:
        """The sum of values (n,) over the vertices of each welded vertex (k,)."""
        return np.bincount(self.vertex, weights=values, minlength=len(self.first))


def weld_seams(coordinates: np.ndarray, triangles: np.ndarray, border: np.ndarray | None = None) -> Weld:
    """Weld vertices on open borders whose coordinates (n, 3) are equal; all others keep their order.

    `border` (b,) are the vertices on open borders, if they are known.
    """
    n = len(coordinates)
    vertex = first = np.arange(n)
    border = _border_vertices(triangles, n) if border is None else border
    if len(border):
        # Adding 0 turns -0 into 0, which is the same place.
        _, found, place = np.unique(coordinates[border] + 0.0, axis=0, return_index=True, return_inverse=True)
        if len(found) < len(border):
            representative = np.arange(n)
            representative[border] = border[found[place.ravel()]]
            first, vertex = np.unique(representative, return_inverse=True)
    welded = triangles.astype(np.int32, copy=False)
    if len(first) < n:
        welded = vertex[triangles].astype(np.int32)
    # Column by column: NumPy takes ten times as long along an axis of three.
    a, b, c = welded.T
    kept = (a != b) & (b != c) & (c != a)
    return Weld(vertex, first, welded if kept.all() else welded[kept], kept)


def connected_parts(triangles: np.ndarray, n_vertices: int) -> np.ndarray:
    """The lowest vertex (n,) of the connected part of each vertex; triangles sharing one are joined."""
    label = np.arange(n_vertices)
    while True:
        corner = label[triangles]
        joined = label.copy()
        # Whole parts are joined, not single vertices: so few rounds are enough.
        np.minimum.at(joined, corner.ravel(), np.repeat(corner.min(axis=1), 3))
        while not np.array_equal(joined, joined[joined]):
            joined = joined[joined]
        if np.array_equal(joined, label):
            return label
        label = joined[label]


def _border_vertices(triangles: np.ndarray, n_vertices: int) -> np.ndarray:
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    ends.sort(axis=1)
    edge, count = np.unique(ends[:, 0] * n_vertices + ends[:, 1], return_counts=True)
    border = edge[count == 1]
    return np.unique(np.concatenate([border // n_vertices, border % n_vertices]))
