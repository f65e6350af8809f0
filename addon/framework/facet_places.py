# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the corners of facets go whose border lies on the plane of a mirror. No Blender data here."""

from collections.abc import Sequence

import numpy as np
import ridgeform

from ..blender.mirroring import Plane

FAR = 0.1
"""A corner that would slide by more than this part of the size goes straight to the plane instead: the ridge
that it slides along hardly meets it."""


def on_planes(found: ridgeform.Faceted, places: np.ndarray, planes: Sequence[Plane]) -> np.ndarray:
    """The vertices (v, 3) of a result, those that come from the border on a plane moved onto it again.

    They slide within the planes of their facets, so that these stay flat. `places` (k, 3) is the mesh.
    """
    points = np.array(found.vertices)
    if not planes:
        return points
    origins, normals = np.asarray(found.origins), np.asarray(found.planes)
    of_vertex = _facets_of(found)
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    on = np.stack([plane.is_on[: len(places)] for plane in planes], axis=1)[origins]
    for vertex in np.flatnonzero(on.any(axis=1)).tolist():
        mirrors = [plane for plane, here in zip(planes, on[vertex].tolist(), strict=True) if here]
        across = np.array([plane.normal for plane in mirrors])
        off = np.array([plane.offset for plane in mirrors]) - across @ points[vertex]
        facets = normals[of_vertex[vertex], :3]
        rows = np.concatenate([facets, across])
        wanted = np.concatenate([np.zeros(len(facets)), off])
        move = np.linalg.lstsq(rows, wanted, rcond=1e-6)[0]
        if np.linalg.norm(move) > FAR * size:
            move = np.linalg.lstsq(across, off, rcond=None)[0]
        points[vertex] += move
        # To the last bit, and where its facets leave no room for both.
        for plane in mirrors:
            points[vertex] -= (points[vertex] @ plane.normal - plane.offset) * plane.normal
    return points


def _facets_of(found: ridgeform.Faceted) -> list[list[int]]:
    of_vertex: list[list[int]] = [[] for _ in found.vertices]
    sizes = np.diff(found.polygon_starts)
    owner = np.repeat(found.polygon_facets, sizes)
    for vertex, facet in zip(np.asarray(found.polygon_vertices).tolist(), owner.tolist(), strict=True):
        if facet not in of_vertex[vertex]:
            of_vertex[vertex].append(facet)
    return of_vertex
