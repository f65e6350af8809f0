# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders that a mesh has already, as weights of the edges of its triangles."""

from collections.abc import Iterable

import bpy
import numpy as np

from ..blender import mesh_io
from ..blender.welding import Weld
from . import layers, slots

FLAGS = {"SHARP": "use_edge_sharp", "SEAMS": "use_seam"}
"""Blender's names of the flags of edges."""


def border_weights(mesh: bpy.types.Mesh, kinds: Iterable[str], weld: Weld) -> np.ndarray | None:
    """Weights (l, 3) for the welded triangles: 0 for edges that are borders of these kinds, else 1.

    Column i is opposite corner i. `None` where there are no such edges.
    """
    borders = _borders(mesh, kinds)
    if not borders.any():
        return None
    count = len(mesh.vertices)
    triangles = mesh_io.triangles(mesh)[weld.rows[: weld.n_own]].astype(np.int64)
    opposite = np.stack([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]], axis=1)
    named = np.sort(mesh_io.edges(mesh)[borders].astype(np.int64), axis=1) @ [count, 1]
    weights = np.where(np.isin(np.sort(opposite, axis=2) @ [count, 1], named), 0.0, 1.0)
    return weld.of_corners(weights)


def _borders(mesh: bpy.types.Mesh, kinds: Iterable[str]) -> np.ndarray:
    borders = np.zeros(len(mesh.edges), bool)
    for kind in kinds:
        if kind in FLAGS:
            marked = np.zeros(len(mesh.edges), bool)
            mesh.edges.foreach_get(FLAGS[kind], marked)
            borders |= marked
        else:
            borders |= layers.border_edges(mesh, slots.user_index(mesh))
    return borders
