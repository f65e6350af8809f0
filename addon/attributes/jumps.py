# SPDX-License-Identifier: GPL-3.0-or-later
"""Cutting a surface where values on it jump: the faces between the two sides are left out.

Each side then ends in a border of its own, over which the energy sees nothing.
"""

import numpy as np
import ridgeform

from ..framework.surface import Surface


def jumping(faces: np.ndarray, values: np.ndarray, share: float) -> np.ndarray:
    """Which triangles (l, 3) bool have an edge along which values (k, c) change by a share of their range."""
    corners = values[faces]
    change = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    return change >= share * float(np.linalg.norm(np.ptp(values, axis=0)))


def cut(surface: Surface, across: np.ndarray) -> tuple[Surface, np.ndarray]:
    """The surface without the triangles `across` (l,) bool, and which vertices (k,) bool have any left."""
    mesh, weights = surface.mesh, surface.face_weights
    left = mesh.faces[~across]
    joined = np.zeros(mesh.n_vertices, bool)
    joined[left] = True
    kept = None if weights is None else weights[~across]
    return Surface(surface.weld, ridgeform.Mesh(mesh.vertices, left), kept), joined
