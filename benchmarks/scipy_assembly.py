"""The Hessian of Rowe et al. 2024, eq. (30), assembled with vectorized NumPy and SciPy.

For closed or open manifold meshes with consistent orientation and no degenerate face; barycentric dual edges.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse


def twins(faces: NDArray[np.int64], n_vertices: int) -> NDArray[np.int64]:
    """The twin of each halfedge `3 f + i` (opposite corner `i`), `-1` on the boundary."""
    tail, head = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    key, wanted = tail * n_vertices + head, head * n_vertices + tail
    order = np.argsort(key)
    place = np.minimum(np.searchsorted(key, wanted, sorter=order), len(key) - 1)
    found = order[place]
    return np.where(key[found] == wanted, found, -1)


def entries(
    lengths: NDArray[np.float64], faces: NDArray[np.int64], twin: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Values, rows and columns of `H` (rows `xx, xy, yx, yy` of each face, times its area), with repeats."""
    a, b, c = np.sort(lengths, axis=1)[:, ::-1].T
    area = 0.25 * np.sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)))
    length = lengths.ravel()
    before, after = lengths[:, [2, 0, 1]].ravel(), lengths[:, [1, 2, 0]].ravel()
    foot = (length**2 + before**2 - after**2) / (2 * length)
    height = 2 * np.repeat(area, 3) / length
    inner = np.flatnonzero(twin >= 0)
    mate, face, edge = twin[inner], inner // 3, length[inner]

    # The face's frame: x along halfedge 2. Its other halfedges from the apex of that one.
    s, h = foot[2::3], height[2::3]
    direction = np.empty((len(faces), 3, 2))
    direction[:, 0] = np.stack([(s - lengths[:, 2]) / lengths[:, 0], h / lengths[:, 0]], axis=1)
    direction[:, 1] = np.stack([-s / lengths[:, 1], -h / lengths[:, 1]], axis=1)
    direction[:, 2] = [1.0, 0.0]
    cosine, sine = direction.reshape(-1, 2)[inner].T

    s_f, h_f = foot[inner], height[inner]
    s_g, h_g = edge - foot[mate], height[mate]
    along, across = (s_g - s_f) / 3, -(h_f + h_g) / 3
    x, y = cosine * along - sine * across, sine * along + cosine * across
    scale = area[face] * across / (along**2 + across**2) ** 2
    tensor = scale * np.stack([x * x, x * y, x * y, y * y])
    to_head = (s_f / h_f + s_g / h_g) / edge
    jump = np.stack([1 / h_f + 1 / h_g - to_head, to_head, -1 / h_f, -1 / h_g])

    tail, head = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    stencil = np.stack([tail[inner], head[inner], faces.ravel()[inner], faces.ravel()[mate]])
    values = tensor[:, None] * jump[None]
    rows = np.broadcast_to((4 * face + np.arange(4)[:, None])[:, None], values.shape)
    columns = np.broadcast_to(stencil[None], values.shape)
    return values.ravel(), rows.ravel(), columns.ravel()


def edge_lengths(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Edge lengths `(m, 3)`, column `i` opposite corner `i`."""
    corners = vertices[faces]
    return np.linalg.norm(corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]], axis=2)


def hessian(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> sparse.csr_array:
    """`H` (`4m x n`) from positions and faces."""
    twin = twins(faces, len(vertices))
    values, rows, columns = entries(edge_lengths(vertices, faces), faces, twin)
    return sparse.csr_array((values, (rows, columns)), shape=(4 * len(faces), len(vertices)))


class Pattern:
    """The places of all entries, found once per connectivity, for values from new lengths."""

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
        """Find twins and places."""
        self.faces, self.twin = faces, twins(faces, len(vertices))
        _, rows, columns = entries(edge_lengths(vertices, faces), faces, self.twin)
        place, self.inverse = np.unique(rows * len(vertices) + columns, return_inverse=True)
        self.n_entries = len(place)

    def values(self, lengths: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values of the CSR matrix for the given edge lengths."""
        return np.bincount(self.inverse, entries(lengths, self.faces, self.twin)[0], self.n_entries)
