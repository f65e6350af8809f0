"""A group of buildings as an aerial scan has it: gabled and flat blocks, noise, missing parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ridgeform
from known_shapes import shapes
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

CELLS = 90
"""Cells of the grid from which the walls rise, along each side."""
SIDE = 10.0
EDGE = 0.12
"""Edge length of the scan; the smallest roof is 1.6 by 1.2."""
NOISE = 0.1
"""Standard deviation of the noise, as a share of the mean edge."""
GAPS = 14
"""Places where the scan saw nothing."""


@dataclass(frozen=True)
class Block:
    """A building: center, half sides, turn in degrees, height of the eaves, rise of the ridge."""

    center: tuple[float, float]
    half: tuple[float, float]
    turn: float
    eaves: float
    rise: float

    def height(self, x: Array, y: Array) -> Array:
        """Height of the roof over points of the ground, 0 outside."""
        angle = np.radians(self.turn)
        x, y = x - self.center[0], y - self.center[1]
        along, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
        inside = (np.abs(along) <= self.half[0]) & (np.abs(across) <= self.half[1])
        return inside * (self.eaves + self.rise * (1 - np.abs(across) / self.half[1]))


BLOCKS = (
    Block((-2.6, 2.2), (1.7, 0.9), 20, 1.1, 0.8),
    Block((-1.7, 0.4), (0.8, 1.2), 20, 1.1, 0.0),
    Block((2.2, 2.6), (1.3, 0.8), -15, 0.8, 0.7),
    Block((3.1, 0.3), (0.8, 0.6), 70, 0.6, 0.5),
    Block((0.6, -2.4), (2.2, 1.0), 5, 1.4, 0.9),
    Block((-3.2, -2.6), (0.9, 0.9), 40, 1.9, 0.0),
    Block((3.5, -2.9), (0.8, 0.7), -30, 0.7, 0.6),
)


def buildings(seed: int = 0) -> tuple[Array, Indices]:
    """Vertices and faces of the scan, z up."""
    line = np.linspace(-0.5 * SIDE, 0.5 * SIDE, CELLS + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    z = np.max([block.height(x, y) for block in BLOCKS], axis=0)
    _, faces = shapes.grid(CELLS, CELLS)
    vertices = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    even = ridgeform.remesh(ridgeform.Mesh(vertices, faces), edge_length=EDGE, feature_angle=30.0)
    vertices, faces = np.array(even.vertices), even.faces.astype(np.int64)
    vertices = shapes.add_noise(vertices, faces, NOISE, seed)
    rng = np.random.default_rng(seed)
    gaps = rng.uniform(-0.45 * SIDE, 0.45 * SIDE, (GAPS, 2))
    radius = rng.uniform(1.0, 3.5, GAPS) * EDGE
    centers = vertices[faces].mean(axis=1)
    away = np.linalg.norm(centers[:, None, :2] - gaps, axis=2)
    faces = faces[(away > radius).all(axis=1)]
    used, renamed = np.unique(faces, return_inverse=True)
    return vertices[used], renamed.reshape(-1, 3)
