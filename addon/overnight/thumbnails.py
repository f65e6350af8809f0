# SPDX-License-Identifier: GPL-3.0-or-later
"""Small pictures of meshes, drawn without a display: shape by its flat faces, color by their materials.

Orthographic, from above and in front. What is not drawn: textures, colors of vertices, curves, modifiers.
"""

import base64
import struct
import zlib
from collections.abc import Iterator, Sequence

import bpy
import numpy as np

from ..blender import mesh_io

SIZE = 120
"""Pixels along a side."""
SAMPLES = 2
"""Samples along the side of a pixel."""
MARGIN = 0.04
"""Of the side, left free around what is there before."""
GRAY = 0.85
BACKGROUND = 1.0
LEVELS = 32
"""Levels of a color that are told apart: flat faces have few, and fewer levels make smaller files."""
RIGHT = np.array([0.8, 0.6, 0.0])
TOWARD = np.array([0.51, -0.68, 0.5268])
"""From what is seen to who sees it."""
UP = np.cross(TOWARD, RIGHT)
LIGHT = (0.3 * RIGHT + 0.6 * UP + 0.9 * TOWARD) / np.linalg.norm([0.3, 0.6, 0.9])
AMBIENT = 0.35
CANDIDATES = 1 << 20
"""Samples that are looked at together: some tens of megabytes."""


class Camera:
    """What sees meshes as large as they are now, and again when they have changed."""

    def __init__(self, objects: Sequence[bpy.types.Object]) -> None:
        """Frame some meshes."""
        corners, _ = _triangles(objects)
        seen = corners.reshape(-1, 3) @ np.stack([RIGHT, UP], axis=1)
        if len(seen) == 0:
            seen = np.zeros((1, 2))
        low, high = seen.min(axis=0), seen.max(axis=0)
        self._middle = 0.5 * (low + high)
        self._scale = (1.0 - 2.0 * MARGIN) / max(float((high - low).max()), 1e-30)

    def picture(self, objects: Sequence[bpy.types.Object]) -> str:
        """A PNG in base 64."""
        corners, colors = _triangles(objects)
        side = SIZE * SAMPLES
        plane = (corners @ np.stack([RIGHT, UP], axis=1) - self._middle) * self._scale
        at = (plane * [1.0, -1.0] + 0.5) * side
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        sound = lengths > 0.0
        # Seen from behind, a face is lit as from the front.
        normals[sound] /= lengths[sound, None]
        normals *= np.sign(normals @ TOWARD)[:, None]
        shades = AMBIENT + (1.0 - AMBIENT) * np.maximum(normals @ LIGHT, 0.0)
        depth = -(corners @ TOWARD) * self._scale
        image = _draw(at[sound], depth[sound], (colors * shades[:, None])[sound], side)
        image = image.reshape(SIZE, SAMPLES, SIZE, SAMPLES, 3).mean(axis=(1, 3))
        levels = np.round(np.clip(image, 0.0, 1.0) * (LEVELS - 1)) * (255.0 / (LEVELS - 1))
        return base64.b64encode(png(np.round(levels).astype(np.uint8))).decode()


def png(image: np.ndarray) -> bytes:
    """An image (height, width, 3) uint8 as a PNG file, which is smaller with a palette of at most 256."""
    height, width, _ = image.shape
    colors, indices = np.unique(image.reshape(-1, 3), axis=0, return_inverse=True)
    has_palette = len(colors) <= 256
    pixels = (indices if has_palette else image).reshape(height, -1).astype(np.uint8)
    # Each row begins with the number of its filter: none.
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels], axis=1)
    kind = 3 if has_palette else 2
    parts = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)),
        *([(b"PLTE", colors.tobytes())] if has_palette else []),
        (b"IDAT", zlib.compress(rows.tobytes(), 9)),
        (b"IEND", b""),
    ]
    chunks = (
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in parts
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def _triangles(objects: Sequence[bpy.types.Object]) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 3, 3) of all triangles in the world, and the colors (m, 3) of their materials."""
    bpy.context.view_layer.update()
    corners, colors = [np.empty((0, 3, 3))], [np.empty((0, 3))]
    for obj in objects:
        mesh = obj.data
        mesh.calc_loop_triangles()
        indices = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", indices)
        slots = np.empty(len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("material_index", slots)
        matrix = np.array(obj.matrix_world, float)
        world = mesh_io.positions(mesh).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        made = world[indices.reshape(-1, 3)]
        finite = np.isfinite(made).all(axis=(1, 2))
        palette = np.full((max(len(obj.material_slots), 1), 3), GRAY)
        for slot, held in enumerate(obj.material_slots):
            if held.material is not None:
                palette[slot] = _displayed(np.array(held.material.diffuse_color[:3]))
        corners.append(made[finite])
        colors.append(palette[np.clip(slots, 0, len(palette) - 1)][finite])
    return np.concatenate(corners), np.concatenate(colors)


def _displayed(linear: np.ndarray) -> np.ndarray:
    """A color of Blender's as screens and PNG files have it: sRGB, which is IEC 61966-2-1."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def _draw(at: np.ndarray, depth: np.ndarray, colors: np.ndarray, side: int) -> np.ndarray:
    """An image (side, side, 3) of triangles: corners (m, 3, 2) in samples, depths (m, 3), colors (m, 3)."""
    image = np.full((side * side, 3), BACKGROUND)
    nearest = np.full(side * side, np.inf)
    for chosen, places, depths in _samples(at, depth, side):
        np.minimum.at(nearest, places, depths)
        seen = depths == nearest[places]
        image[places[seen]] = colors[chosen[seen]]
    return image.reshape(side, side, 3)


def _samples(
    at: np.ndarray, depth: np.ndarray, side: int
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Some triangles at a time: the samples in them, as triangles, places in the image, and depths."""
    low = np.clip(np.ceil(at.min(axis=1) - 0.5), 0, side).astype(int)
    high = np.clip(np.floor(at.max(axis=1) - 0.5), -1, side - 1).astype(int)
    extent = (high - low + 1).min(axis=1, initial=side), (high - low + 1).max(axis=1, initial=0)
    width = 1
    while width < 2 * side:
        group = np.flatnonzero((extent[0] > 0) & (extent[1] <= width) & (extent[1] > width // 2))
        step = max(1, CANDIDATES // (width * width))
        for begin in range(0, len(group), step):
            yield _inside(group[begin : begin + step], at, depth, low, width=width, side=side)
        width *= 2


def _inside(
    chosen: np.ndarray, at: np.ndarray, depth: np.ndarray, low: np.ndarray, *, width: int, side: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    grid = np.stack(np.meshgrid(np.arange(width), np.arange(width)), axis=-1).reshape(1, -1, 2)
    places = low[chosen][:, None] + grid
    p = places + 0.5
    a, b, c = (at[chosen, k][:, None] for k in range(3))

    def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]

    area = cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = np.stack([cross(c - b, p - b), cross(a - c, p - c), cross(b - a, p - a)]) / area
    inside = (weights >= 0.0).all(axis=0) & (places < side).all(axis=-1)
    rows, columns = np.nonzero(inside)
    found = places[rows, columns]
    depths = sum(weights[k][rows, columns] * depth[chosen[rows], k] for k in range(3))
    return chosen[rows], found[:, 1] * side + found[:, 0], depths
