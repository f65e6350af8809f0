"""The surface Hessian again, dense, from positions and by rotating faces in space: an independent yardstick.

Nothing here is shared with the package: gradients are vectors in space, the hinge map is a rotation about the
shared edge, and only the last step expresses a direction in the face's frame. Cost and memory are quadratic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def _gradient(corners: Floats) -> Floats:
    """Gradients (3,3) of the three hat functions of a triangle: row i that of corner i."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    opposite = np.roll(corners, -2, axis=0) - np.roll(corners, -1, axis=0)
    return np.cross(normal, opposite) / (normal @ normal)


def _center(corners: Floats, dual: str) -> Floats:
    """Barycenter or circumcenter of a triangle in space."""
    if dual == "barycentric":
        return corners.mean(axis=0)
    p, q = corners[1] - corners[0], corners[2] - corners[0]
    system = np.array([2 * p, 2 * q, np.cross(p, q)])
    return corners[0] + np.linalg.solve(system, [p @ p, q @ q, 0.0])


def _unfolding(edge: Floats, normal_from: Floats, normal_to: Floats) -> Floats:
    """The rotation (3,3) about a shared edge that turns one unit normal into the other: the hinge map."""
    axis = edge / np.linalg.norm(edge)
    frame_from = np.array([axis, normal_from, np.cross(axis, normal_from)])
    frame_to = np.array([axis, normal_to, np.cross(axis, normal_to)])
    return frame_to.T @ frame_from


def dense_hessian(vertices: Floats, faces: NDArray[np.integer], dual: str = "barycentric") -> Floats:
    """The matrix (4m,n) of Rowe et al. 2024, eq. (30), for manifold, consistently oriented meshes."""
    n, m = len(vertices), len(faces)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    normals /= 2 * areas[:, None]
    gradients = np.zeros((m, 3, n))
    for f in range(m):
        gradients[f][:, faces[f]] = _gradient(corners[f]).T
    halfedges = {(faces[f][(i + 1) % 3], faces[f][(i + 2) % 3]): f for f in range(m) for i in range(3)}
    hessian = np.zeros((4 * m, n))
    for (tail, head), f in halfedges.items():
        g = halfedges.get((head, tail))
        if g is None:
            continue
        unfold = _unfolding(vertices[head] - vertices[tail], normals[g], normals[f])
        center = vertices[tail] + unfold @ (_center(corners[g], dual) - vertices[tail])
        across = center - _center(corners[f], dual)
        length = np.linalg.norm(across)
        direction = across / length
        jump = unfold @ gradients[g] - gradients[f]
        x = corners[f][1] - corners[f][0]
        frame = np.array([x / np.linalg.norm(x), np.cross(normals[f], x / np.linalg.norm(x))])
        planar = frame @ direction
        hessian[4 * f : 4 * f + 4] += areas[f] * np.outer(np.outer(planar, planar), direction @ jump / length)
    return hessian


def block_norms(rows: Floats, columns: Floats, *, joint: bool = True) -> Floats:
    """Frobenius norms of the blocks of four rows of `rows @ columns`: (m,) joint, (m,k) one a column."""
    blocks = (rows @ columns.reshape(len(columns), -1)).reshape(len(rows) // 4, 4, -1)
    per_column = np.sqrt((blocks**2).sum(axis=1))
    return np.sqrt((per_column**2).sum(axis=1)) if joint else per_column
