"""Walls and houses whose parallel sides are set back by an edge or more, for `segment`.

Every shape is made of cubic cells of one edge, so that sides set back by `depth` cells have reveals of so
many rows. Parts are the sides of the exact shape, reveals among them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from . import shapes
from .segment_shapes import Part, parts_by_angle


def solid(filled: NDArray[np.bool_]) -> shapes.Shape:
    """Boundary of the `filled` cells of a grid `(i, j, k)`, two triangles for each exposed cell side."""
    padded = np.pad(filled, 1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    quads = []
    for axis in range(3):
        for step in (0, 1):
            beside = np.roll(padded, 1 - 2 * step, axis=axis)
            corner = np.full((4, 3), step)
            corner[:, [(axis + 1) % 3, (axis + 2) % 3]] = square if step else square[:, ::-1]
            quads.append((np.argwhere(padded & ~beside) - 1)[:, None] + corner)
    points, index = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    a, b, c, d = index.reshape(-1, 4).T
    return points.astype(float), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def _part(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Part:
    return Part(vertices, faces, parts_by_angle(vertices, faces))


def wall(cells: int = 16, depth: int = 1) -> Part:
    """A slab of `cells` by `cells`, two windows set back by `depth`, a plinth that stands out: 18 parts."""
    filled = np.zeros((cells, cells, 4 + 2 * depth), dtype=bool)
    filled[:, :, : 4 + depth] = True
    filled[:, : cells // 4] = True
    a = cells // 8
    for x in (a, cells - 3 * a):
        filled[x : x + 2 * a, cells // 4 + 2 * a : cells // 4 + 4 * a, 4:] = False
    return _part(*solid(filled))


def house(cells: int = 16, depth: int = 1) -> Part:
    """A block with two windows in each wall, a plinth, a flat roof of two levels, all steps of `depth`."""
    d, wide = depth, cells // 8 + 1
    filled = np.zeros((cells + 4 * d, cells + 4 * d, cells + d), dtype=bool)
    core = slice(2 * d, cells + 2 * d)
    filled[core, core, :cells] = True
    filled[core, 2 * d : 2 * d + cells // 2, : cells + d] = True
    filled[d : cells + 3 * d, d : cells + 3 * d, : cells // 4] = True
    height = slice(cells // 2, cells // 2 + 2 * wide)
    for x in (3 * d + 1, cells + d - 1 - wide):
        window = slice(x, x + wide)
        for side in (slice(2 * d, 3 * d), slice(cells + d, cells + 2 * d)):
            filled[window, side, height] = False
            filled[side, window, height] = False
    return _part(*solid(filled))


def gabled(cells: int = 16, depth: int = 1) -> Part:
    """The block of `house` under a gable of 45 degrees, whose two halves differ by a step of `depth`."""
    exact = house(cells, depth)
    vertices = exact.vertices.copy()
    width = vertices[:, 0].max()
    above = vertices[:, 2] > 0.99 * cells
    vertices[above, 2] += 0.5 * width - np.abs(vertices[above, 0] - 0.5 * width)
    return _part(vertices, exact.faces)


def round_wall(cells: int = 16, depth: int = 1) -> Part:
    """The wall bent round an arc of 48 degrees: cylinders set back from each other."""
    flat = wall(cells, depth)
    x, y, z = flat.vertices.T
    radius, angle = 1.2 * cells + z, x / (1.2 * cells)
    return _part(np.column_stack([radius * np.sin(angle), y, radius * np.cos(angle)]), flat.faces)


def irregular(part: Part, seed: int) -> Part:
    """The same surface, its diagonals drawn at random and vertices inside planes moved by up to a quarter."""
    rng = np.random.default_rng(seed)
    half = len(part.faces) // 2
    faces = part.faces.copy()
    (a, b, c), d = part.faces[:half].T, part.faces[half:, 2]
    other = rng.random(half) < 0.5
    faces[:half][other] = np.stack([a, b, d], 1)[other]
    faces[half:][other] = np.stack([b, c, d], 1)[other]
    normals = shapes.vertex_normals(part.vertices, faces)
    corners = np.concatenate([np.stack([faces[:, i], part.truth], 1) for i in range(3)])
    inside = np.bincount(np.unique(corners, axis=0)[:, 0], minlength=len(part.vertices)) == 1
    move = rng.uniform(-0.25, 0.25, part.vertices.shape) * inside[:, None]
    move -= (move * normals).sum(axis=1, keepdims=True) * normals
    return replace(part, vertices=part.vertices + move, faces=faces)


SHAPES: dict[str, Callable[[int, int], Part]] = {
    "wall": wall,
    "house": house,
    "gabled house": gabled,
    "round wall": round_wall,
}
"""By name; each takes the cells along a side and the depth of its steps in cells."""
