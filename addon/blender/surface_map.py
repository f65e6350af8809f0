# SPDX-License-Identifier: GPL-3.0-or-later
"""Where points lie on a triangulated surface: nearest triangle and barycentric coordinates, by chart."""

import numpy as np
from mathutils.bvhtree import BVHTree

SANE = 20
"""Sizes from 2^-20 to 2^20 are measured as they are.

Blender's tree multiplies four lengths in single precision, where 2^128 is past all numbers: on a triangle of
size 1e12 it finds no nearest point at all. It widens its boxes by 1e-7 whatever the size.
"""


def own_unit(places: np.ndarray) -> int:
    """The exponent of the power of two in which places are measured for Blender's tree."""
    exponent = int(np.frexp(np.abs(places).max(initial=0.0))[1])
    return exponent if abs(exponent) > SANE else 0


class SurfaceMap:
    """Finds the nearest point of a triangulated surface, on the whole of it or on one chart.

    Places are measured in a unit of their own, a power of two, in which all sizes have the same digits.
    """

    def __init__(self, coordinates: np.ndarray, triangles: np.ndarray, chart: np.ndarray) -> None:
        """Take a surface of triangles (m, 3) with the chart (m,) of each."""
        self._unit = own_unit(coordinates[triangles])
        self._coordinates = self._measured(coordinates)
        self._triangles = triangles
        self._chart = chart
        vectors = self._coordinates.tolist()
        self._whole = BVHTree.FromPolygons(vectors, triangles.tolist(), all_triangles=True)
        self._parts: dict[int, tuple[BVHTree, np.ndarray]] = {}

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The nearest triangle (k,) of each point (k, 3) and the barycentric coordinates (k, 3) in it."""
        found = [self._whole.find_nearest(point) for point in self._measured(points).tolist()]
        triangle = np.array([hit[2] for hit in found], np.int64)
        return triangle, self._barycentric(triangle, np.array([hit[0][:] for hit in found]).reshape(-1, 3))

    def nearest_on_chart_of(self, triangle: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As `nearest`, but each point (k, 3) looks only on the chart of the triangle (k,) given for it."""
        wanted, points = self._chart[triangle], self._measured(points)
        found = np.empty(len(points), np.int64)
        places = np.empty((len(points), 3))
        for chart in np.unique(wanted).tolist():
            tree, members = self._part(chart)
            rows = np.flatnonzero(wanted == chart)
            hits = [tree.find_nearest(point) for point in points[rows].tolist()]
            found[rows] = members[[hit[2] for hit in hits]]
            places[rows] = [hit[0][:] for hit in hits]
        return found, self._barycentric(found, places)

    def _measured(self, places: np.ndarray) -> np.ndarray:
        return np.ldexp(places, -self._unit)

    def _part(self, chart: int) -> tuple[BVHTree, np.ndarray]:
        if chart not in self._parts:
            members = np.flatnonzero(self._chart == chart)
            used, local = np.unique(self._triangles[members], return_inverse=True)
            tree = BVHTree.FromPolygons(
                self._coordinates[used].tolist(), local.reshape(-1, 3).tolist(), all_triangles=True
            )
            self._parts[chart] = (tree, members)
        return self._parts[chart]

    def _barycentric(self, triangle: np.ndarray, places: np.ndarray) -> np.ndarray:
        a, b, c = (self._coordinates[self._triangles[triangle, corner]] for corner in range(3))
        normal = np.cross(b - a, c - a)
        twice = np.einsum("ij,ij->i", normal, normal)
        weights = np.stack(
            [
                np.einsum("ij,ij->i", np.cross(c - b, places - b), normal),
                np.einsum("ij,ij->i", np.cross(a - c, places - c), normal),
                np.einsum("ij,ij->i", np.cross(b - a, places - a), normal),
            ],
            axis=1,
        )
        # A triangle without area gives its corners equal shares.
        weights = np.where(twice[:, None] > 0, weights, 1.0).clip(0.0, None)
        total = weights.sum(axis=1, keepdims=True)
        return np.where(total > 0, weights / np.where(total > 0, total, 1.0), 1.0 / 3.0)
