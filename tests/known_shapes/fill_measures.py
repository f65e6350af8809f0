"""How far a filling is from the truth, and whether it is a sound mesh. Arrays in, numbers out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Faces = NDArray[np.int64]

BLOCK = 200_000
"""Pairs of a point and a triangle looked at together: some tens of megabytes."""
SAMPLES = np.array([[i, j, 4 - i - j] for i in range(5) for j in range(5 - i)]) / 4
"""Places in a triangle where a filling is measured: corners, edges and inside."""


def boundary_edges(faces: Faces) -> Faces:
    """The halfedges `(k, 2)` without an opposite one."""
    halfedges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    n = int(faces.max()) + 1 if len(faces) else 0
    key, opposite = (halfedges @ [n, 1], halfedges @ [1, n])
    return halfedges[~np.isin(key, opposite)]


def point_distances(points: Points, vertices: Points, faces: Faces) -> Points:
    """The distance `(p,)` of every point to the nearest triangle; infinite without triangles."""
    result = np.full(len(points), np.inf)
    if len(faces) == 0:
        return result
    corners = vertices[faces]
    middle = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
    step = max(1, BLOCK // len(faces))
    for begin in range(0, len(points), step):
        block = points[begin : begin + step]
        away = np.linalg.norm(block[:, None] - middle, axis=2)
        # Only triangles that reach as near as the nearest middle can be the nearest.
        point, triangle = np.nonzero(away - reach <= away.min(axis=1, keepdims=True))
        np.minimum.at(result, begin + point, _distances(block[point], corners[triangle]))
    return result


def _distances(p: Points, corners: Points) -> Points:
    """The distance of each point `(k, 3)` to its own triangle `(k, 3, 3)`."""
    a, b, c = (corners[:, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    length2 = (normal**2).sum(axis=1)
    height = ((p - a) * normal).sum(axis=1)
    inside = length2 > 0
    best = np.full(len(p), np.inf)
    for u, v in ((a, b), (b, c), (c, a)):
        edge, to = v - u, p - u
        inside &= (np.cross(edge, to) * normal).sum(axis=1) >= 0
        square = (edge**2).sum(axis=1)
        t = np.clip((to * edge).sum(axis=1) / np.where(square > 0, square, 1), 0, 1)
        best = np.minimum(best, ((to - t[:, None] * edge) ** 2).sum(axis=1))
    flat = np.divide(height**2, length2, out=np.full(len(p), np.inf), where=length2 > 0)
    return np.sqrt(np.where(inside, flat, best))


def new_faces(
    before: tuple[Points, Faces], after: tuple[Points, Faces], tolerance: float
) -> NDArray[np.bool_]:
    """Which faces of `after` were not in `before`: no old face has its center within the tolerance."""

    def cells(mesh: tuple[Points, Faces], shift: float) -> NDArray[np.int64]:
        return np.floor(mesh[0][mesh[1]].mean(axis=1) / tolerance + shift).astype(np.int64)

    old = np.zeros(len(after[1]), bool)
    # Two grids, half a cell apart in each direction: what is near is together in a cell of one of them.
    for shift in np.ndindex(2, 2, 2):
        half = 0.5 * np.array(shift)
        known = {tuple(cell) for cell in cells(before, half).tolist()}
        old |= np.fromiter((tuple(cell) in known for cell in cells(after, half).tolist()), bool, len(old))
    return ~old


def samples(vertices: Points, faces: Faces) -> tuple[Points, Points]:
    """Points `(p, 3)` on the faces, and the area `(p,)` that each stands for."""
    corners = vertices[faces]
    points = np.einsum("sk,fkd->fsd", SAMPLES, corners).reshape(-1, 3)
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return points, np.repeat(area / len(SAMPLES), len(SAMPLES))


def mean_and_rms(values: Points, weights: Points | None = None) -> tuple[float, float]:
    """The weighted mean and root mean square."""
    if weights is None or weights.sum() == 0:
        weights = np.ones(len(values))
    return (
        float(np.average(values, weights=weights)),
        float(np.sqrt(np.average(values**2, weights=weights))),
    )


def qualities(vertices: Points, faces: Faces) -> Points:
    """Of every triangle `4 √3 area / (sum of squared lengths)`: 1 if equilateral, 0 if degenerate."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    squares = ((b - a) ** 2 + (c - b) ** 2 + (a - c) ** 2).sum(axis=1)
    return np.divide(4 * np.sqrt(3) * area, squares, out=np.zeros(len(faces)), where=squares > 0)


def nonmanifold_edges(faces: Faces) -> int:
    """How many edges have more than two faces, or two that run along them the same way."""
    halfedges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    way, along = np.unique(halfedges, axis=0, return_counts=True)
    edge, around = np.unique(np.sort(halfedges, axis=1), axis=0, return_counts=True)
    bad = np.concatenate([np.sort(way[along > 1], axis=1), edge[around > 2]])
    return len(np.unique(bad, axis=0))


def nonmanifold_vertices(faces: Faces) -> NDArray[np.int64]:
    """The vertices whose faces are not one fan, joined over edges at the vertex."""
    # Corners are joined over the edges at their vertex; a vertex with two classes of corners is pinched.
    label = np.arange(3 * len(faces))
    ends: dict[tuple[int, int], list[int]] = {}
    for corner, vertex in enumerate(faces.ravel().tolist()):
        face, i = divmod(corner, 3)
        for other in (faces[face, (i + 1) % 3], faces[face, (i + 2) % 3]):
            ends.setdefault((vertex, int(other)), []).append(corner)
    joined = np.array([[group[0], other] for group in ends.values() for other in group[1:]], int).reshape(
        -1, 2
    )
    while True:
        new = label.copy()
        np.minimum.at(new, joined[:, 0], label[joined[:, 1]])
        np.minimum.at(new, joined[:, 1], label[joined[:, 0]])
        new = new[new]
        if np.array_equal(new, label):
            break
        label = new
    classes = np.unique(np.stack([faces.ravel(), label], axis=1), axis=0)
    vertex, count = np.unique(classes[:, 0], return_counts=True)
    return vertex[count > 1]
