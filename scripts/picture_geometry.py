"""What a picture of a triangle mesh is made of, in NumPy alone: camera axes, facet colors, lines, dots."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

CLAY = (0.44, 0.47, 0.52)
"""Linear RGB of the surface; a light neutral tone, so that light and shadow both have room."""

# Lights fixed to the camera: direction of the light (right, up, toward the viewer), linear RGB intensity.
# A warm key from above, a cool fill from the other side and a weak one from below make two facets that turn
# differently differ in hue as well as in brightness.
LIGHTS = (
    ((0.55, 0.65, 0.52), (1.30, 1.25, 1.16)),
    ((-0.90, 0.05, 0.43), (0.16, 0.22, 0.32)),
    ((0.25, -0.90, 0.35), (0.16, 0.13, 0.11)),
)
AMBIENT = (0.030, 0.034, 0.045)
BACK_FACE = (1.05, 0.72, 0.60)
"""Factor on the color of faces seen from behind: the inside of an open surface is reddish."""


def camera_axes(view: ArrayLike, up: ArrayLike) -> Array:
    """Rows right, up and toward the viewer, `(3, 3)`, of a camera that stands in direction `view`."""
    toward = np.asarray(view, dtype=float) / np.linalg.norm(view)
    right = np.cross(up, toward)
    if np.linalg.norm(right) < 1e-6:
        raise ValueError("The view direction is parallel to up: choose another up vector.")
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(toward, right), toward])


def face_normals(vertices: Array, faces: Indices) -> Array:
    """Unit normals, `(m, 3)`; zero for faces without area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def facet_colors(normals: Array, axes: Array, base: ArrayLike = CLAY) -> Array:
    """Linear RGB of faces under the lights of the camera, `(m, 3)`; `base` is one color or one per face."""
    seen = normals @ axes.T
    behind = seen[:, 2] < 0
    seen = np.where(behind[:, None], -seen, seen)
    light = np.tile(np.array(AMBIENT), (len(seen), 1))
    for direction, color in LIGHTS:
        cosine = seen @ (np.array(direction) / np.linalg.norm(direction))
        light += np.maximum(cosine, 0.0)[:, None] * np.array(color)
    colors = light * np.asarray(base, dtype=float)
    return np.where(behind[:, None], colors * BACK_FACE, colors)


def ridge_edges(vertices: Array, faces: Indices, degrees: float) -> Indices:
    """Edges `(k, 2)` that bend by more than `degrees`, and all boundary and non-manifold ones."""
    halfedges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    edges, edge_of, counts = np.unique(halfedges, axis=0, return_inverse=True, return_counts=True)
    face_of = np.repeat(np.arange(len(faces)), 3)[np.argsort(edge_of.reshape(-1), kind="stable")]
    first = face_of[np.concatenate([[0], np.cumsum(counts)[:-1]])]
    last = face_of[np.cumsum(counts) - 1]
    normals = face_normals(vertices, faces)
    bend = np.arccos(np.clip((normals[first] * normals[last]).sum(axis=1), -1, 1))
    return edges[(counts != 2) | (bend > np.radians(degrees))]


def ribbons(vertices: Array, edges: Indices, axes: Array, width: float) -> tuple[Array, Indices]:
    """Strips of `width` along edges, turned to the camera and lifted toward it: `(4k, 3)`, `(2k, 3)`."""
    start, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    along = end - start
    along -= np.outer(along @ axes[2], axes[2])
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.divide(along, length, out=np.tile(axes[0], (len(along), 1)), where=length > 0)
    across = np.cross(axes[2], along)
    half = 0.5 * width
    # Lifted by one width, half a strip of a ridge is not swallowed by the face that rises beside it.
    lift = width * axes[2]
    corners = np.stack(
        [
            start - half * (along + across),
            end + half * (along - across),
            end + half * (along + across),
            start - half * (along - across),
        ],
        axis=1,
    )
    quads = np.arange(4 * len(edges)).reshape(-1, 4)
    return (corners + lift).reshape(-1, 3), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


DOT_CORNERS = 16


@dataclass(frozen=True)
class Mark(ABC):
    """What is drawn over a surface, of a linear RGB color, so many pixels wide."""

    places: Array
    color: tuple[float, float, float] = (0.015, 0.017, 0.022)
    pixels: float = 1.6

    @abstractmethod
    def drawn(self, axes: Array, units_per_pixel: float) -> tuple[Array, Indices]:
        """Vertices and faces turned to the camera."""


class Lines(Mark):
    """Segments `(k, 2, 3)`."""

    def drawn(self, axes: Array, units_per_pixel: float) -> tuple[Array, Indices]:
        """Vertices and faces turned to the camera."""
        ends = np.asarray(self.places, dtype=float).reshape(-1, 3)
        edges = np.arange(len(ends)).reshape(-1, 2)
        return ribbons(ends, edges, axes, self.pixels * units_per_pixel)


class Dots(Mark):
    """Points `(k, 3)` as disks."""

    def drawn(self, axes: Array, units_per_pixel: float) -> tuple[Array, Indices]:
        """Vertices and faces turned to the camera, lifted by their own width."""
        angle = 2 * np.pi * np.arange(DOT_CORNERS) / DOT_CORNERS
        width = self.pixels * units_per_pixel
        rim = 0.5 * width * (np.outer(np.cos(angle), axes[0]) + np.outer(np.sin(angle), axes[1]))
        points = np.asarray(self.places, dtype=float)[:, None] + rim + width * axes[2]
        k = np.arange(1, DOT_CORNERS - 1)
        fan = np.stack([np.zeros_like(k), k, k + 1], axis=1)
        faces = DOT_CORNERS * np.arange(len(points))[:, None, None] + fan
        return points.reshape(-1, 3), faces.reshape(-1, 3)
