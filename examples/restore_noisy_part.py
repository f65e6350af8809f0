"""Remove scanning noise from a machined part: planes come out flat, and their edges stay sharp.

    python restore_noisy_part.py

A cube with noise stands in for the scan, so that the error can be measured.
"""

import numpy as np
import ridgeform


def cube(n):
    """A cube of side 2, each side a grid of n x n squares: vertices (v,3) and triangles (f,3)."""
    steps = np.linspace(-1, 1, n + 1)
    u, v = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    a = ((n + 1) * np.arange(n)[:, None] + np.arange(n)).ravel()
    grid = np.concatenate([np.stack([a, a + n + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + 1], 1)])
    points, faces = [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            at = np.insert(np.stack([u, v], 1), axis, side, axis=1)
            outward = side > 0 if axis != 1 else side < 0
            faces.append((grid if outward else grid[:, ::-1]) + len(points) * len(u))
            points.append(at)
    vertices, merged = np.unique(np.round(np.concatenate(points), 9), axis=0, return_inverse=True)
    return vertices, merged.ravel()[np.concatenate(faces)]


def distance_to_cube(points):
    """Root mean square distance of points to the true surface."""
    return np.sqrt(np.mean((np.abs(points).max(axis=1) - 1) ** 2))


vertices, faces = cube(12)
noisy = vertices + np.random.default_rng(1).normal(scale=0.015, size=vertices.shape)
restored = ridgeform.stylize(ridgeform.Mesh(noisy, faces), iterations=12, fidelity=500.0, sharpness=0.5)

before, after = distance_to_cube(noisy), distance_to_cube(restored.vertices)
print(f"RMS distance to the true part: {before:.4f} before, {after:.4f} after")
