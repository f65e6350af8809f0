"""What the gallery measures: error against the truth, where a function bends, the best fidelity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import ridgeform
from numpy.typing import NDArray

Array = NDArray[np.float64]

NAMES = {
    "l1_hessian": "L1 Hessian (ours)",
    "l2_hessian": "L2 Hessian",
    "l2_curved_hessian": "L2 Hessian, curved",
    "l2_laplacian": "L2 Laplacian",
    "l1_hessian_stein2018": "L1 Hessian, Stein 2018",
    "l1_edge_laplacian": "L1 edge Laplacian",
}

DECADES = {"l1": range(1, 7), "l2": range(0, 9)}
"""Powers of ten from which the search for a fidelity starts; it goes on beyond an end that is the best."""
STEPS = (0.25, 0.0625)
"""Finer steps of the search, in decades, around the best so far."""


def rms(mesh: ridgeform.Mesh, values: Array, where: NDArray[np.bool_] | None = None) -> float:
    """Root of the mean square over the area, of vertices `where` if given."""
    mass = ridgeform.voronoi_mass(mesh)
    if where is not None:
        mass = mass * where
    return float(np.sqrt((mass * values**2).sum() / mass.sum()))


def bending_in_tenth(mesh: ridgeform.Mesh, values: Array) -> float:
    """Share of the L1 Hessian energy in that tenth of the area that bends most: 1 for straight pieces."""
    area = _face_areas(mesh.edge_lengths)
    return share_in_tenth(ridgeform.hessian_norm(mesh, values) * area, area)


def share_in_tenth(amounts: Array, areas: Array) -> float:
    """How much of what faces have `(m,)` is in that tenth of their area `(m,)` that is densest."""
    order = np.argsort(-amounts / np.maximum(areas, np.finfo(float).tiny), kind="stable")
    before = np.cumsum(areas[order]) <= 0.1 * areas.sum()
    total = amounts.sum()
    return float(amounts[order][before].sum() / total) if total > 0 else 1.0


def face_areas(vertices: Array, faces: NDArray[np.int64]) -> Array:
    """Of each face `(m,)`."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def _face_areas(lengths: Array) -> Array:
    s = 0.5 * lengths.sum(axis=1)
    return np.sqrt(np.maximum(s * np.prod(s[:, None] - lengths, axis=1), 0.0))


@dataclass(frozen=True)
class Fit:
    """The result of least error over all fidelities tried."""

    fidelity: float
    error: float
    solution: ridgeform.Solution


def best_fit(solve: Callable[[float], ridgeform.Solution], error: Callable[[Array], float], kind: str) -> Fit:
    """Search the fidelity on a log grid: whole decades first, then `STEPS` around the best.

    `kind` is the name of an energy; the fidelity of the L1 and of the L2 energies has different units.
    """
    tried: dict[float, Fit] = {}

    def fit(exponent: float) -> Fit:
        if exponent not in tried:
            solution = solve(10.0**exponent)
            tried[exponent] = Fit(10.0**exponent, error(solution.values), solution)
        return tried[exponent]

    def best() -> float:
        return min(tried, key=lambda exponent: tried[exponent].error)

    for exponent in DECADES[kind[:2]]:
        fit(float(exponent))
    while best() in (min(tried), max(tried)) and len(tried) < 20:
        fit(best() + (1.0 if best() == max(tried) else -1.0))
    for step in STEPS:
        center = best()
        for k in (-3, -2, -1, 1, 2, 3):
            fit(center + k * step)
    return tried[best()]


def table(header: list[str], rows: list[list[str]]) -> str:
    """A Markdown table, first column to the left, the others to the right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)], *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
