"""One scan-like shape at any density: a ring with relief, clean, or under noise of a tenth of an edge."""

import numpy as np
from numpy.typing import NDArray

RELIEF = np.random.default_rng(7).normal(size=(24, 4))
"""Strength, phase, and frequencies of the waves that its relief is made of."""

NOISE = 0.1


def ring(n_vertices: int, noise: float) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """About so many vertices, and the triangles."""
    rows = round((n_vertices / 2.5) ** 0.5)
    columns = round(2.5 * rows)
    u, v = np.meshgrid(
        2.0 * np.pi * np.arange(columns) / columns, 2.0 * np.pi * np.arange(rows) / rows, indexing="ij"
    )
    radius = np.full_like(u, 0.4)
    for strength, phase, a, b in RELIEF:
        radius += 0.012 * strength * np.sin(np.rint(4.0 * a) * u + np.rint(3.0 * b) * v + 6.0 * phase)
    across = 1.0 + radius * np.cos(v)
    points = np.stack([across * np.cos(u), across * np.sin(u), radius * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij")
    names = [((i + a) % columns * rows + (j + b) % rows).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.concatenate([np.stack([names[0], names[k], names[k + 1]], 1) for k in (1, 2)])
    edge = np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1).mean()
    points += np.random.default_rng(1).normal(scale=noise * edge, size=points.shape)
    return points, faces.astype(np.int32)
