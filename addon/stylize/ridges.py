# SPDX-License-Identifier: GPL-3.0-or-later
"""Finding the ridges: edges with a large angle between their two faces."""

import numpy as np


def face_normals(coordinates: np.ndarray, starts: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Newell's normals (f, 3) of faces of any size, as long as twice their area.

    Faces are given by the start of each in the corner arrays (f,) and the vertex of each corner (c,).
    """
    if len(starts) == 0:
        return np.empty((0, 3))
    following = np.arange(1, len(vertices) + 1)
    following[np.append(starts[1:], len(vertices)) - 1] = starts
    # Relative to one corner of each face: otherwise faces far from the origin lose their digits.
    sizes = np.diff(np.append(starts, len(vertices)))
    corners = coordinates.astype(np.float64)[vertices]
    corners -= np.repeat(corners[starts], sizes, axis=0)
    return np.add.reduceat(np.cross(corners, corners[following]), starts, axis=0)


def ridge_edges(
    coordinates: np.ndarray, corners: tuple[np.ndarray, np.ndarray, np.ndarray], n_edges: int, angle: float
) -> np.ndarray:
    """The edges (n_edges,) bool whose two faces meet at `angle` radians or more.

    Edges with one face or more than two, and those beside a face without area, are none. Two faces that run
    along the edge the same way (disagreeing normals) are compared as if one was turned over.
    """
    starts, vertices, corner_edges = corners
    normals = face_normals(coordinates, starts, vertices)
    face = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(vertices))))
    order = np.argsort(corner_edges, kind="stable")
    count = np.bincount(corner_edges, minlength=n_edges)
    pairs = np.flatnonzero(count == 2)
    first = order[(np.cumsum(count) - count)[pairs]]
    second = order[(np.cumsum(count) - count)[pairs] + 1]
    a, b = normals[face[first]], normals[face[second]]
    b = np.where((vertices[first] == vertices[second])[:, None], -b, b)
    # atan2 stays exact for tiny angles, where the arc cosine does not.
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    cosine = np.einsum("ij,ij->i", a, b)
    has_area = (np.einsum("ij,ij->i", a, a) > 0) & (np.einsum("ij,ij->i", b, b) > 0)
    ridges = np.zeros(n_edges, bool)
    ridges[pairs] = has_area & (np.arctan2(sine, cosine) >= angle)
    return ridges
