# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeping the enclosed volume."""

import numpy as np

LARGEST_FACTOR = 4.0
"""Beyond this the shape has collapsed, and blowing up what is left of it would only hide that."""


def is_closed(triangles: np.ndarray, n_vertices: int) -> bool:
    """Whether triangles (m, 3) are closed: every edge has two faces, which run along it in opposite ways."""
    starts = triangles.astype(np.int64)
    ends = np.roll(starts, -1, axis=1)
    forward = np.sort((starts * n_vertices + ends).ravel())
    backward = np.sort((ends * n_vertices + starts).ravel())
    return bool((forward[1:] != forward[:-1]).all() and np.array_equal(forward, backward))


def volume_and_centroid(coordinates: np.ndarray, triangles: np.ndarray) -> tuple[float, np.ndarray]:
    """The signed volume that closed triangles (m, 3) enclose, and the centroid (3,) of the solid."""
    coordinates = coordinates.astype(np.float64)
    middle = coordinates.mean(axis=0)
    a, b, c = (coordinates[triangles[:, corner]] - middle for corner in range(3))
    parts = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    volume = float(parts.sum())
    if volume == 0.0:
        return 0.0, middle
    return volume, middle + ((a + b + c) * parts[:, None]).sum(axis=0) / (4.0 * volume)


def keep_volume(
    before: np.ndarray, after: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, str | None]:
    """Scale coordinates `after` (n, 3) about their centroid to the volume of `before`.

    Returns the coordinates and `None`, or `after` unchanged and the reason why it cannot be done.
    """
    if not is_closed(triangles, len(before)):
        return (
            after,
            "the volume was not kept, because the mesh is open or its faces disagree on the outside",
        )
    wanted, _ = volume_and_centroid(before, triangles)
    reached, centroid = volume_and_centroid(after, triangles)
    if wanted == 0.0 or reached / wanted <= LARGEST_FACTOR**-3:
        return after, "the volume was not kept, because hardly any is left"
    factor = (wanted / reached) ** (1.0 / 3.0)
    return centroid + factor * (after - centroid), None
