# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of any size as arrays, and their edges. No Blender data here."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class Polygons:
    """Faces of any size, as Blender stores them."""

    corners: np.ndarray
    """The vertex (c,) of each corner, face by face."""
    starts: np.ndarray
    """The first corner (q,) of each face."""
    loose: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int64))
    """The ends (l, 2) of edges without a face."""

    @classmethod
    def of_triangles(cls, faces: np.ndarray) -> "Polygons":
        """Triangles (q, 3)."""
        return cls(faces.ravel(), np.arange(0, faces.size, 3))

    def __len__(self) -> int:
        """How many faces there are."""
        return len(self.starts)

    @cached_property
    def sizes(self) -> np.ndarray:
        """The corners (q,) of each face."""
        return np.diff(self.starts, append=len(self.corners))

    @cached_property
    def faces(self) -> np.ndarray:
        """The face (c,) of each corner."""
        return np.repeat(np.arange(len(self)), self.sizes)

    @cached_property
    def following(self) -> np.ndarray:
        """The vertex (c,) of the next corner of the face of each."""
        after = np.arange(1, len(self.corners) + 1)
        after[self.starts + self.sizes - 1] = self.starts
        return self.corners[after]

    def middles(self, points: np.ndarray) -> np.ndarray:
        """The mean (q, 3) of the corners of each face, given points (p, 3)."""
        if len(self) == 0:
            return np.empty((0, 3))
        return np.add.reduceat(points[self.corners], self.starts, axis=0) / self.sizes[:, None]

    @cached_property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        ends = np.stack([self.corners, self.following], axis=1)
        ends = np.sort(np.concatenate([ends, self.loose]), axis=1)
        size = int(ends.max(initial=0)) + 1
        # Single numbers: NumPy takes several times as long for pairs.
        keys, number = np.unique(ends.astype(np.int64) @ [size, 1], return_inverse=True)
        return np.stack(np.divmod(keys, size), axis=1).astype(np.int32), number.reshape(-1)

    @property
    def edges(self) -> np.ndarray:
        """The edges (k, 2), loose ones too, each once and sorted."""
        return self._edges[0]

    @property
    def corner_edges(self) -> np.ndarray:
        """The edge (c,) that leads from each corner to the next."""
        return self._edges[1][: len(self.corners)]
