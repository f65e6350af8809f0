"""Meshes on which the gallery poses its problems: irregular, so that no edges follow a ridge by design."""

from __future__ import annotations

import numpy as np
from known_shapes import shapes
from numpy.typing import NDArray
from scipy.spatial import Delaunay
from workspace import ROOT

Array = NDArray[np.float64]
Shape = tuple[Array, NDArray[np.int64]]

JITTER = 0.3
"""How far inner points leave their lattice, in lattice steps: irregular, yet without slivers."""


def source(name: str) -> Shape:
    """Vertices and faces of a source of the fixtures."""
    with np.load(ROOT / f"blend_fixtures/sources/{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def triangulated(points: Array) -> Shape:
    """Delaunay triangulation of points of the plane `(n, 2)`, in z = 0, counter-clockwise from above."""
    faces = Delaunay(points).simplices.astype(np.int64)
    a, b, c = (points[faces[:, i]] for i in range(3))
    doubled = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces[doubled < 0] = faces[doubled < 0][:, ::-1]
    return np.column_stack([points, np.zeros(len(points))]), faces[np.abs(doubled) > 1e-12]


def irregular_points(n: int, seed: int, jitter: float = JITTER) -> Array:
    """About `n²` jittered points that fill the square [-½, ½]², with the border straight."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(1, n - 1), np.arange(1, n - 1), indexing="ij")
    lattice = np.stack([x + 0.5 * (y % 2) - 0.25, y], axis=-1).reshape(-1, 2)
    inner = (lattice + rng.uniform(-jitter, jitter, lattice.shape)) / (n - 1)
    side = np.arange(n - 1) / (n - 1)
    zero, one = np.zeros(n - 1), np.ones(n - 1)
    border = [(side, zero), (one, side), (1 - side, one), (zero, 1 - side)]
    return np.concatenate([inner, *(np.column_stack(pair) for pair in border)]) - 0.5


def irregular_square(n: int, seed: int = 0, jitter: float = JITTER) -> Shape:
    """Irregular Delaunay mesh of the square [-½, ½]² in z = 0, about `n²` vertices."""
    return triangulated(irregular_points(n, seed, jitter))


def stretched_square(n: int, stretch: float, seed: int = 0) -> Shape:
    """The points of `irregular_square`, triangulated as if y were `stretch` times longer: slivers."""
    points = irregular_points(n, seed)
    vertices, faces = triangulated(points * [1.0, stretch])
    return vertices / [1.0, stretch, 1.0], faces


def catenoid(n: int, seed: int = 0, height: float = 2.0) -> Shape:
    """Catenoid of waist radius 1 about the z axis, from -`height`/2 to `height`/2: about `n²` vertices.

    Its parameters are an isometry up to scale (conformal), so a good mesh of the plane stays one.
    """
    rows = max(4, round(n * height / (2 * np.pi) / np.sqrt(0.75)))
    v, u = np.meshgrid(np.linspace(-0.5, 0.5, rows) * height, np.arange(n), indexing="ij")
    u = 2 * np.pi * (u + 0.5 * (np.arange(rows)[:, None] % 2)) / n
    rng = np.random.default_rng(seed)
    u += JITTER * 2 * np.pi / n * rng.uniform(-1, 1, u.shape)
    v[1:-1] += JITTER * height / (rows - 1) * rng.uniform(-1, 1, v[1:-1].shape)
    vertices = np.stack([np.cosh(v) * np.cos(u), np.cosh(v) * np.sin(u), v], axis=-1).reshape(-1, 3)
    ids = np.arange(rows * n).reshape(rows, n)
    low, right = ids[:-1], np.roll(ids, -1, axis=1)[:-1]
    up, diagonal = ids[1:], np.roll(ids, -1, axis=1)[1:]
    even = np.broadcast_to(np.arange(rows - 1)[:, None] % 2 == 0, low.shape)
    first = np.where(even[..., None], np.stack([low, right, up], -1), np.stack([low, right, diagonal], -1))
    second = np.where(even[..., None], np.stack([right, diagonal, up], -1), np.stack([low, diagonal, up], -1))
    return vertices, np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])


def rolled(vertices: Array) -> Array:
    """The square [-½, ½]² rolled up along x to half a tube: the same lengths, but for chords."""
    angle = np.pi * vertices[:, 0]
    return np.column_stack([np.sin(angle) / np.pi, vertices[:, 1], np.cos(angle) / np.pi])


def refinements(coarsest: Shape, levels: int) -> list[Shape]:
    """A mesh and its midpoint subdivisions: the same surface, ever finer."""
    meshes = [coarsest]
    for _ in range(levels):
        meshes.append(shapes.subdivide(*meshes[-1]))
    return meshes
