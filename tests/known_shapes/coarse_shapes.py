"""Shapes modeled by hand: a few large flat polygons, cut into triangles as a modeler's program cuts them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .segment_shapes import Part, parts_by_angle

Polygons = Sequence[Sequence[int]]


def from_polygons(vertices: np.ndarray, polygons: Polygons) -> Part:
    """Convex polygons as fans of triangles; parts end at edges of more than 15 degrees."""
    faces = _fans(polygons)
    return Part(vertices, faces, parts_by_angle(vertices, faces))


def box(size: Sequence[float] = (1.0, 1.0, 1.0)) -> Part:
    """A box of 12 triangles with these sides, centered: 6 parts."""
    return from_polygons(*_box(size))


def prism(sides: int, height: float = 2.0) -> Part:
    """A regular prism of radius 1, capped by polygons: 3 parts from 25 sides on, else two more than sides."""
    angles = 2 * np.pi * np.arange(sides) / sides
    return from_polygons(*_prism(np.column_stack([np.cos(angles), np.sin(angles)]), height, [range(sides)]))


def clamped_prism(sides: int) -> Part:
    """A prism whose upright edges have a bevel of width 0, as where two bevels leave no room."""
    turn = np.repeat(2 * np.pi * np.arange(sides) / sides, 2)
    outline = np.column_stack([np.cos(turn), np.sin(turn)])
    vertices, polygons = _prism(outline, 2.0, [range(len(outline))])
    faces = _fans(polygons)
    return Part(vertices, faces, np.zeros(len(faces), int))


def l_prism() -> Part:
    """An L of three cubes in 20 triangles: 8 parts."""
    outline = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], dtype=float)
    return from_polygons(*_prism(outline, 1.0, [(0, 1, 2, 3), (0, 3, 4, 5)]))


def house(chimney: bool = False) -> Part:
    """A gabled house of 16 triangles, 7 parts; with a chimney stuck into its roof 6 more."""
    x, y, eaves, ridge = 4.0, 3.0, 2.5, 4.0
    floor = [(0, 0), (x, 0), (x, y), (0, y)]
    vertices = (
        [(*p, 0.0) for p in floor] + [(*p, eaves) for p in floor] + [(0, y / 2, ridge), (x, y / 2, ridge)]
    )
    walls = [(3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 6, 9, 5), (2, 3, 7, 6), (3, 0, 4, 8, 7)]
    polygons = [*walls, (4, 5, 9, 8), (6, 7, 8, 9)]
    points = np.array(vertices, dtype=float)
    if chimney:
        corners, sides = _box((0.4, 0.4, 1.0))
        polygons += [tuple(v + len(points) for v in side) for side in sides]
        points = np.vstack([points, corners + np.array([1.0, 0.8, 3.8])])
    return from_polygons(points, polygons)


def boss(width: float) -> Part:
    """A cube of side 2 with a small box of this width grown out of its top: 11 parts."""
    points, polygons = _box((2.0, 2.0, 2.0))
    top = polygons.pop(5)
    inset = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * width / 2
    lower, upper = len(points), len(points) + 4
    for i in range(4):
        j = (i + 1) % 4
        polygons.append((top[i], top[j], lower + j, lower + i))
        polygons.append((lower + i, lower + j, upper + j, upper + i))
    polygons.append(tuple(range(upper, upper + 4)))
    rings = [np.column_stack([inset, np.full(4, height)]) for height in (1.0, 1.0 + width)]
    return from_polygons(np.vstack([points, *rings]), polygons)


def city(houses: int) -> Part:
    """That many separate boxes of different sizes in a row: 6 parts each."""
    sizes = np.random.default_rng(5).uniform(0.3, 1.0, (houses, 3))
    points, polygons = [], []
    for i, size in enumerate(sizes):
        corners, sides = _box(size)
        points.append(corners + np.array([2.0 * i, 0.0, 0.0]))
        polygons += [tuple(v + 8 * i for v in side) for side in sides]
    return from_polygons(np.vstack(points), polygons)


def _box(size: Sequence[float]) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    corners = np.array(
        [(x, y, z) for z in (-0.5, 0.5) for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    )
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    return corners * size, [*sides, (3, 2, 1, 0), (4, 5, 6, 7)]


def _prism(outline: np.ndarray, height: float, caps: Polygons) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    n = len(outline)
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (0.0, height)])
    polygons = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    polygons += [tuple(reversed(cap)) for cap in caps] + [tuple(n + i for i in cap) for cap in caps]
    return vertices, polygons


def _fans(polygons: Polygons) -> np.ndarray:
    return np.array([(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)])
