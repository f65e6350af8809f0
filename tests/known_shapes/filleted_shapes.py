"""Boxes and cylinders with rounded and beveled edges, and which face is what."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import ridgeform

from .segment_shapes import Part

Box = tuple[float, float, float]
Zones = Callable[[np.ndarray], np.ndarray]


def filleted_box(size: Box, radius: float, steps: int) -> Part:
    """A box as a kernel tessellates it, two triangles a side, its edges rounded in so many steps of one row;
    the truth has 6 sides, 12 fillets, and 8 corners.
    """
    half = np.array(size) / 2.0
    offsets = radius * np.tan(np.linspace(0.0, np.pi / 4.0, steps // 2 + 1))
    lines = [np.concatenate([-inner - offsets[::-1], inner + offsets]) for inner in half - radius]
    vertices, faces = _grid_box(lines, half)
    inner = np.clip(vertices, radius - half, half - radius)
    out = vertices - inner
    vertices = inner + radius * out / np.linalg.norm(out, axis=1, keepdims=True)
    return Part(vertices, faces, zones_of_box(size, radius)(vertices[faces].mean(axis=1)))


def _grid_box(lines: list[np.ndarray], half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The surface of a box with these lines along its axes."""
    points, faces, count = [], [], 0
    for axis, sign in itertools.product(range(3), (-1.0, 1.0)):
        first, second = ((axis + k) % 3 for k in (1, 2))
        u, v = np.meshgrid(lines[first], lines[second], indexing="ij")
        side = np.empty((u.size, 3))
        side[:, axis], side[:, first], side[:, second] = sign * half[axis], u.ravel(), v.ravel()
        at = count + np.arange(u.size).reshape(u.shape)
        a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
        triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        points.append(side)
        faces.append(triangles if sign > 0 else triangles[:, ::-1])
        count += u.size
    vertices, place = np.unique(np.round(np.concatenate(points), 9), axis=0, return_inverse=True)
    return vertices, place.reshape(-1)[np.concatenate(faces)]


def zones_of_box(size: Box, radius: float) -> Zones:
    """Beside which sides of the inner box points are: a number for each of the 26 faces of a filleted one."""

    def zones(points: np.ndarray) -> np.ndarray:
        inner = np.array(size) / 2.0 - radius
        out = np.where(np.abs(points) > inner, np.sign(points), 0.0)
        return np.unique(out, axis=0, return_inverse=True)[1].reshape(-1)

    return zones


def chamfered_box(size: Box, width: float) -> Part:
    """A box with beveled edges: 6 sides, 12 bevels, and 8 corners, each a polygon cut into triangles."""
    half = np.array(size) / 2.0
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    vertices = np.concatenate([corners * (half - width * (np.arange(3) != axis)) for axis in range(3)])
    polygons = []
    for normal in itertools.product((-1.0, 0.0, 1.0), repeat=3):
        if any(normal):
            reach = vertices @ np.array(normal)
            polygons.append(np.flatnonzero(reach > reach.max() - 1e-9))
    faces, truth = [], []
    for label, polygon in enumerate(polygons):
        center = vertices[polygon].mean(axis=0)
        across = np.linalg.svd(vertices[polygon] - center)[2]
        turned = (vertices[polygon] - center) @ across.T
        around = polygon[np.argsort(np.arctan2(turned[:, 1], turned[:, 0]))]
        a, b, c = vertices[around[:3]]
        if np.cross(b - a, c - a) @ center < 0.0:
            around = around[::-1]
        for k in range(1, len(around) - 1):
            faces.append([around[0], around[k], around[k + 1]])
            truth.append(label)
    return Part(vertices, np.array(faces), np.array(truth))


def filleted_cylinder(radius: float, height: float, fillet: float, around: int = 96, steps: int = 12) -> Part:
    """A cylinder whose upper rim is rounded: bottom, side, fillet, and top."""
    turns = np.linspace(0.0, np.pi / 2.0, steps + 1)
    inner = radius - fillet
    rim = np.column_stack([inner + fillet * np.cos(turns), height - fillet + fillet * np.sin(turns)])
    profile = np.concatenate([[[radius, 0.0]], rim])
    angles = 2.0 * np.pi * np.arange(around) / around
    rings = np.stack(
        [np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(around, z)]) for r, z in profile]
    )
    vertices = np.concatenate([rings.reshape(-1, 3), [[0.0, 0.0, 0.0], [0.0, 0.0, height]]])
    faces, truth = [], []
    here, there = np.arange(around), (np.arange(around) + 1) % around
    for k in range(len(profile) - 1):
        a, b = k * around + here, k * around + there
        faces += [np.column_stack([a, b, b + around]), np.column_stack([a, b + around, a + around])]
        truth += [1 if k == 0 else 2] * (2 * around)
    last = (len(profile) - 1) * around
    faces.append(np.column_stack([there, here, np.full(around, len(vertices) - 2)]))
    faces.append(np.column_stack([last + here, last + there, np.full(around, len(vertices) - 1)]))
    truth += [0] * around + [3] * around
    return Part(vertices, np.concatenate(faces), np.array(truth))


def zones_of_cylinder(radius: float, height: float, fillet: float) -> Zones:
    """On which of the four faces of a cylinder with a rounded rim points are."""

    def zones(points: np.ndarray) -> np.ndarray:
        out, up = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        is_top, is_round = out < radius - fillet, up > height - fillet
        return np.select([up < 1e-3 * height, is_top & is_round, is_round], [0, 3, 2], 1)

    return zones


def remeshed(part: Part, zones: Zones, edge: float, noise: float = 0.0, seed: int = 5) -> Part:
    """The same with even triangles and noise, the truth by where their centers are."""
    found = ridgeform.remesh(ridgeform.Mesh(part.vertices, part.faces), edge_length=edge)
    faces = np.asarray(found.faces)
    truth = zones(found.vertices[faces].mean(axis=1))
    return Part(found.vertices, faces, truth).noisy(noise, seed)
