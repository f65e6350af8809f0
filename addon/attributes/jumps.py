# SPDX-License-Identifier: GPL-3.0-or-later
"""Cutting a surface where values on it jump: the faces between the two sides are left out.

Each side then ends in a border of its own, over which the energy sees nothing.
"""

import numpy as np
import ridgeform

from ..framework.run import counted
from ..framework.surface import Surface


def jumping(
    faces: np.ndarray, values: np.ndarray, share: float, known: np.ndarray | None = None
) -> np.ndarray:
    """Which triangles (l, 3) bool have an edge along which values (k, c) change by a share of their range.

    Of values that are `known` (k,) bool at both ends; all of them where nothing is said.
    """
    known = np.ones(len(values), bool) if known is None else known
    corners, at = values[faces], known[faces]
    change = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2)
    change[~(at & at[:, [1, 2, 0]])] = 0.0
    extent = float(np.linalg.norm(np.ptp(values[known], axis=0))) if known.any() else 0.0
    return (change >= share * extent).any(axis=1) & (change > 0.0).any(axis=1)


def note_on(across: np.ndarray) -> str:
    """What a modeler should know of the triangles (l,) bool that values jump across."""
    count = int(across.sum())
    if count == 0:
        return "its values jump nowhere (lower Jump to keep them apart)"
    return f"its values jump across {counted(count, 'triangle')}, and were kept apart there"


def cut(surface: Surface, across: np.ndarray) -> tuple[Surface, np.ndarray]:
    """The surface without the triangles `across` (l,) bool, and which vertices (k,) bool have any left."""
    mesh, weights = surface.mesh, surface.face_weights
    left = mesh.faces[~across]
    joined = np.zeros(mesh.n_vertices, bool)
    joined[left] = True
    kept = None if weights is None else weights[~across]
    return Surface(surface.weld, ridgeform.Mesh(mesh.vertices, left), kept), joined
