"""Random holes across ridges of known shapes, and how far their fillings are from the truth.

`benchmarks/holes.py` measures a hundred of each kind.
"""

from __future__ import annotations

import functools

import numpy as np

from . import fill_measures, holed_shapes
from .holed_shapes import Holed, Solid

KINDS = {
    "cube, edge": (holed_shapes.cube, (1, 0, 1), (0, 0.25, 0)),
    "cube, corner": (holed_shapes.cube, (1, 1, 1), (0.05, 0.05, 0.05)),
    "concave edge": (holed_shapes.step, (1, 0.5, 1), (0, 0.1, 0)),
    "roof, bends by 53°": (holed_shapes.roof, (0, 0, 1.5), (0, 0.25, 0)),
    "cylinder, rim": (holed_shapes.cylinder, (0.6, 0.8, 1), (0, 0, 0.075)),
}
"""The solid at a density, the place of the hole, and how far it may be from there."""


@functools.cache
def _solid(kind: str, density: int, irregular: int) -> Solid:
    solid = KINDS[kind][0](density)
    return holed_shapes.irregular(solid, irregular) if irregular else solid


def random_ridge(kind: str, seed: int) -> Holed:
    """A solid of 10 to 28 edges a side, three of five irregular, turned at random, with a random hole.

    The hole is 0.2 to 0.75 wide and at least 2.6 edges, three of ten are longer than wide.
    """
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    density = 2 * int(rng.integers(5, 15))
    radius = max(float(rng.uniform(0.2, 0.75)), 2.6 / density)
    irregular = int(rng.integers(1, 3)) if rng.uniform() < 0.6 else 0
    stretch = float(rng.uniform(1, 2)) if rng.uniform() < 0.3 else 1.0
    _, center, along = KINDS[kind]
    place = np.array(center, float) + rng.uniform(-1, 1) * np.array(along, float)
    solid = _solid(kind, density, irregular)
    return holed_shapes.cut(solid, [(place, radius)], seed + 1, stretch=stretch)


def errors(holed: Holed, vertices: np.ndarray, filling: np.ndarray) -> tuple[float, float, float]:
    """The mean distance of the lost ridge to the filling, of the filling to the truth, the worst quality."""
    points, areas = fill_measures.samples(vertices, filling)
    off, _ = fill_measures.mean_and_rms(holed.distance(points), areas)
    ridge = fill_measures.point_distances(holed.ridge, vertices, filling)
    worst = float(fill_measures.qualities(vertices, filling).min())
    return (float(ridge.mean()) if len(ridge) else 0.0), off, worst
