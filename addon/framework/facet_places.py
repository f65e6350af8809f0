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
    if planes:
        owner = np.repeat(found.polygon_facets, np.diff(found.polygon_starts))
        on = _on(planes, len(places))[np.asarray(found.origins)]
        normals = _normals(on, found.polygon_vertices, owner, found)
        _slide(points, on, normals, planes, _size(places))
    return points


def kept_on_planes(
    found: ridgeform.Faceted, places: np.ndarray, triangles: np.ndarray, planes: Sequence[Plane]
) -> np.ndarray:
    """The same for the mesh's own vertices (k, 3), and triangles (l, 3); those that stay keep their bits."""
    points = np.array(found.kept_vertices)
    if planes:
        on = _on(planes, len(places)) & (points != places).any(axis=1)[:, None]
        owner = np.repeat(found.labels, 3)
        normals = _normals(on, triangles.ravel(), owner, found)
        _slide(points, on, normals, planes, _size(places))
    return points


def _size(places: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(places, axis=0)))


def _on(planes: Sequence[Plane], n: int) -> np.ndarray:
    """Which of n vertices lie on which plane, (n, p) bool."""
    return np.stack([plane.is_on[:n] for plane in planes], axis=1)


def _slide(
    points: np.ndarray,
    on: np.ndarray,
    normals: dict[int, np.ndarray],
    planes: Sequence[Plane],
    size: float,
) -> None:
    """Moves points (n, 3) onto the planes that they are `on`, within those with the normals of each."""
    for vertex in np.flatnonzero(on.any(axis=1)).tolist():
        mirrors = [plane for plane, here in zip(planes, on[vertex].tolist(), strict=True) if here]
        across = np.array([plane.normal for plane in mirrors])
        off = np.array([plane.offset for plane in mirrors]) - across @ points[vertex]
        facets = normals.get(vertex, np.empty((0, 3)))
        rows = np.concatenate([facets, across])
        wanted = np.concatenate([np.zeros(len(facets)), off])
        move = np.linalg.lstsq(rows, wanted, rcond=1e-6)[0]
        if np.linalg.norm(move) > FAR * size:
            move = np.linalg.lstsq(across, off, rcond=None)[0]
        points[vertex] += move
        # To the last bit, and where its facets leave no room for both.
        for plane in mirrors:
            points[vertex] -= (points[vertex] @ plane.normal - plane.offset) * plane.normal


def _normals(
    on: np.ndarray, vertices: np.ndarray, owners: np.ndarray, found: ridgeform.Faceted
) -> dict[int, np.ndarray]:
    """The normals of the facets at each vertex `on` a plane, by the vertex and the facet of each corner."""
    of_vertex: dict[int, list[int]] = {}
    rows = np.flatnonzero(on.any(axis=1)[vertices] & (owners >= 0))
    for vertex, facet in zip(vertices[rows].tolist(), owners[rows].tolist(), strict=True):
        known = of_vertex.setdefault(vertex, [])
        if facet not in known:
            known.append(facet)
    planes = np.asarray(found.planes)
    return {vertex: planes[facets, :3] for vertex, facets in of_vertex.items()}
