# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays of a mesh that its faults are found in; no `bpy` is needed to look for them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import ridgeform


@dataclass
class MeshArrays:
    """A mesh of faces of any size, and the triangles that it is computed on."""

    places: np.ndarray
    """Coordinates (n, 3) float32."""
    edges: np.ndarray
    """Ends (k, 2) of the edges."""
    starts: np.ndarray
    """First corner (f,) of each face."""
    corner_vertices: np.ndarray
    """Vertex (c,) of each corner."""
    corner_edges: np.ndarray
    """Edge (c,) that leads from each corner to the next."""
    triangles: np.ndarray
    """Vertices (m, 3) of the loop triangles."""
    triangle_faces: np.ndarray
    """The face (m,) of each."""

    @cached_property
    def sizes(self) -> np.ndarray:
        """How many corners (f,) each face has."""
        return np.diff(self.starts, append=len(self.corner_vertices))

    @cached_property
    def faces_at_edges(self) -> np.ndarray:
        """How many corners (k,) have each edge."""
        return np.bincount(self.corner_edges, minlength=len(self.edges))

    @cached_property
    def is_finite(self) -> np.ndarray:
        """Which vertices (n,) have a place."""
        x, y, z = self.places.T
        return np.isfinite(x) & np.isfinite(y) & np.isfinite(z)

    @cached_property
    def report(self) -> ridgeform.MeshReport:
        """What the wheel says of the triangles, where all vertices have a place."""
        return ridgeform.Mesh(self.places, self.triangles).report

    def faces_of_corners(self, corners: np.ndarray) -> np.ndarray:
        """The face of each of some corners."""
        return np.searchsorted(self.starts, corners, side="right") - 1
