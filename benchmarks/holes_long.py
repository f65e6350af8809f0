"""Sheets with holes whose loops have thousands of vertices."""

from __future__ import annotations

import numpy as np
from known_shapes import shapes
from numpy.typing import NDArray

Arrays = tuple[NDArray, NDArray]
WIDTH = 6
"""Edges across a slit."""
BANDS = 6
"""Rows of faces around the holes that are too large for a whole sheet around them."""


def without(vertices: NDArray, faces: NDArray, removed: NDArray) -> Arrays:
    """A mesh without some faces (m,) bool, and without vertices that no face uses then."""
    used, index = np.unique(faces[~removed], return_inverse=True)
    return vertices[used], index.reshape(-1, 3)


def _folded(vertices: NDArray, middle: float) -> NDArray:
    """A flat sheet bent by a right angle along the line y = middle."""
    beside = np.abs(vertices[:, 1] - middle)
    x, y = vertices[:, 0], vertices[:, 1] - middle
    return np.stack([x, y * np.sqrt(0.5), -beside * np.sqrt(0.5)], axis=1)


def slit(count: int) -> Arrays:
    """A sheet folded along a ridge, with a slit along it."""
    length, width = count // 2, WIDTH // 2 + 5
    vertices, faces = shapes.grid(length + 6, 2 * width)
    middle = vertices[faces].mean(axis=1)
    inside = (np.abs(middle[:, 1] - width) < WIDTH / 2) & (
        np.abs(middle[:, 0] - 0.5 * length - 3) < 0.5 * length - 3
    )
    return without(_folded(vertices, width), faces, inside)


def spiral(count: int) -> Arrays:
    """A sheet folded along a ridge, with a slit that winds around and crosses the ridge over and over."""
    pitch = WIDTH + 10
    turns = np.sqrt(count / (2 * np.pi * pitch))
    angle = np.linspace(np.pi, 2 * np.pi * turns + np.pi, 40 * count)
    size = int(2 * (turns + 1.5) * pitch)
    path = 0.5 * size + (pitch * angle / (2 * np.pi) * np.stack([np.cos(angle), np.sin(angle)])).T
    vertices, faces = shapes.grid(size, size)
    inside = np.zeros((size, size), bool)
    reach = range(-WIDTH // 2, WIDTH // 2 + 1)
    for dx, dy in ((x, y) for x in reach for y in reach if x * x + y * y <= WIDTH**2 / 4):
        inside[tuple((path + np.array([dx, dy])).astype(int).T)] = True
    cell = np.minimum(vertices[faces][..., :2].min(axis=1).astype(int), size - 1)
    return without(_folded(vertices, 0.5 * size + 0.3), faces, inside[tuple(cell.T)])


def _band(loop: NDArray, outward: NDArray) -> Arrays:
    """Rows of faces around a closed loop (k, 3), from which `outward` (k, 3) leads away, an edge long."""
    k = np.arange(len(loop))
    after = (k + 1) % len(loop)
    vertices = np.concatenate([loop + row * outward for row in range(BANDS + 1)])
    quads = np.concatenate(
        [np.stack([k, k + len(k), after + len(k), after], axis=1) + len(k) * row for row in range(BANDS)]
    )
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def ring(count: int) -> Arrays:
    """A flat ring around a round hole whose filling is millions of times as large as its faces."""
    return star(count, rays=0)


def star(count: int, rays: int = 7) -> Arrays:
    """A flat band around a star with round tips."""
    angle = 2 * np.pi * np.arange(40 * count) / (40 * count)
    curve = (1 + 0.4 * np.cos(rays * angle) * (rays > 0)) * np.stack(
        [np.cos(angle), np.sin(angle), 0 * angle]
    )
    along = np.r_[0, np.linalg.norm(np.diff(curve.T, axis=0, append=curve.T[:1]), axis=1).cumsum()]
    at = np.linspace(0, along[-1], count, endpoint=False)
    loop = np.stack([np.interp(at, along, np.r_[row, row[0]]) for row in curve], axis=1) * count / along[-1]
    ahead = np.roll(loop, -1, axis=0) - np.roll(loop, 1, axis=0)
    return _band(loop, np.stack([ahead[:, 1], -ahead[:, 0], 0 * at], axis=1) / 2)


def corner(count: int) -> Arrays:
    """The three sides of a cube around a corner that is cut off by quarters of circles."""
    n = count // 3
    angle = 0.5 * np.pi * np.arange(n) / n
    arc = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    loop = np.concatenate([np.roll(arc, side, axis=1) for side in range(3)])
    radius = n / (0.5 * np.pi)
    # On the sides x, y, z = 0 of a cube whose other points have no positive coordinate.
    return _band(-radius * loop, -loop)


LOOPS = {
    "round hole": ring,
    "star": star,
    "slit along a ridge": slit,
    "spiral over a ridge": spiral,
    "across a corner": corner,
}


def holes_border(name: str, vertices: NDArray, loops: list[NDArray]) -> NDArray:
    """Of the loops of such a sheet, the one around the hole."""
    if name.startswith(("slit", "spiral")):
        ends = vertices[:, 0].min(), vertices[:, 0].max()
        return max((loop for loop in loops if not np.isin(vertices[loop, 0], ends).any()), key=len)
    return min(loops, key=lambda loop: loop.min())
