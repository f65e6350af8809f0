# SPDX-License-Identifier: GPL-3.0-or-later
"""Treating the two sides of a split seam as one surface while computing.

Formats that store a vertex once per normal or UV (glTF, PLY), and the Edge Split modifier, leave open
borders whose vertices lie in the same place, up to rounding. Computed as they are, the surface would tear
open along them. What is one place, and which faces are turned over, the wheel says.
"""

from dataclasses import dataclass, field

import numpy as np
import ridgeform


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
    notes: list[str] = field(default_factory=list)
    """What a modeler should know of it."""

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


def weld_seams(coordinates: np.ndarray, triangles: np.ndarray) -> Weld:
    """Weld vertices on open borders whose coordinates (n, 3) are equal up to rounding; others stay."""
    _, welded, vertex = ridgeform.weld(coordinates, triangles)
    n_welded = int(vertex.max(initial=-1)) + 1
    first = np.empty(n_welded, np.int64)
    # The last one that is written stays: so the first.
    first[vertex[::-1]] = np.arange(len(vertex))[::-1]
    # Column by column: NumPy takes ten times as long along an axis of three.
    a, b, c = welded.T
    kept = (a != b) & (b != c) & (c != a)
    return Weld(vertex, first, welded if kept.all() else welded[kept], kept)


def seam_note(coordinates: np.ndarray, weld: Weld) -> str | None:
    """What a modeler should know of sides of seams that are not quite equal, if there are any."""
    apart = (coordinates != coordinates[weld.first][weld.vertex]).any(axis=1)
    if not apart.any():
        return None
    count = int(apart.sum())
    what = "1 vertex lies" if count == 1 else f"{count} vertices lie"
    return f"{what} where others do, up to rounding, and went with them (Merge by Distance makes them one)"


def flip_note(weld: Weld, faces: np.ndarray) -> str | None:
    """What a modeler should know of faces that are turned against their neighbors, if there are any.

    `faces` (l,) is the face of each welded triangle.
    """
    _, flipped = ridgeform.orient(weld.triangles)
    count = len(np.unique(faces[flipped]))
    if count == 0:
        return None
    what = "1 face is" if count == 1 else f"{count} faces are"
    return (
        f"{what} turned against the faces around and went as if turned back "
        "(Mesh ▸ Normals ▸ Recalculate Outside does that)"
    )


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
