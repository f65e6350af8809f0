"""Shapes whose parts are known: what a segmentation should find, with noise and at random rotations.

A `Part` has the vertices, the faces and the part of every face. Parts are the planes and the smoothly curved
sides of a shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from . import shapes

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SMOOTH = np.cos(np.radians(15.0))
"""Parts of the exact shapes meet at 40 degrees and more, the strips of their curved sides at 12 and less."""


@dataclass(frozen=True)
class Part:
    """A mesh `(n,3)`, `(m,3)` and the part of every face `(m,)`, from 0."""

    vertices: Array
    faces: Indices
    truth: Indices

    @property
    def n_parts(self) -> int:
        """How many parts there are."""
        return int(self.truth.max()) + 1

    def turned(self, seed: int) -> Part:
        """The same, at a random rotation."""
        return replace(self, vertices=self.vertices @ shapes.random_rotation(seed).T)

    def noisy(self, share: float, seed: int) -> Part:
        """The same, with Gaussian noise of that share of the mean edge in each coordinate."""
        return replace(self, vertices=shapes.add_noise(self.vertices, self.faces, share, seed))


def parts_by_angle(vertices: Array, faces: Indices) -> Indices:
    """The pieces of an exact shape between its sharp edges, `(m,)`."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    first, second, _ = face_pairs(faces)
    flat = (normals[first] * normals[second]).sum(axis=1) > SMOOTH
    return pieces(len(faces), first[flat], second[flat])


def face_pairs(faces: Indices) -> tuple[Indices, Indices, Indices]:
    """The two faces of every edge that has two, `(k,)` each, and the edges' vertices, `(k,2)`."""
    edges = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    return order[:-1][same] // 3, order[1:][same] // 3, edges[order[1:]][same]


def pieces(count: int, first: Indices, second: Indices) -> Indices:
    """The connected pieces of `count` things joined in pairs, numbered from 0 as they begin."""
    label = np.arange(count)
    while True:
        low = label.copy()
        np.minimum.at(low, first, label[second])
        np.minimum.at(low, second, label[first])
        low = low[low]
        if (low == label).all():
            return np.unique(label, return_inverse=True)[1]
        label = low


def _exact(shape: shapes.Shape) -> Part:
    vertices, faces = shape
    return Part(vertices, faces, parts_by_angle(vertices, faces))


def cube(level: int) -> Part:
    """A cube: 6 parts."""
    return _exact(shapes.cube((8, 16, 32)[level]))


def dodecahedron(level: int) -> Part:
    """A dodecahedron: 12 parts that meet at 63 degrees."""
    return _exact(shapes.dodecahedron(2 + level))


def l_shape(level: int) -> Part:
    """An L of three cubes: 8 parts, one concave edge."""
    return _exact(shapes.l_shape((6, 12, 24)[level]))


def staircase(level: int) -> Part:
    """Three steps: 10 parts, two of them stepped."""
    return _exact(shapes.staircase(3, (6, 12, 24)[level]))


def house(level: int) -> Part:
    """A gabled house: 7 parts, at 45 and 90 degrees."""
    return _exact(shapes.house(3 + level))


def cylinder(level: int) -> Part:
    """A cylinder with caps: 3 parts, one of them curved."""
    return _exact(shapes.cylinder(*((48, 15, 8), (96, 30, 16), (192, 60, 32))[level]))


def fan(level: int) -> Part:
    """A fan-like machine part, a sector of a stepped disk with a pocket: planes, cones and cylinders."""
    cells = [(i, j, 0) for i in range(4) for j in range(3)]
    cells += [(i, j, 1) for i in (0, 1) for j in range(3)] + [(2, 1, 1)]
    cells.remove((3, 2, 0))
    vertices, faces = shapes.voxels(cells, (6, 12, 24)[level])
    x, y, z = vertices.T
    radius, angle = 0.9 + 0.3 * x, np.radians(32.0) * y
    height = 0.32 * z + 0.06 * z * (4 - x)
    return _exact((np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]), faces))


SHAPES: dict[str, Callable[[int], Part]] = {
    "cube": cube,
    "dodecahedron": dodecahedron,
    "L-shape": l_shape,
    "staircase": staircase,
    "gabled house": house,
    "cylinder with caps": cylinder,
    "fan part": fan,
}
"""By their names in the table; each takes a level of 0, 1 or 2, four times the faces from one to the next."""

NOISES = (0.0, 0.1, 0.2)
LEVELS = (0, 1, 2)


def adjusted_rand_index(first: Indices, second: Indices) -> float:
    """How far two labellings agree: 1 if they are the same, 0 by chance (Hubert and Arabie 1985)."""
    pairs = lambda counts: (counts * (counts - 1.0) / 2.0).sum()  # noqa: E731
    joint = np.unique(np.stack([first, second]), axis=1, return_counts=True)[1]
    together = pairs(joint)
    of_first = pairs(np.unique(first, return_counts=True)[1])
    of_second = pairs(np.unique(second, return_counts=True)[1])
    chance = of_first * of_second / pairs(np.array([len(first)]))
    most = 0.5 * (of_first + of_second)
    return 1.0 if most == chance else float((together - chance) / (most - chance))
