"""True functions with known ridges, on the plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TURN = np.radians(26.0)
"""No ridge of a function on the plane follows an axis, a diagonal or a direction of the lattice."""


def turned(vertices: Array, angle: float = TURN) -> tuple[Array, Array]:
    """Coordinates `(x, y)` of vertices in axes turned by `angle` (radians) about z."""
    x, y = vertices[:, 0], vertices[:, 1]
    return np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x


def ramp(vertices: Array) -> Array:
    """Flat, a slope of 1 from -0.2 to 0.2, flat: two straight ridges."""
    return np.clip(turned(vertices)[0], -0.2, 0.2) + 0.2


def cone(vertices: Array) -> Array:
    """Cone of radius 0.4 and slope 1 on the plane z = 0."""
    return np.maximum(0.4 - np.hypot(vertices[:, 0], vertices[:, 1]), 0.0)


def cathedral(vertices: Array) -> Array:
    """Nave, transept, crossing tower, two spires, and an apse of half a cone, over flat ground; 0.42 high."""
    x, y = turned(vertices)
    nave = np.minimum(0.24 - 1.4 * np.abs(y), 3.0 * (0.38 - np.abs(x + 0.05)))
    transept = np.minimum(0.20 - 1.4 * np.abs(x - 0.08), 3.0 * (0.32 - np.abs(y)))
    tower = 0.42 - 2.6 * np.maximum(np.abs(x - 0.08), np.abs(y))
    spires = 0.36 - 2.6 * np.hypot(x + 0.34, np.abs(y) - 0.15)
    apse = 0.20 - 1.2 * np.hypot(x - 0.30, y)
    return np.max([np.zeros_like(x), nave, transept, tower, spires, apse], axis=0)


def roof(vertices: Array, angle: float = TURN) -> Array:
    """Two slopes that meet in one straight ridge through the middle, and one more fold across a corner."""
    x, y = turned(vertices, angle)
    return np.minimum(0.5 - np.abs(x), 0.62 - 0.55 * (x + y))
