"""The classes of scalar problems: from a mesh to a problem, each with its fixed data, noise and weights.

The function spans 1 on a mesh whose longest side is 1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from problems import SEED, Mesh, Problem

LIGHT, HEAVY = (0.02, 1e5), (0.2, 1e3)
"""Standard deviation of the noise, and fidelity weight."""

HOLE = 0.1
"""Part of the vertices that the hole takes."""

LEAST_WEIGHT = 1e-6
"""Weights fall to this across ridges, as the squares of a segmentation's indicator do."""

KINKS = np.array([[1.0, 0.0, 0.3], [0.0, 1.0, -0.5], [0.0, 0.0, 1.0]])
OFFSETS = np.array([0.0, 0.0, 0.1])
"""The function has ridges where the products of position and `KINKS` are the `OFFSETS`."""


def ridged(mesh: Mesh) -> NDArray[np.float64]:
    """A continuous function of the position, piecewise linear with ridges across the whole mesh; spans 1."""
    x, y, z = mesh.vertices.T
    values = np.abs(x + 0.3 * z) + np.maximum(y, 0.5 * z) - 0.4 * np.abs(z - 0.1)
    used = values[mesh.used()]
    return (values - used.min()) / np.ptp(used)


def _noisy(values: NDArray[np.float64], deviation: float) -> NDArray[np.float64]:
    return values + deviation * np.random.default_rng(SEED).standard_normal(len(values))


def points(count: int) -> Callable[[Mesh], Problem]:
    """Values known at `count` random vertices."""

    def make(mesh: Mesh) -> Problem:
        used = mesh.used()
        some = np.random.default_rng(SEED).choice(used, min(count, len(used) // 2), replace=False)
        return Problem(mesh.name, mesh.vertices, mesh.faces, ridged(mesh), np.sort(some))

    return make


def hole(mesh: Mesh) -> Problem:
    """Values known everywhere but around a point where ridges cross."""
    used = mesh.used()
    off_the_ridges = np.abs(mesh.vertices[used] @ KINKS.T - OFFSETS)
    center = mesh.vertices[used[np.argmin(off_the_ridges[:, :2].sum(axis=1))]]
    away = np.linalg.norm(mesh.vertices[used] - center, axis=1)
    known = used[away > np.quantile(away, HOLE)]
    return Problem(mesh.name, mesh.vertices, mesh.faces, ridged(mesh), known)


def noise(deviation: float, fidelity: float) -> Callable[[Mesh], Problem]:
    """Normal noise, and a fidelity that fits it."""

    def make(mesh: Mesh) -> Problem:
        values = _noisy(ridged(mesh), deviation)
        return Problem(mesh.name, mesh.vertices, mesh.faces, values, fidelity=fidelity)

    return make


def weighted(mesh: Mesh) -> Problem:
    """Light noise; ridges cost next to nothing within two edge lengths of where they are."""
    corners = mesh.vertices[mesh.faces]
    edge = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1).mean()
    away = np.abs(corners.mean(axis=1) @ KINKS.T - OFFSETS).min(axis=1) / (2 * edge)
    weights = np.clip(away**2, LEAST_WEIGHT, 1.0)
    values = _noisy(ridged(mesh), LIGHT[0])
    return Problem(mesh.name, mesh.vertices, mesh.faces, values, weights=weights, fidelity=HEAVY[1])


def constrained(mesh: Mesh) -> Problem:
    """Heavy noise; the mean over every octant is known, and so are three differences."""
    used, clean = mesh.used(), ridged(mesh)
    octant = (mesh.vertices > 0) @ [1, 2, 4]
    rows = []
    for number in np.unique(octant[used]):
        inside = used[octant[used] == number]
        rows.append(np.zeros(len(clean)))
        rows[-1][inside] = 1 / len(inside)
    for pair in np.random.default_rng(SEED).choice(used, (3, 2), replace=False):
        rows.append(np.zeros(len(clean)))
        rows[-1][pair] = 1.0, -1.0
    matrix = np.array(rows)
    values = _noisy(clean, HEAVY[0])
    return Problem(
        mesh.name, mesh.vertices, mesh.faces, values, constraints=(matrix, matrix @ clean), fidelity=HEAVY[1]
    )


def coordinates(mesh: Mesh) -> Problem:
    """The positions themselves, one norm over all three; fidelity 500 in units of the longest edge."""
    corners = mesh.vertices[mesh.faces]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max()
    return Problem(mesh.name, mesh.vertices, mesh.faces, mesh.vertices, fidelity=500 / longest**3)


CLASSES: dict[str, Callable[[Mesh], Problem]] = {
    "interpolation, 10 points": points(10),
    "interpolation, 40 points": points(40),
    "interpolation, 1000 points": points(1000),
    "hole": hole,
    "denoising, light noise": noise(*LIGHT),
    "denoising, heavy noise": noise(*HEAVY),
    "weighted faces": weighted,
    "linear constraints": constrained,
    "three coordinates, joint": coordinates,
}
"""All classes by name."""
